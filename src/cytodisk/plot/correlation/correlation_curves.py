"""Draw correlation against lag by layer, and the maps of what was correlated beside each other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.curve_key import ALPHA, BAND_OPACITY, JITTER_LOOK, LOST_LOOK, PARTIAL_LOOK
from cytodisk.plot.correlation.lag_axis import LagUnit, rows_of_cell, sides, signed
from cytodisk.plot.layer_looks import cytoplasm_layers_of, layer_colours, layer_names, shown_layers
from cytodisk.plot.movie.activity_maps import draw_activity_map, draw_velocity_map
from cytodisk.plot.style import CHANCE_COLOUR, CHANCE_LINE, LINE_COLOUR, TEXT_SIZE
from cytodisk.plot.time_axis import TICK_STEPS, stands_alone
from cytodisk.scale import Scale

PEAK_NAME, LOST_NAME, PARTIAL_NAME = "peak", "peak that does not survive", "without controls"
JITTER_NAME = "peak at a lag of jitter"

_LEAST_REACH = 0.1  # of the correlation's axis, so that noise alone does not fill it
_ROOM = 1.08  # of that axis over what it holds
_CURVES = {"cell", "layer", "lag", "correlation", "lower_quartile", "upper_quartile"}
_PEAKS = {"cell", "layer", "lag", "correlation"}


def draw_correlation_curves(
    axes: Sequence[Axes],
    by_layer: pd.DataFrame,
    *,
    cell: int = 0,
    peaks: pd.DataFrame | None = None,
    signal: str = "signal",
    with_: str = "velocity",
    depths: xr.DataArray | None = None,
) -> list[Line2D]:
    """Draw the mean correlation of layers against lag under each other, with quartiles and what chance gives.

    Parameters
    ----------
    axes : sequence of Axes
        From top to bottom, one for each of `shown_layers`.
    by_layer : DataFrame
        `layer_curves` of a study's correlation: cell, layer, lag, correlation, lower_quartile and
        upper_quartile; lag_s, seconds, threshold and correlation_partial where they are known.
    cell : int
    peaks : DataFrame, optional
        Its `layers`: the peak of each, an open dot where q, over all layers and cells, is 0.05 or more; a
        cross where the column geometry says that it does not survive; an open diamond where the column
        jittered says that jitter of the masks makes its lag.
    signal, with_ : str
        Names for the words at the lags: at a positive lag the signal comes first.
    depths : DataArray with the dim layer, optional
        As `activity["depth"]`: the names of layers say how deep they lie in the median.

    Returns
    -------
    list of Line2D
        The means, one a layer, dark for the edge; a thin broken line beside each is the partial correlation,
        with controls regressed out. Coloured bands are the quartiles over sectors; the grey
        one, from -threshold to threshold, holds the whole curve of 95 of 100 surrogates of that layer by
        itself: a peak beyond it can still have q of 0.05 or more, as one layer in twenty is by chance.

    Raises
    ------
    ParameterError
        A table lacks columns or the cell, or the axes are not as many as the layers shown.

    See Also
    --------
    curve_key : Says what lines and bands are.
    draw_peaks_on_cell : Peaks by window.

    References
    ----------
    u-Unwrap, Fig. 5D-F.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> windows = [[True] * 4]
    >>> signal, velocity = cd.simulate.coupled_series("white", 0, 80, 1, 4, lag_frames=3, windows=windows)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99)
    >>> table = cd.correlation_by_layer(correlations).to_dataframe().reset_index().assign(cell=0)
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_correlation_curves([ax], table)
    """
    curves = rows_of_cell(by_layer, cell, _CURVES, "by_layer")
    marks = None if peaks is None else rows_of_cell(peaks, cell, _PEAKS, "peaks")
    numbers = np.unique(curves["layer"])
    outer = cytoplasm_layers_of(depths)
    layers = [int(numbers[place]) for place in shown_layers(len(numbers), outer)]
    if len(axes) != len(layers):
        raise ParameterError(f"axes must be {len(layers)}, got {len(axes)}: pass one for each layer shown")
    unit, names = LagUnit.of(curves), layer_names(layers, len(numbers), depths)
    curves, marks = unit.shown(curves), None if marks is None else unit.shown(marks)
    lines = []
    colours = layer_colours(layers, outer)
    for ax, layer, name, colour in zip(axes, layers, names, colours, strict=True):
        one = curves[curves["layer"] == layer].sort_values("lag")
        lines.append(_draw_curve(ax, one, unit, colour))
        _draw_partial(ax, one, unit, colour)
        ax.set_title(name, loc="left", y=1.0, pad=2.0)
        if marks is not None:
            _mark_peak(ax, marks[marks["layer"] == layer], unit, colour)
    _share_axes(axes, curves[curves["layer"].isin(layers)], unit)
    axes[-1].set_xlabel(f"{unit.label}\n{sides(signal, with_)}", parse_math=False)
    return lines


def draw_map_pair(
    axes: Sequence[Axes],
    signal: Any,
    other: Any,
    *,
    label: str = "mean",
    other_label: str = "mean",
    by_velocity: bool = False,
    scale: Scale | None = None,
) -> tuple[AxesImage, AxesImage]:
    """Draw the maps of two quantities beside each other, by the same frames and sectors.

    Parameters
    ----------
    axes : sequence of two Axes
        Left and right, with room for a colour bar to the right of each.
    signal, other : array_like or DataArray of shape (T, S)
        NaN is drawn light grey.
    label, other_label : str
        Labels of the colour bars; units follow, "a.u." of values that do not say theirs.
    by_velocity : bool
        The second is the edge velocity: red is protrusion, blue retraction.
    scale : Scale, optional
        Of plain numbers, as for `draw_activity_map` and `draw_velocity_map`.

    Returns
    -------
    (AxesImage, AxesImage)

    Raises
    ------
    ParameterError
        The maps differ in shape, are no tables of numbers, or the axes are not two.

    See Also
    --------
    draw_activity_map : One map.

    References
    ----------
    u-Unwrap, Fig. 5B and C.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("smooth", 0, 40, 1, 8)
    >>> figure, axes = plt.subplots(1, 2)
    >>> images = cd.plot.draw_map_pair(axes, signal.sel(layer=0), velocity)
    """
    if len(axes) != 2:
        raise ParameterError(f"axes must be two, got {len(axes)}")
    if np.shape(signal) != np.shape(other):
        raise ParameterError(
            f"signal has shape {np.shape(signal)}, other {np.shape(other)}: pass the same frames and sectors"
        )
    left = draw_activity_map(axes[0], signal, label=label, scale=scale)
    if by_velocity:
        right = draw_velocity_map(axes[1], other, scale=scale)
    else:
        right = draw_activity_map(axes[1], other, label=other_label, scale=scale)
    axes[1].set_ylabel("")
    axes[1].tick_params(labelleft=False)
    return left, right


def _draw_curve(ax: Axes, curve: pd.DataFrame, unit: LagUnit, colour: FloatArray) -> Line2D:
    lag = curve[unit.column].to_numpy(dtype=np.float64)
    threshold = _threshold(curve)
    if np.isfinite(threshold):
        ax.axhspan(
            -threshold, threshold, facecolor=CHANCE_COLOUR, edgecolor=CHANCE_LINE, linewidth=0.4, zorder=0
        )
    ax.axhline(0.0, color="0.6", linewidth=0.4, zorder=0.5)
    ax.axvline(0.0, color="0.35", linewidth=0.5, linestyle=(0, (4, 3)), zorder=0.5)
    low, high = (curve[f"{name}_quartile"].to_numpy(dtype=np.float64) for name in ("lower", "upper"))
    ax.fill_between(lag, low, high, color=colour, alpha=BAND_OPACITY, linewidth=0)
    mean = curve["correlation"].to_numpy(dtype=np.float64)
    dots: Any = {"marker": ".", "markersize": 3.0, "markevery": stands_alone(mean)}
    (line,) = ax.plot(lag, mean, color=colour, linewidth=1.0, **dots)
    return line


def _draw_partial(ax: Axes, curve: pd.DataFrame, unit: LagUnit, colour: FloatArray) -> None:
    """A thin line for the correlation with controls regressed out, where there is one."""
    if "correlation_partial" not in curve or not curve["correlation_partial"].notna().any():
        return
    lag, left = (curve[name].to_numpy(dtype=np.float64) for name in (unit.column, "correlation_partial"))
    (line,) = ax.plot(lag, left, color=colour, **PARTIAL_LOOK)
    line.set_gid(PARTIAL_NAME)


def _mark_peak(ax: Axes, peak: pd.DataFrame, unit: LagUnit, colour: FloatArray) -> None:
    """A mark at the peak, a cross if it is lost, a diamond if it is jitter's; its numbers above the axes."""
    if len(peak) != 1 or not np.isfinite(peak["correlation"].iloc[0]):
        return
    height, lag = float(peak["correlation"].iloc[0]), float(peak[unit.column].iloc[0])
    faint = "q" in peak and bool(peak["q"].iloc[0] >= ALPHA)
    lost = "geometry" in peak and peak["geometry"].iloc[0] in (True, 1)
    jittered = "jittered" in peak and bool(peak["jittered"].iloc[0])
    look: Any = {"marker": "o", "markersize": 3.5, "markeredgewidth": 0.8}
    if lost or jittered:
        look = LOST_LOOK if lost else JITTER_LOOK
    (dot,) = ax.plot([lag], [height], color=colour, linewidth=0, clip_on=False, **look)
    name = LOST_NAME if lost else JITTER_NAME if jittered else PEAK_NAME
    dot.set(markerfacecolor="white" if faint or jittered else colour, gid=name, zorder=4)
    words = f"{signed(height, '.2f')} at {unit.write(lag)}"
    ax.set_title(
        words, loc="right", y=1.0, pad=2.0, fontsize=TEXT_SIZE, color="0.3" if faint else LINE_COLOUR
    )


def _share_axes(axes: Sequence[Axes], curves: pd.DataFrame, unit: LagUnit) -> None:
    """The same lags and correlations in all axes, lags written below the last."""
    columns = ["correlation", "lower_quartile", "upper_quartile", "threshold", "correlation_partial"]
    largest = curves[[name for name in columns if name in curves]].abs().to_numpy(dtype=np.float64)
    reach = max(_ROOM * float(np.nanmax(largest, initial=0.0)), _LEAST_REACH)
    lags = curves[unit.column].to_numpy(dtype=np.float64)
    half = 0.5 if np.ptp(lags) == 0 else 0.0
    for ax in axes:
        ax.set(xlim=(lags.min() - half, lags.max() + half), ylim=(-reach, reach))
        ax.xaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=unit.unit == "frames"))
        ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS, symmetric=True))
        ax.tick_params(labelbottom=ax is axes[-1])
    box, top = axes[-1].get_position(), axes[0].get_position().y1
    axes[-1].set_ylabel("correlation", y=0.5 * (top - box.y0) / box.height, ha="center")


def _threshold(curve: pd.DataFrame) -> float:
    return float(curve["threshold"].iloc[0]) if "threshold" in curve else np.nan
