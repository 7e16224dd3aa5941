"""Draw a movie's windows by frame and sector: activity maps of layers and the map of edge velocity.

Time goes to the right, sectors upwards; a frame is centred on its time and a sector on its number. A
DataArray brings its unit and its times; of plain numbers a `Scale` tells them.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.ticker import MaxNLocator

from cytodisk.analysis.top_speed import top_speed
from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.layer_looks import cytoplasm_layers_of, layer_names, shown_layers
from cytodisk.plot.number_tables import number_table
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS, colour_bar, signal_limits
from cytodisk.plot.time_axis import TICK_STEPS, FrameTimes
from cytodisk.plot.time_raster import bar_beside, cut_off, draw_time_raster
from cytodisk.plot.units import unit_of, velocity_unit, with_unit
from cytodisk.scale import Scale

SECTOR_LABEL = "sector (0 at +x, towards +y)"


def draw_activity_map(
    ax: Axes,
    values: Any,
    *,
    label: str = "mean",
    limits: tuple[float, float] | None = None,
    scale: Scale | None = None,
) -> AxesImage:
    """Draw a signal by frame and sector in one layer, with a colour bar to the right of the axes.

    Parameters
    ----------
    ax : Axes
    values : array_like or DataArray of shape (T, S)
        NaN is drawn light grey.
    label : str
        Label of the colour bar; the unit follows, "a.u." of values that do not say theirs.
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of the values.
    scale : Scale, optional
        Of plain numbers: the time between frames. Unknown, time is in frames.

    Returns
    -------
    AxesImage
        Its array has shape (S, T).

    Raises
    ------
    ParameterError
        The values are no table of numbers, or their frames are not at even steps.

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
    table = number_table(values, "values", ("time", "sector"))
    limits = limits or signal_limits(table)
    drawn = _draw_map(ax, table, FrameTimes.of(values, "values", scale), SIGNAL_COLOURS, limits)
    colour_bar(drawn, bar_beside(ax), label, unit_of(values, "a.u."), extend=cut_off(table, limits))
    return drawn


def draw_velocity_map(ax: Axes, velocity: Any, *, scale: Scale | None = None) -> AxesImage:
    """Draw edge velocity by frame and sector: protrusion red, retraction blue, white at 0.

    Parameters
    ----------
    ax : Axes
    velocity : array_like or DataArray of shape (T, S)
        Positive outwards; NaN, as in the last frame, is drawn light grey. A DataArray, such as
        `edge_velocity` returns, brings its unit and its times.
    scale : Scale, optional
        Of plain numbers: their unit and the time between frames. Unknown, they are in px/frame and frames.

    Returns
    -------
    AxesImage
        Its array has shape (S, T); its limits are percentile 99 of the speeds to both sides of 0, but
        at most three times percentile 75, as a few faults of masks would pale all else.

    Raises
    ------
    ParameterError
        The velocity is no table of numbers, or its frames are not at even steps.

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
    table = number_table(velocity, "velocity", ("time", "sector"))
    times = FrameTimes.of(velocity, "velocity", scale)
    unit = velocity_unit(velocity, scale, times.unit, top_speed(table))
    table = unit.factor * table
    top = top_speed(table)
    drawn = _draw_map(ax, table, times, DIVERGING_COLOURS, (-top, top))
    words = with_unit("edge velocity", unit.name)
    colour_bar(drawn, bar_beside(ax), words, extend=cut_off(table, (-top, top)))
    return drawn


def draw_layers(
    axes: Sequence[Axes],
    values: Any,
    velocity: Any = None,
    *,
    label: str = "mean",
    limits: tuple[float, float] | None = None,
    scale: Scale | None = None,
    depths: xr.DataArray | None = None,
) -> list[AxesImage]:
    """Draw activity maps of layers under each other, with the same colours and one time axis.

    Parameters
    ----------
    axes : sequence of Axes
        From top to bottom: one for the velocity if it is given, then one for each of `shown_layers`.
    values : array_like or DataArray of shape (T, L, S)
        The coordinate compartment of a DataArray tells which layers are in the nucleus.
    velocity : array_like or DataArray of shape (T, S), optional
        Positive outwards.
    label : str
        Label of the layers' common colour bar; the unit follows, "a.u." of values that do not say theirs.
    limits : (float, float), optional
        Limits of the layers' colours; by default percentiles 1 and 99.5 of the values of all layers.
    scale : Scale, optional
        Of plain numbers: the unit of velocity and the time between frames. Unknown, they are in px/frame and
        frames.
    depths : DataArray with the dim layer, optional
        As `activity["depth"]`: the names of layers say how deep they lie in the median.

    Returns
    -------
    list of AxesImage
        One for each of the axes.

    Raises
    ------
    ParameterError
        The arrays do not fit each other or the axes, or frames are not at even steps.

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
    table = number_table(values, "values", ("time", "layer", "sector"))
    outer = cytoplasm_layers_of(values)
    layers = shown_layers(table.shape[1], outer)
    _check_layers(axes, table, velocity, len(layers))
    maps, drawn = list(axes), []
    if velocity is not None:
        top = maps.pop(0)
        drawn.append(draw_velocity_map(top, velocity, scale=scale))
        _name(top, "edge velocity: protrusion red, retraction blue")
    common, times = limits or signal_limits(table), FrameTimes.of(values, "values", scale)
    names = layer_names(layers, table.shape[1], depths, outer)
    for ax, layer, name in zip(maps, layers, names, strict=True):
        drawn.append(_draw_map(ax, table[:, layer], times, SIGNAL_COLOURS, common))
        _name(ax, name)
    ends = cut_off(table[:, layers], common)
    colour_bar(drawn[-1], bar_beside(*maps), label, unit_of(values, "a.u."), extend=ends)
    share_labels(axes)
    return drawn


def _check_layers(axes: Sequence[Axes], table: FloatArray, velocity: Any, maps: int) -> None:
    wanted = maps + (velocity is not None)
    if len(axes) != wanted:
        raise ParameterError(f"axes must be {wanted}, got {len(axes)}: pass one a map, the velocity's first")
    if velocity is not None and np.shape(velocity)[:1] != table.shape[:1]:
        raise ParameterError(
            f"velocity has shape {np.shape(velocity)}, values {table.shape}: pass the same frames"
        )


def _draw_map(
    ax: Axes, table: FloatArray, times: FrameTimes, cmap: str, limits: tuple[float, float]
) -> AxesImage:
    drawn = draw_time_raster(ax, table, times, (-0.5, table.shape[1] - 0.5), limits, cmap)
    ax.set_ylabel(SECTOR_LABEL)
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS, integer=True))
    return drawn


def share_labels(axes: Sequence[Axes]) -> None:
    """One time axis below all maps, and the sectors' label once, half-way up.

    Parameters
    ----------
    axes : sequence of Axes
        From top to bottom.
    """
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
