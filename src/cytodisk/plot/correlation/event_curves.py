"""Draw events of the edge on its velocity map, and the mean of a signal around them."""

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import ParameterError
from cytodisk.plot.layer_looks import (
    cytoplasm_layers_of,
    layer_colours,
    layer_dashes,
    layer_word,
    shown_layers,
)
from cytodisk.plot.movie.activity_maps import draw_velocity_map
from cytodisk.plot.number_tables import named_table
from cytodisk.plot.style import LINE_COLOUR, TEXT_SIZE
from cytodisk.plot.time_axis import TICK_STEPS, FrameTimes
from cytodisk.plot.units import unit_of, with_unit
from cytodisk.scale import suited_lag

ONSET_NAME = "onset"

_OUTLINE_WIDTH, _ONSET_WIDTH, _THIN_ONSET = 0.4, 1.3, 0.6  # points
_MOST_OUTLINED = 150  # patches
_COLUMNS = {"sector", "kind", "onset", "end", "onset_known", "patch"}
_BAND_OPACITY = 0.18


def draw_events(ax: Axes, velocity: xr.DataArray, events: pd.DataFrame) -> LineCollection:
    """Draw the map of edge velocity with the outlines of the patches of events on it.

    Parameters
    ----------
    ax : Axes
    velocity : DataArray with dims time and sector
        As it was passed to `edge_events`.
    events : DataFrame
        Of `edge_events`, or some of its rows.

    Returns
    -------
    LineCollection
        The outlines, one line a side of a window; a patch is open where it goes around sector 0. Bold
        lines with the gid "onset", in a second collection, mark the onsets that are known. Of more than
        150 patches, whose lines would hide the map, there are no outlines, and thin lines at the onsets of
        protrusions alone.

    Raises
    ------
    ParameterError
        The velocity is not by time and sector, or the events are not of its frames and sectors.

    See Also
    --------
    draw_velocity_map : The map alone.
    draw_event_average : The signal around the events.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> _, velocity = cd.simulate.independent_series("smooth", 0, 30, 1, 8)
    >>> velocity.attrs["units"] = "px/frame"
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_events(ax, velocity, cd.edge_events(velocity, threshold=0.5))
    """
    named_table(velocity, "velocity", ("time", "sector"))
    times = FrameTimes.of(velocity, "velocity")
    if times.stride != 1:
        raise ParameterError("velocity leaves frames out: pass it as it was passed to edge_events")
    patches = _patch_image(velocity, events, times.first)
    draw_velocity_map(ax, velocity)
    scale = np.array([times.per_frame, 1.0])
    many = events["patch"].nunique() > _MOST_OUTLINED
    outlines = (_sides(patches) + np.array([times.first - 0.5, -0.5]))[: 0 if many else None]
    onsets = _onset_sides(velocity, events[events["kind"] == "protrusion"] if many else events)
    drawn = LineCollection(outlines * scale, colors=LINE_COLOUR, linewidths=_OUTLINE_WIDTH, capstyle="round")
    width = _THIN_ONSET if many else _ONSET_WIDTH
    starts = LineCollection(onsets * scale, colors=LINE_COLOUR, linewidths=width, capstyle="butt")
    starts.set_gid(ONSET_NAME)
    ax.add_collection(drawn, autolim=False)
    ax.add_collection(starts, autolim=False)
    return drawn


def draw_event_average(ax: Axes, average: xr.Dataset, *, label: str = "mean") -> list[Line2D]:
    """Draw the mean of a signal around events against the delay, with its band, by layer.

    Parameters
    ----------
    ax : Axes
    average : Dataset with dims delay, and layer or none
        Of `average_around`; select one channel. Of many layers the four of `shown_layers` are drawn.
    label : str
        Label of the signal; its unit follows.

    Returns
    -------
    list of Line2D
        One a layer, dark for the edge, each with its own dashes. Bands are drawn for the outermost and the
        innermost layer only, as more would hide each other; `band_key` says what they are.

    Raises
    ------
    ParameterError
        It is no average, or has other dims.

    See Also
    --------
    band_key : Says what the bands are.
    draw_events : Where the events are.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("smooth", 0, 60, 2, 8)
    >>> velocity.attrs["units"] = "px/frame"
    >>> events = cd.edge_events(velocity, threshold=0.5)
    >>> average = cd.average_around(signal, events, before=3, after=5)
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_event_average(ax, average)
    >>> len(lines)
    2
    """
    table = _parse_average(average)
    delays, unit = _delays(average)
    outer = cytoplasm_layers_of(table)
    layers, lines = shown_layers(table.sizes["layer"], outer), []
    looks = zip(layers, layer_colours(layers, outer), layer_dashes(layers), strict=True)
    for layer, colour, dashes in looks:
        one = table.isel(layer=layer)
        if layer in (layers[0], layers[-1]):
            low, high = one["lower"], one["upper"]
            ax.fill_between(delays, low, high, color=colour, alpha=_BAND_OPACITY, linewidth=0)
        name = layer_word(layer, table.sizes["layer"], outer)
        lines += ax.plot(delays, one["mean"], color=colour, linewidth=0.9, linestyle=dashes, label=name)
    ax.axvline(0.0, color="0.6", linewidth=0.5, linestyle=(0, (4, 3)), zorder=0)
    ax.set_xlim(delays[0], delays[-1])
    ax.set_xlabel(f"delay after {average.attrs['at']} of {average.attrs['kind']} ({unit})")
    ax.set_ylabel(_signal_label(average, label), parse_math=False)
    ax.xaxis.set_major_locator(MaxNLocator(6, steps=TICK_STEPS, integer=unit == "frames"))
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS))
    if "layer" in average.dims:
        handles = [*lines, *band_key(average)]
        ax.legend(
            handles=handles, frameon=False, loc="best", handlelength=2.0, borderpad=0.0, labelspacing=0.25
        )
    _write_number(ax, table)
    return lines


def band_key(average: xr.Dataset) -> list[Any]:
    """Handle of a legend for the bands of `draw_event_average`.

    Parameters
    ----------
    average : Dataset
        Of `average_around`.

    Returns
    -------
    list of Artist
        Empty where there is no band.

    Raises
    ------
    ParameterError
        It is no average, or has other dims.

    See Also
    --------
    draw_event_average : Draws the bands.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> signal, velocity = cd.simulate.independent_series("smooth", 0, 60, 2, 8)
    >>> velocity.attrs["units"] = "px/frame"
    >>> average = cd.average_around(signal, cd.edge_events(velocity, threshold=0.5), before=3, after=5)
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_event_average(ax, average)
    >>> legend = ax.legend(handles=[*lines, *cd.plot.band_key(average)])
    """
    table = _parse_average(average)
    outer = cytoplasm_layers_of(table)
    layers = shown_layers(table.sizes["layer"], outer)
    if not np.isfinite(table["lower"]).any():
        return []
    words = f"{average.attrs.get('confidence', 0.95):.0%}".replace("%", " %") + ", bootstrap of patches"
    words += f" (layers {layers[0]}, {layers[-1]})" if len(layers) > 2 else ""
    colour = (*layer_colours(layers, outer)[0][:3], _BAND_OPACITY)
    return [Patch(facecolor=colour, linewidth=0, label=words)]


def _patch_image(velocity: xr.DataArray, events: Any, first: int) -> IntArray:
    """Number of the patch of each frame and sector, shape (T, S); -1 for none."""
    if not isinstance(events, pd.DataFrame) or not set(events.columns) >= _COLUMNS:
        raise ParameterError("events must be the table of edge_events: pass it, or rows of it")
    shape = velocity.sizes["time"], velocity.sizes["sector"]
    image = np.full(shape, -1, dtype=np.int64)
    places = _places(velocity, events)
    start, stop = (events[name].to_numpy() - first for name in ("onset", "end"))
    if len(events) and (start.min() < 0 or stop.max() > shape[0]):
        raise ParameterError(
            f"events go beyond the {shape[0]} frames of velocity: pass those of this velocity"
        )
    for place, here, there, patch in zip(places, start, stop, events["patch"], strict=True):
        image[here:there, place] = patch
    return image


def _places(velocity: xr.DataArray, events: pd.DataFrame) -> IntArray:
    numbers = velocity["sector"].to_numpy() if "sector" in velocity.coords else None
    every = np.arange(velocity.sizes["sector"]) if numbers is None else numbers
    found = pd.Index(every).get_indexer(pd.Index(events["sector"]))
    if (found < 0).any():
        raise ParameterError("events are in sectors that velocity has not: pass those of this velocity")
    return np.asarray(found, dtype=np.int64)


def _sides(patches: IntArray) -> FloatArray:
    """Sides of windows at which a patch ends, shape (N, 2, 2), as corners (time, sector) from 0."""
    steps = np.diff(np.pad(patches, ((1, 1), (0, 0)), constant_values=-1), axis=0)
    around = np.concatenate([patches[:, -1:], patches, patches[:, :1]], axis=1)
    across, along = np.argwhere(steps != 0), np.argwhere(np.diff(around, axis=1) != 0)
    up, right = np.array([0.0, 1.0]), np.array([1.0, 0.0])
    return np.concatenate([np.stack([across, across + up], 1), np.stack([along, along + right], 1)])


def _onset_sides(velocity: xr.DataArray, events: pd.DataFrame) -> FloatArray:
    known = events[events["onset_known"].astype(bool)]
    time, place = known["onset"].to_numpy() - 0.5, _places(velocity, known)
    return np.stack([np.stack([time, place - 0.5], 1), np.stack([time, place + 0.5], 1)], 1)


def _parse_average(average: Any) -> xr.Dataset:
    tables = {"mean", "lower", "upper", "n", "n_patches"}
    if not isinstance(average, xr.Dataset) or not set(average.data_vars) >= tables:
        raise ParameterError("average must be the Dataset of average_around")
    if not {"delay"} <= set(average.dims) <= {"delay", "layer"}:
        raise ParameterError(
            f"average has dims {list(average.dims)}: select one channel, as in average.sel(channel=…)"
        )
    return average if "layer" in average.dims else average.expand_dims("layer")


def _delays(average: xr.Dataset) -> tuple[FloatArray, str]:
    """Delays, and their unit."""
    frames = average["delay"].to_numpy().astype(np.float64)
    if "delay_s" not in average.coords:
        return frames, "frames"
    seconds = average["delay_s"].to_numpy().astype(np.float64)
    unit = suited_lag(float(np.ptp(seconds) / np.ptp(frames)) if len(frames) > 1 else 0.0)
    return seconds * unit.factor, unit.name


def _signal_label(average: xr.Dataset, label: str) -> str:
    if average.attrs["normalise"] == "sd":
        return f"{label} (sd of window)"
    label += " − mean of window" if average.attrs["normalise"] == "mean" else ""
    return with_unit(label, unit_of(average["mean"], "a.u."))


def _write_number(ax: Axes, table: xr.Dataset) -> None:
    """How many events and patches have a value at delay 0, above the axes."""
    here = table.sel(delay=0).isel(layer=0)
    count, patches = int(here["n"]), int(here["n_patches"])
    words = f"{count} event{'' if count == 1 else 's'} in {patches} patch{'' if patches == 1 else 'es'}"
    ax.set_title(words, loc="right", fontsize=TEXT_SIZE, color="0.3")
