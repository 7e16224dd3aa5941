"""Draw a movie's windows by frame and sector: activity maps of layers and the map of edge velocity.

Time goes to the right, sectors upwards; a frame is centred on its time and a sector on its number.
"""

from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.style import (
    DIVERGING_COLOURS,
    MM_PER_INCH,
    SIGNAL_COLOURS,
    colour_bar,
    colour_map,
    signal_limits,
)
from cytodisk.plot.time_axis import TICK_STEPS, time_axis

SECTOR_LABEL = "sector (0 at +x, towards +y)"

_MOST_LAYERS = 4
_VELOCITY_PERCENTILES, _MOST_OVER_USUAL = (75.0, 99.0), 3.0
_BAR_WIDTH_MM, _BAR_GAP_MM = 2.0, 1.5

Extend = Literal["neither", "both", "min", "max"]
TimeAxis = tuple[int, float | None]  # number of the first frame, seconds between frames


def draw_activity_map(
    ax: Axes,
    values: Any,
    *,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
    label: str = "mean (a.u.)",
    limits: tuple[float, float] | None = None,
) -> AxesImage:
    """Draw a signal by frame and sector in one layer, with a colour bar to the right of the axes.

    Parameters
    ----------
    ax : Axes
    values : array_like or DataArray of shape (T, S)
        NaN is drawn light grey.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where the time axis starts.
    label : str
        Label of the colour bar, with its unit.
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of the values.

    Returns
    -------
    AxesImage
        Its array has shape (S, T).

    Raises
    ------
    ParameterError
        The values are no table of numbers, or the interval is not a positive number.

    See Also
    --------
    draw_layers : Some layers under each other.
    draw_velocity_map : Velocity, with 0 white.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_activity_map(ax, np.random.default_rng(0).random((20, 8)))
    >>> image.get_array().shape
    (8, 20)
    """
    table = _table(values, "values", ("time", "sector"))
    drawn = _draw_map(ax, table, (first_frame, frame_interval_s), SIGNAL_COLOURS, limits or _limits(table))
    colour_bar(drawn, bar_beside(ax), label, extend=_extend(table, drawn))
    return drawn


def draw_velocity_map(
    ax: Axes,
    velocity: Any,
    *,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
    unit: str = "µm/s",
) -> AxesImage:
    """Draw edge velocity by frame and sector: protrusion red, retraction blue, white at 0.

    Parameters
    ----------
    ax : Axes
    velocity : array_like or DataArray of shape (T, S)
        Positive outwards; NaN, as in the last frame, is drawn light grey.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where the time axis starts.
    unit : str
        Unit of the velocity.

    Returns
    -------
    AxesImage
        Its array has shape (S, T); its limits are percentile 99 of the speeds to both sides of 0, but
        at most three times percentile 75, as a few faults of masks would pale all else.

    Raises
    ------
    ParameterError
        The velocity is no table of numbers, or the interval is not a positive number.

    See Also
    --------
    draw_mean_velocity : The mean over sectors.
    draw_events : With the events on the map.

    References
    ----------
    u-Unwrap, Fig. S5.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=12.0)
    >>> velocity = cd.edge_velocity(cd.map_movie(truth.masks), sectors=8)
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_velocity_map(ax, velocity)
    >>> image.get_array().shape
    (8, 4)
    """
    return _draw_velocity(ax, velocity, (first_frame, frame_interval_s), f"edge velocity ({unit})")


def draw_layers(
    axes: Sequence[Axes],
    values: Any,
    velocity: Any = None,
    *,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
    label: str = "mean (a.u.)",
    unit: str = "µm/s",
    limits: tuple[float, float] | None = None,
) -> list[AxesImage]:
    """Draw activity maps of layers under each other, with the same colours and one time axis.

    Parameters
    ----------
    axes : sequence of Axes
        From top to bottom: one for the velocity if it is given, then one for each of `shown_layers`.
    values : array_like or DataArray of shape (T, L, S)
    velocity : array_like or DataArray of shape (T, S), optional
        Positive outwards.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where the time axis starts.
    label : str
        Label of the layers' common colour bar, with its unit.
    unit : str
        Unit of the velocity.
    limits : (float, float), optional
        Limits of the layers' colours; by default percentiles 1 and 99.5 of the values of all layers.

    Returns
    -------
    list of AxesImage
        One for each of the axes.

    Raises
    ------
    ParameterError
        The arrays do not fit each other or the axes, or the interval is not a positive number.

    See Also
    --------
    draw_activity_map : One layer.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, axes = plt.subplots(2, 1)
    >>> images = cd.plot.draw_layers(axes, np.random.default_rng(0).random((20, 2, 8)))
    >>> len(images)
    2
    """
    table = _table(values, "values", ("time", "layer", "sector"))
    layers = shown_layers(table.shape[1])
    _check_layers(axes, table, velocity, len(layers))
    maps, drawn, axis = list(axes), [], (first_frame, frame_interval_s)
    if velocity is not None:
        top = maps.pop(0)
        drawn.append(_draw_velocity(top, velocity, axis, f"edge velocity ({unit})"))
        _name(top, "edge velocity: protrusion red, retraction blue")
    common = limits or _limits(table)
    places = {table.shape[1] - 1: " (centre)", 0: " (edge)"}
    for ax, layer in zip(maps, layers, strict=True):
        drawn.append(_draw_map(ax, table[:, layer], axis, SIGNAL_COLOURS, common))
        _name(ax, f"layer {layer}{places.get(layer, '')}")
    colour_bar(drawn[-1], bar_beside(*maps), label, extend=_extend(table[:, layers], drawn[-1]))
    _share_labels(axes)
    return drawn


def shown_layers(layers: int) -> list[int]:
    """Layers that `draw_layers` shows: all up to four, else the edge's, two between, the centre's.

    Parameters
    ----------
    layers : int
        At least 1.

    Returns
    -------
    list of int
    """
    chosen = np.linspace(0, layers - 1, min(layers, _MOST_LAYERS)).round().astype(int)
    return [int(layer) for layer in np.unique(chosen)]


def _table(values: Any, name: str, dims: tuple[str, ...]) -> FloatArray:
    if isinstance(values, xr.DataArray) and set(values.dims) == set(dims):
        values = values.transpose(*dims)
    array = np.asarray(values)
    if array.ndim != len(dims) or not array.size or array.dtype.kind not in "biuf":
        raise ParameterError(
            f"{name} must hold numbers by {', '.join(dims)}, got shape {array.shape} and dtype {array.dtype}"
        )
    return array.astype(np.float64)


def _check_layers(axes: Sequence[Axes], table: FloatArray, velocity: Any, maps: int) -> None:
    wanted = maps + (velocity is not None)
    if len(axes) != wanted:
        raise ParameterError(f"axes must be {wanted}, got {len(axes)}: pass one a map, the velocity's first")
    if velocity is not None and np.shape(velocity)[:1] != table.shape[:1]:
        raise ParameterError(
            f"velocity has shape {np.shape(velocity)}, values {table.shape}: pass the same frames"
        )


def _limits(table: FloatArray) -> tuple[float, float]:
    return signal_limits(table, np.isfinite(table))


def _draw_velocity(ax: Axes, velocity: Any, axis: TimeAxis, label: str) -> AxesImage:
    table = _table(velocity, "velocity", ("time", "sector"))
    speed = np.abs(table[np.isfinite(table)])
    top = _top_speed(speed) if speed.size else 1.0
    drawn = _draw_map(ax, table, axis, DIVERGING_COLOURS, (-top, top))
    colour_bar(drawn, bar_beside(ax), label, extend=_extend(table, drawn))
    return drawn


def _top_speed(speed: FloatArray) -> float:
    usual, fast = np.percentile(speed, _VELOCITY_PERCENTILES).tolist()
    return min(fast, _MOST_OVER_USUAL * usual) or fast or 1.0


def _draw_map(
    ax: Axes, table: FloatArray, axis: TimeAxis, cmap: str, limits: tuple[float, float]
) -> AxesImage:
    (first, interval), (frames, sectors) = axis, table.shape
    time_axis(ax, frames, interval, first)
    left, right = ax.get_xlim()
    drawn = ax.imshow(
        np.ma.masked_invalid(table.T),
        cmap=colour_map(cmap),
        vmin=limits[0],
        vmax=limits[1],
        origin="lower",
        aspect="auto",
        extent=(left, right, -0.5, sectors - 0.5),
    )
    ax.set_ylabel(SECTOR_LABEL)
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS, integer=True))
    return drawn


def _extend(table: FloatArray, drawn: AxesImage) -> Extend:
    """At which ends of the colours values are cut off."""
    low, high = drawn.get_clim()
    below, above = bool((table < low).any()), bool((table > high).any())
    return "both" if below and above else "min" if below else "max" if above else "neither"


def bar_beside(*axes: Axes) -> Axes:
    """Axes for a colour bar to the right of one picture, or of several from top to bottom."""
    first, last = axes[0], axes[-1]
    box, top = last.get_window_extent(), first.get_window_extent().y1
    width = box.width / last.figure.dpi * MM_PER_INCH
    return last.inset_axes(
        (1.0 + _BAR_GAP_MM / width, 0.0, _BAR_WIDTH_MM / width, (top - box.y0) / box.height)
    )


def _share_labels(axes: Sequence[Axes]) -> None:
    """One time axis below all maps, and the sectors' label once, half-way up."""
    for ax in axes:
        ax.set_ylabel("")
        ax.set_xlim(axes[-1].get_xlim())
    for ax in axes[:-1]:
        ax.set_xlabel("")
        ax.tick_params(labelbottom=False)
    box, top = axes[-1].get_position(), axes[0].get_position().y1
    axes[-1].set_ylabel(SECTOR_LABEL, y=0.5 * (top - box.y0) / box.height, ha="center")


def _name(ax: Axes, title: str) -> None:
    """A title at a fixed height: it would give way to the colour bar of several maps."""
    ax.set_title(title, loc="left", y=1.0, pad=2.5)
