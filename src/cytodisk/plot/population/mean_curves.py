"""Draw mean curves of conditions with their intervals, and where they differ."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from scipy.special import stdtrit

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.population.condition_looks import condition_colours
from cytodisk.plot.population.experiment_lines import BAND_NAME, BAND_OPACITY, LEVEL, MEAN_LOOK, MEAN_NAME
from cytodisk.plot.time_axis import TICK_STEPS

DIFFERS_NAME = "differs"

_FIRST, _STEP = 0.03, 0.05  # of the axes: height of the dots of the first condition, and to the next


def draw_mean_curves(
    ax: Axes, atlas: xr.Dataset, differs: dict[str, Any] | None = None, *, label: str = "mean"
) -> list[Line2D]:
    """Draw the mean curve of each condition with its 95 % interval over experiments.

    Parameters
    ----------
    ax : Axes
    atlas : Dataset with dims (condition, lag)
        mean; sem and n_experiments, from which the interval follows.
    differs : dict of str to array_like of shape (lags,) and dtype bool, optional
        By condition, where it differs from the first one: marked by dots at the bottom.
    label : str
        Of the upright axis.

    Returns
    -------
    list of Line2D
        One a condition.

    Raises
    ------
    ParameterError
        The atlas has other dims.

    See Also
    --------
    draw_pooled_curves : With each cell and experiment.
    condition_key : Says what lines and bands are.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> coords = {"condition": ["control", "drug"], "lag": [-1.0, 0.0, 1.0]}
    >>> mean = np.array([[0.0, 1.0, 0.0], [0.0, 2.0, 0.0]])
    >>> atlas = xr.Dataset({"mean": (("condition", "lag"), mean)}, coords=coords)
    >>> figure, ax = plt.subplots()
    >>> [line.get_label() for line in cd.plot.draw_mean_curves(ax, atlas)]
    ['control', 'drug']
    """
    if "mean" not in atlas or set(atlas["mean"].dims) != {"condition", "lag"}:
        came = atlas["mean"].dims if "mean" in atlas else "no mean"
        raise ParameterError(f"atlas must have the dims condition and lag, got {came}: select the others")
    lag = atlas["lag"].to_numpy().astype(np.float64)
    names = [str(name) for name in atlas["condition"].to_numpy()]
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    ax.axvline(0.0, color="0.35", linewidth=0.5, linestyle=(0, (4, 3)), zorder=0.5)
    lines = []
    for number, (name, colour) in enumerate(condition_colours(names).items()):
        one = atlas.sel(condition=name)
        mean = one["mean"].to_numpy().astype(np.float64)
        half = _half(one)
        if np.isfinite(half).any():
            band = ax.fill_between(
                lag, mean - half, mean + half, color=colour, alpha=BAND_OPACITY, linewidth=0
            )
            band.set_gid(BAND_NAME)
        (line,) = ax.plot(lag, mean, color=colour, label=name, gid=MEAN_NAME, **MEAN_LOOK)
        lines.append(line)
        found = np.asarray((differs or {}).get(name, np.zeros(len(lag))), dtype=bool)
        if found.any():
            height = np.full(int(found.sum()), _FIRST + _STEP * (number - 1))
            across = ax.get_xaxis_transform()
            style: Any = {"markersize": 3.0, "linewidth": 0, "gid": DIFFERS_NAME, "clip_on": False}
            ax.plot(lag[found], height, ".", color=colour, transform=across, **style)
    half_step = 0.5 if np.ptp(lag) == 0 else 0.0
    ax.set(xlim=(lag.min() - half_step, lag.max() + half_step))
    ax.margins(y=0.12)
    ax.set_ylabel(label, parse_math=False)
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS))
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS))
    return lines


def _half(one: xr.Dataset) -> FloatArray:
    """Half of the interval of Student's t; NaN where there are not two experiments."""
    if "sem" not in one or "n_experiments" not in one:
        return np.full(one.sizes["lag"], np.nan)
    count, sem = (one[name].to_numpy().astype(np.float64) for name in ("n_experiments", "sem"))
    return np.where(count > 1, stdtrit(np.maximum(count - 1, 1), 0.5 + LEVEL / 2.0) * sem, np.nan)
