"""Draw curves of many cells pooled by experiment and condition."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.lag_axis import sides
from cytodisk.plot.population.condition_looks import checked_units, condition_colours
from cytodisk.plot.population.experiment_lines import CELL_NAME, draw_experiment_lines, mean_by_experiment
from cytodisk.plot.time_axis import TICK_STEPS

_MOST_CELLS = 400  # that get a line
_LIGHT = 0.18  # opacity of a cell's line


def draw_pooled_curves(
    ax: Axes,
    curves: xr.DataArray,
    cells: pd.DataFrame,
    *,
    signal: str = "signal",
    with_: str = "velocity",
    label: str = "correlation",
) -> list[Line2D]:
    """Draw correlation against lag: a faint line a cell, a thin one an experiment, a thick one their mean.

    Parameters
    ----------
    ax : Axes
    curves : DataArray with dims (cell, lag)
        The coordinate lag has its unit in attrs ("s"; "frames" without).
    cells : DataFrame
        condition and experiment: row i is that of curve i.
    signal, with_ : str
        Names for the words at the lags: at a positive lag `with_` follows the signal.
    label : str
        Of the upright axis.

    Returns
    -------
    list of Line2D
        The means over experiments, one a condition; the bands are their 95 % intervals.

    Raises
    ------
    ParameterError
        The curves have other dims, or the table has other rows than they.

    See Also
    --------
    draw_correlation_curves : One cell, by layer.
    condition_key : Says what lines and bands are.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import pandas as pd
    >>> import xarray as xr
    >>> import cytodisk as cd
    >>> lag = np.arange(-5, 6)
    >>> curves = xr.DataArray(np.exp(-(lag**2) / 8) * np.ones((6, 1)), {"lag": lag}, ("cell", "lag"))
    >>> cells = pd.DataFrame({"condition": "control", "experiment": list("aabbcc")})
    >>> figure, ax = plt.subplots()
    >>> (mean,) = cd.plot.draw_pooled_curves(ax, curves, cells)
    >>> mean.get_label()
    'control'
    """
    if not isinstance(curves, xr.DataArray) or set(curves.dims) != {"cell", "lag"}:
        came = curves.dims if isinstance(curves, xr.DataArray) else type(curves).__name__
        raise ParameterError(f"curves must be a DataArray with dims cell and lag, got {came}")
    rows = checked_units(cells, "cells")
    table = curves.transpose("cell", "lag").to_numpy().astype(np.float64)
    if len(rows) != len(table):
        raise ParameterError(
            f"cells has {len(rows)} rows for {len(table)} curves: pass one row for each curve"
        )
    lag = curves["lag"].to_numpy().astype(np.float64)
    unit = str(curves["lag"].attrs.get("units", "frames"))
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    ax.axvline(0.0, color="0.35", linewidth=0.5, linestyle=(0, (4, 3)), zorder=0.5)
    names = rows["condition"].to_numpy()
    colours = condition_colours(list(dict.fromkeys(names.tolist())))
    lines = []
    for name, colour in colours.items():
        own = table[names == name]
        _draw_cells(ax, lag, own, colour)
        _, means = mean_by_experiment(own, rows["experiment"].to_numpy()[names == name])
        lines.append(draw_experiment_lines(ax, lag, means, colour, label=name))
    half = 0.5 if np.ptp(lag) == 0 else 0.0
    ax.set(xlim=(lag.min() - half, lag.max() + half))
    ax.set_xlabel(f"lag ({unit})\n{sides(signal, with_)}", parse_math=False)
    ax.set_ylabel(label, parse_math=False)
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=unit == "frames"))
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _draw_cells(ax: Axes, lag: Any, own: Any, colour: str) -> None:
    chosen = np.unique(np.linspace(0, len(own) - 1, min(len(own), _MOST_CELLS)).round().astype(np.int64))
    points = [np.column_stack([lag, own[number]]) for number in chosen.tolist()]
    faint = LineCollection(points, colors=colour, linewidths=0.35, alpha=_LIGHT, zorder=1.0, gid=CELL_NAME)
    faint.set_rasterized(len(points) * len(lag) > 20_000)
    ax.add_collection(faint)
