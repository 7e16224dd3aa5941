"""Draw how often an effect is found, against the number of experiments."""

from __future__ import annotations

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator, PercentFormatter

from cytodisk.errors import ParameterError

_WANTED = 0.8
_APART = 0.075  # of the axis between labels of lines


def draw_power(
    ax: Axes,
    power: pd.DataFrame,
    found: str = "window",
    *,
    label: str = "experiments of each condition",
    named: bool = True,
) -> list[Line2D]:
    """Draw the share of studies that find an effect, by number of experiments: a line an effect size.

    Parameters
    ----------
    ax : Axes
    power : DataFrame
        experiments, effect (in standard deviations of a cell) and shares from 0 to 1, as
        `population_power` returns it, of one design.
    found : str
        Name of the column with the share, such as window or scalar.
    label : str
        Of the axis of experiments.
    named : bool
        Write the effect at the end of each line, to the right of the axes.

    Returns
    -------
    list of Line2D
        From the smallest effect to the largest, dark to light. The broken line is at 80 %.

    Raises
    ------
    ParameterError
        A column is missing, there are no rows, or an effect stands twice.

    See Also
    --------
    population_power : Makes the table.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> power = pd.DataFrame(
    ...     {
    ...         "experiments": [4, 6, 8, 4, 6, 8],
    ...         "effect": [1.0, 1.0, 1.0, 2.0, 2.0, 2.0],
    ...         "window": [0.2, 0.4, 0.6, 0.5, 0.8, 0.95],
    ...     }
    ... )
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_power(ax, power)
    >>> [line.get_label() for line in lines]
    ['1', '2']
    """
    missing = [name for name in ("experiments", "effect", found) if name not in power]
    if missing or power.empty:
        what = f"has no column {missing[0]!r}" if missing else "has no rows"
        raise ParameterError(f"power {what}: pass a table with experiments, effect and {found}")
    if power.duplicated(["experiments", "effect"]).any():
        raise ParameterError(
            "power has an effect twice for one number of experiments: select one design, as in "
            "power[power['design'] == 'paired']"
        )
    sizes = np.unique(power["effect"].to_numpy(dtype=np.float64))
    colours = [to_hex(one) for one in mpl.colormaps["viridis"](np.linspace(0.0, 0.85, len(sizes)))]
    lines, ends = [], []
    for size, colour in zip(sizes.tolist(), colours, strict=True):
        own = power[power["effect"] == size].sort_values("experiments")
        x, y = (own[name].to_numpy(dtype=np.float64) for name in ("experiments", found))
        (line,) = ax.plot(x, y, "o-", color=colour, markersize=3.0, linewidth=1.2, label=f"{size:g}")
        line.set_clip_on(False)
        lines.append(line)
        ends.append((float(x[-1]), float(y[-1])))
    ax.axhline(_WANTED, color="0.5", linewidth=0.6, linestyle=(0, (3, 2)), zorder=0.5)
    counts = np.unique(power["experiments"].to_numpy(dtype=np.float64))
    ax.set(xlim=(counts[0] - 0.3, counts[-1] + 0.3), ylim=(0.0, 1.0), xlabel=label)
    ax.set_ylabel("studies that find it")
    ax.yaxis.set_major_formatter(PercentFormatter(1.0))
    ax.xaxis.set_major_locator(MaxNLocator(6, integer=True))
    if named:
        _label_ends(ax, lines, ends)
    return lines


def _label_ends(ax: Axes, lines: list[Line2D], ends: list[tuple[float, float]]) -> None:
    """The effect at the end of each line, moved up where labels would lie over each other."""
    order = np.argsort([y for _, y in ends], kind="stable")
    heights = np.array([ends[k][1] for k in order])
    for k in range(1, len(heights)):
        heights[k] = max(heights[k], heights[k - 1] + _APART)
    for k in range(len(heights) - 1, -1, -1):
        heights[k] = min(heights[k], 1.02 - _APART * (len(heights) - 1 - k))
    right = max(x for x, _ in ends)
    for k, height in zip(order.tolist(), heights.tolist(), strict=True):
        ax.annotate(
            str(lines[k].get_label()),
            (right, height),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
            color=lines[k].get_color(),
            annotation_clip=False,
        )
