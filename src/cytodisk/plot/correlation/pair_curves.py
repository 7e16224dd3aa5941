"""Draw the correlation of all pairs of windows by their distance and the lag."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.checks import positive_number
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.pair_table import PairTable
from cytodisk.plot.outline_sides import outline_sides
from cytodisk.plot.style import CHANCE_COLOUR, CHANCE_LINE, DIVERGING_COLOURS, LINE_COLOUR, colour_map
from cytodisk.plot.time_axis import TICK_STEPS, stands_alone

LAG_0_COLOUR, PEAK_COLOUR = "#0072B2", "#D55E00"
OUTLINE_NAME = "beyond chance"

_APART, _WIDTH = -0.2, 0.06  # of the longest distance: place and width of the bin at distance 0
_LEFT = -0.26
_ROOM = 1.08  # of the correlation's axis over what it holds
_BAND_OPACITY = 0.2
_LEGEND: Any = {
    "borderaxespad": 0.1,
    "handlelength": 1.0,
    "columnspacing": 1.0,
    "borderpad": 0.2,
    "markerscale": 0.0,
}


def draw_pairs(
    axes: Sequence[Axes],
    pairs: pd.DataFrame,
    *,
    cell: int = 0,
    along: str = "straight",
    limit: float | None = None,
) -> tuple[list[Line2D], AxesImage]:
    """Draw correlation against distance at two lags, and below it against distance and lag.

    Parameters
    ----------
    axes : sequence of two Axes
        Above for the lines, below for the image.
    pairs : DataFrame
        `pairs` of a study's correlation.
    cell : int
    along : str
        Kind of distance: "straight", "interior" or "edge".
    limit : float, optional
        Colours go from -limit to limit; by default the largest |correlation|.

    Returns
    -------
    lines : list of Line2D
        Mean at lag 0, and at the lag of the largest |correlation| where that is another; coloured bands
        are the quartiles over pairs, grey is what the mean stays within, at all distances and lags, in 95 of
        100 surrogates. Distance 0, windows paired with themselves, stands apart on the left.
    image : AxesImage
        Picture of all distances above 0, its array of shape (lags, distances). What is beyond the grey of the
        lines has an outline, the gid of which is "beyond chance".

    Raises
    ------
    ParameterError
        The table lacks columns, the cell or the kind of distance, the axes are not two, or the limit is not
        a positive number.

    See Also
    --------
    draw_correlation_curves : Each window with its own partner.

    References
    ----------
    u-Unwrap, Fig. S4.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("white", 0, 60, 2, 6)
    >>> pairs = cd.correlate_pairs(signal, signal, max_lag=4)
    >>> table = pairs.to_dataframe().reset_index().assign(cell=0, along="straight")
    >>> figure, axes = plt.subplots(2, 1)
    >>> lines, image = cd.plot.draw_pairs(axes, table)
    """
    if len(axes) != 2:
        raise ParameterError(f"axes must be two, got {len(axes)}: for the lines and for the image")
    table = PairTable.of(pairs, along=along, cell=cell)
    top = float(np.nanmax(np.abs(table.correlation))) if limit is None else positive_number("limit", limit)
    lines = _draw_lines(axes[0], table)
    image = _draw_image(axes[1], table, top)
    for ax in axes:
        _distance_axis(ax, table)
    axes[0].tick_params(labelbottom=False)
    axes[1].set_xlabel(table.label)
    return lines, image


def _draw_lines(ax: Axes, table: PairTable) -> list[Line2D]:
    if np.isfinite(table.threshold):
        low, high = -table.threshold, table.threshold
        ax.axhspan(low, high, facecolor=CHANCE_COLOUR, edgecolor=CHANCE_LINE, linewidth=0.4, zorder=0)
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    here, peak = int(np.abs(table.lag).argmin()), table.peak
    lines = [_draw_line(ax, table, here, LAG_0_COLOUR, "lag 0" + (" (largest)" if peak == here else ""))]
    if peak != here:
        name = f"{table.lag_unit.write(table.lag[peak])} (largest)"
        lines.append(_draw_line(ax, table, peak, PEAK_COLOUR, name))
    ax.legend(handles=lines, frameon=False, ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), **_LEGEND)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines


def _draw_line(ax: Axes, table: PairTable, lag: int, colour: str, name: str) -> Line2D:
    """A line with its band over the distances above 0, and a dot with its bar at 0."""
    apart = table.distance <= 0
    mean, low, high = (values[:, lag] for values in (table.correlation, table.lower, table.upper))
    away = table.distance[~apart]
    ax.fill_between(away, low[~apart], high[~apart], color=colour, alpha=_BAND_OPACITY, linewidth=0)
    dots: Any = {"marker": ".", "markersize": 3.0, "markevery": stands_alone(mean[~apart])}
    (line,) = ax.plot(away, mean[~apart], color=colour, linewidth=1.0, label=name, **dots)
    if apart.any():
        x = (_APART + (0.25 if colour == PEAK_COLOUR else -0.25) * _WIDTH) * table.longest
        ax.vlines(x, low[apart], high[apart], color=colour, alpha=2 * _BAND_OPACITY, linewidth=1.6)
        ax.plot([x], mean[apart], "o", color=colour, markersize=2.6)
    return line


def _draw_image(ax: Axes, table: PairTable, limit: float) -> AxesImage:
    apart = table.distance <= 0
    step = float(np.diff(table.lag).min(initial=np.inf)) if len(table.lag) > 1 else 1.0
    down, up = table.lag[0] - 0.5 * step, table.lag[-1] + 0.5 * step
    first = float(table.distance[~apart][0]) - 0.5 * table.width
    places = [(~apart, first, table.longest)]
    if apart.any():
        left, right = ((_APART + side * 0.5 * _WIDTH) * table.longest for side in (-1, 1))
        places.append((apart, left, right))
    drawn = [_draw_block(ax, table, chosen, (left, right, down, up), limit) for chosen, left, right in places]
    ax.axhline(0.0, color="0.35", linewidth=0.5, linestyle=(0, (4, 3)))
    ax.set(ylim=(down, up), ylabel=table.lag_unit.label)
    integer = table.lag_unit.column == "lag"
    ax.yaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=integer))
    return drawn[0]


def _draw_block(
    ax: Axes, table: PairTable, chosen: Any, extent: tuple[float, float, float, float], limit: float
) -> AxesImage:
    """Part of the image, with an outline around what is beyond the threshold."""
    values = table.correlation[chosen].T
    drawn = ax.imshow(
        np.ma.masked_invalid(values),
        cmap=colour_map(DIVERGING_COLOURS),
        vmin=-limit,
        vmax=limit,
        origin="lower",
        aspect="auto",
        extent=extent,
        interpolation="nearest",
    )
    left, right, down, up = extent
    size = np.array([(right - left) / values.shape[1], (up - down) / values.shape[0]])
    sides = outline_sides(np.abs(values) >= table.threshold) * size + np.array([left, down])
    outline = LineCollection(list(sides), colors=LINE_COLOUR, linewidths=0.6, capstyle="round")
    outline.set_gid(OUTLINE_NAME)
    ax.add_collection(outline, autolim=False)
    return drawn


def _distance_axis(ax: Axes, table: PairTable) -> None:
    longest = table.longest
    ticks = [
        tick for tick in MaxNLocator(4, steps=TICK_STEPS).tick_values(0.0, longest) if 0 <= tick <= longest
    ]
    names = [f"{tick:g}" for tick in ticks]
    apart = bool((table.distance <= 0).any())
    if apart:
        word = "sector" if table.along == "edge" else "window"
        ticks, names = [_APART * longest, *ticks], [f"same\n{word}", *names]
    ax.set_xticks(ticks, names)
    ax.set_xlim((_LEFT if apart else 0.0) * longest, longest)
