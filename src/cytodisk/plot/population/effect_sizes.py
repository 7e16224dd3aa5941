"""Draw effect sizes of many scalars with their intervals: a forest plot."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.errors import ParameterError
from cytodisk.number_words import rounded
from cytodisk.plot.population.difference_map import corrected_column
from cytodisk.plot.style import LINE_COLOUR
from cytodisk.plot.time_axis import TICK_STEPS

POINT_NAME, INTERVAL_NAME = "effect size", "interval"

_COLUMNS = ("scalar", "effect_size", "low", "high")
_LONGEST = 34
_WIDEST = 4.0  # times the largest effect size that an interval may reach before it is cut off


def draw_effect_sizes(
    ax: Axes, scalars: pd.DataFrame, *, alpha: float = 0.05, color: str = "#0072B2"
) -> list[Line2D]:
    """Draw the effect size of each scalar with its 95 % interval, from top to bottom in the order of rows.

    Parameters
    ----------
    ax : Axes
    scalars : DataFrame
        scalar, effect_size (Hedges g), low and high; p_fwer, the p corrected for all scalars, where they
        were tested, or p_holm, corrected for several conditions too. A row without an effect size keeps its
        line, empty.
    alpha : float
        Scalars with a corrected p of at most it are filled.
    color : str

    Returns
    -------
    list of Line2D
        A point for each row that has an effect size.

    Raises
    ------
    ParameterError
        There are no rows, or a column is missing.

    See Also
    --------
    draw_super_plot : One scalar with its cells.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> scalars = pd.DataFrame(
    ...     {
    ...         "scalar": ["polarity", "area"],
    ...         "effect_size": [1.5, 0.1],
    ...         "low": [0.4, -0.9],
    ...         "high": [2.6, 1.1],
    ...         "p_fwer": [0.03, 0.9],
    ...     }
    ... )
    >>> figure, ax = plt.subplots()
    >>> points = cd.plot.draw_effect_sizes(ax, scalars)
    >>> len(points)
    2
    """
    missing = [name for name in _COLUMNS if name not in scalars]
    if missing:
        raise ParameterError(f"scalars has no column {missing[0]!r}: pass the scalars of a comparison")
    if scalars.empty:
        raise ParameterError("scalars has no rows: pass the scalars of a comparison")
    effect, low, high = (scalars[name].to_numpy(dtype=np.float64) for name in _COLUMNS[1:])
    corrected = _column(scalars, corrected_column(scalars))
    reach = _reach(effect, low, high)
    points = []
    for place in np.flatnonzero(np.isfinite(effect)).tolist():
        sure = bool(corrected[place] <= alpha)
        _draw_interval(ax, place, low[place], high[place], reach, color)
        look: Any = {"markerfacecolor": color if sure else "white", "markeredgecolor": color}
        (point,) = ax.plot(
            [effect[place]],
            [place],
            marker="o",
            markersize=4.0,
            linewidth=0,
            gid=POINT_NAME,
            zorder=3,
            **look,
        )
        points.append(point)
        if np.isfinite(corrected[place]):
            _write_p(ax, place, float(corrected[place]), sure)
    ax.axvline(0.0, color="0.4", linewidth=0.6, zorder=0.5)
    ax.set(xlim=(-reach, reach), ylim=(len(scalars) - 0.4, -0.6))
    ax.set_yticks(range(len(scalars)), [_shorter(str(name)) for name in scalars["scalar"]], parse_math=False)
    ax.tick_params(axis="y", length=0)
    ax.spines["left"].set_visible(False)
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS, symmetric=True))
    ax.set_xlabel("effect size (Hedges g) with 95 % interval")
    return points


def _column(scalars: pd.DataFrame, name: str) -> Any:
    if name not in scalars:
        return np.full(len(scalars), np.nan)
    return scalars[name].to_numpy(dtype=np.float64, na_value=np.nan)


def _reach(effect: Any, low: Any, high: Any) -> float:
    """Half the width of the axis: all intervals, as far as they do not dwarf the effect sizes."""
    largest = float(np.nanmax(np.abs(effect), initial=0.5))
    ends = float(np.nanmax(np.abs([low, high]), initial=0.0))
    return 1.05 * min(max(ends, 1.1 * largest), _WIDEST * max(largest, 0.5))


def _draw_interval(ax: Axes, place: int, low: float, high: float, reach: float, color: str) -> None:
    if not (np.isfinite(low) and np.isfinite(high)):
        return
    ends = np.clip([low, high], -reach, reach)
    ax.plot(ends, [place, place], color=color, linewidth=1.0, gid=INTERVAL_NAME, solid_capstyle="butt")
    for end, cut, mark in ((ends[0], low < -reach, "<"), (ends[1], high > reach, ">")):
        if cut:
            ax.plot([end], [place], marker=mark, markersize=3.0, color=color, clip_on=False)


def _write_p(ax: Axes, place: int, p: float, sure: bool) -> None:
    ax.annotate(
        rounded(p, 2),
        (1.0, place),
        xycoords=ax.get_yaxis_transform(),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        color=LINE_COLOUR if sure else "0.45",
        fontweight="bold" if sure else "normal",
        annotation_clip=False,
    )


def _shorter(name: str) -> str:
    return name if len(name) <= _LONGEST else f"{name[: _LONGEST - 1]}…"
