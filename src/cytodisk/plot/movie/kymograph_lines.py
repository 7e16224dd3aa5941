"""Draw kymographs along a line of the image and along the tracked edge: time to the right."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.image import AxesImage
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.number_tables import named_table
from cytodisk.plot.style import SIGNAL_COLOURS, colour_bar, signal_limits
from cytodisk.plot.time_axis import TICK_STEPS, FrameTimes
from cytodisk.plot.time_raster import bar_beside, cut_off, draw_time_raster
from cytodisk.plot.units import unit_of, with_unit

_QUARTER = 90.0  # degrees


def draw_line_kymograph(
    ax: Axes,
    kymograph: xr.DataArray,
    *,
    label: str = "intensity",
    limits: tuple[float, float] | None = None,
) -> AxesImage:
    """Draw intensity along a line through time, with a colour bar to the right; the line starts below.

    Parameters
    ----------
    ax : Axes
    kymograph : DataArray with dims time and distance
        Of `line_kymograph`; select one channel.
    label : str
        Label of the colour bar; the unit follows.
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of the values.

    Returns
    -------
    AxesImage
        Its array has shape (D, T).

    Raises
    ------
    ParameterError
        It has other dims, or distances that are not evenly spaced.

    See Also
    --------
    draw_boundary_kymograph : Along the edge.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> kymograph = cd.line_kymograph([(3, 1), (3, 6)], np.random.default_rng(0).random((10, 6, 8)))
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_line_kymograph(ax, kymograph)
    >>> image.get_array().shape
    (6, 10)
    """
    table = named_table(kymograph, "kymograph", ("time", "distance"))
    distance = kymograph["distance"].to_numpy().astype(np.float64)
    half = 0.5 * (distance[1] - distance[0] if len(distance) > 1 else 1.0)
    if not np.allclose(np.diff(distance), 2.0 * half):
        raise ParameterError(
            "kymograph has distances that are not evenly spaced: pass that of line_kymograph"
        )
    drawn = _draw(ax, kymograph, table, (distance[0] - half, distance[-1] + half), limits, label)
    ax.set_ylabel(with_unit("distance along the line", unit_of(kymograph["distance"], "px")))
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return drawn


def draw_boundary_kymograph(
    ax: Axes,
    kymograph: xr.DataArray,
    *,
    label: str = "intensity",
    limits: tuple[float, float] | None = None,
) -> AxesImage:
    """Draw intensity along the tracked edge through time, by the angle on the disk.

    Parameters
    ----------
    ax : Axes
    kymograph : DataArray with dims time and point
        Of `boundary_kymograph`; select one channel. NaN is drawn light grey.
    label : str
        Label of the colour bar; the depth and the unit follow.
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of the values.

    Returns
    -------
    AxesImage
        Its array has shape (P, T).

    Raises
    ------
    ParameterError
        It has other dims.

    See Also
    --------
    draw_line_kymograph : Along a line.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=12.0)
    >>> kymograph = cd.boundary_kymograph(cd.map_movie(truth.masks), 2.0, truth.signal, points=90)
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_boundary_kymograph(ax, kymograph.isel(channel=0))
    >>> image.get_array().shape
    (90, 4)
    """
    table = named_table(kymograph, "kymograph", ("time", "point"))
    depth, unit = kymograph.attrs.get("depth"), kymograph.attrs.get("depth_units", "px")
    where = "" if depth is None else f", {depth:g} {unit} deep"
    drawn = _draw(ax, kymograph, table, (0.0, 4.0 * _QUARTER), limits, label + where)
    ax.set_ylabel("angle (°, 0 at +x, towards +y)")
    ax.set_yticks(_QUARTER * np.arange(5))
    return drawn


def _draw(
    ax: Axes,
    kymograph: xr.DataArray,
    table: FloatArray,
    span: tuple[float, float],
    limits: tuple[float, float] | None,
    label: str,
) -> AxesImage:
    limits = limits or signal_limits(table)
    times = FrameTimes.of(kymograph, "kymograph")
    drawn = draw_time_raster(ax, table, times, span, limits, SIGNAL_COLOURS, interpolation="nearest")
    colour_bar(drawn, bar_beside(ax), label, unit_of(kymograph, "a.u."), extend=cut_off(table, limits))
    return drawn
