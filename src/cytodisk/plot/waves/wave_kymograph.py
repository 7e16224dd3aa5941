"""Draw waves by frame and sector: the values with lines along the crests, and the phase in colours."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import QuadContourSet
from matplotlib.image import AxesImage
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.movie.activity_maps import SECTOR_LABEL, draw_activity_map, draw_velocity_map
from cytodisk.plot.number_tables import number_table
from cytodisk.plot.style import colour_map
from cytodisk.plot.time_axis import TICK_STEPS, FrameTimes
from cytodisk.plot.time_raster import draw_time_raster
from cytodisk.plot.waves.phase_colours import PHASE_COLOURS, PHASE_LIMITS, crest_mask
from cytodisk.scale import Scale

_CREST = 0.7  # points
_HALO = 1.7


def draw_wave_kymograph(
    ax: Axes,
    values: Any,
    phase: Any = None,
    *,
    by_velocity: bool = False,
    label: str = "mean",
    scale: Scale | None = None,
) -> tuple[AxesImage, QuadContourSet | None]:
    """Draw values by frame and sector, with a line along each crest of the wave.

    Parameters
    ----------
    ax : Axes
        With room for a colour bar to the right.
    values : array_like or DataArray of shape (T, S)
        NaN is drawn light grey.
    phase : array_like or DataArray of shape (T, S), optional
        In radians, 0 at a crest, as `edge_waves` gives it. Without it no crests are drawn.
    by_velocity : bool
        The values are edge velocity: red is protrusion, blue retraction.
    label : str
        Label of the colour bar of other values; the unit follows.
    scale : Scale, optional
        Of plain numbers, as for `draw_activity_map`.

    Returns
    -------
    (AxesImage, QuadContourSet or None)
        The picture, and the crests. Lines that rise to the right are waves that run towards higher sectors,
        which is clockwise in the cell's image.

    Raises
    ------
    ParameterError
        The arrays differ in shape, or are no tables of numbers.

    See Also
    --------
    draw_wave_phase : The phase in colours.
    draw_velocity_map, draw_activity_map : The values alone.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> phase = 0.3 * np.arange(40.0)[:, None] - 2 * np.pi * np.arange(12) / 12
    >>> figure, ax = plt.subplots()
    >>> image, crests = cd.plot.draw_wave_kymograph(ax, np.cos(phase), phase)
    """
    if by_velocity:
        image = draw_velocity_map(ax, values, scale=scale)
    else:
        image = draw_activity_map(ax, values, label=label, scale=scale)
    if phase is None:
        return image, None
    table = number_table(phase, "phase", ("time", "sector"))
    if table.shape != number_table(values, "values", ("time", "sector")).shape:
        raise ParameterError(
            f"phase has shape {table.shape}, values {np.shape(values)}: pass the same frames and sectors"
        )
    return image, _draw_crests(ax, table, FrameTimes.of(values, "values", scale))


def draw_wave_phase(ax: Axes, phase: Any, *, scale: Scale | None = None) -> AxesImage:
    """Draw the phase of a wave by frame and sector in cyclic colours.

    Parameters
    ----------
    ax : Axes
    phase : array_like or DataArray of shape (T, S)
        In radians, 0 at a crest; NaN is drawn light grey.
    scale : Scale, optional
        Of plain numbers: the time between frames.

    Returns
    -------
    AxesImage
        Its array has shape (S, T), with phases from -π to π.

    Raises
    ------
    ParameterError
        The phase is no table of numbers.

    See Also
    --------
    phase_key : What the colours mean.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_wave_phase(ax, 0.3 * np.arange(40.0)[:, None] - np.arange(6.0))
    """
    table = wrapped(number_table(phase, "phase", ("time", "sector")))
    times = FrameTimes.of(phase, "phase", scale)
    span = (-0.5, table.shape[1] - 0.5)
    drawn = draw_time_raster(ax, table, times, span, PHASE_LIMITS, PHASE_COLOURS, "nearest")
    drawn.set_cmap(colour_map(PHASE_COLOURS))
    ax.set_ylabel(SECTOR_LABEL)
    ax.yaxis.set_major_locator(MaxNLocator(4, steps=TICK_STEPS, integer=True))
    return drawn


def wrapped(phase: FloatArray) -> FloatArray:
    """Phases from -π to π."""
    return np.asarray(np.angle(np.exp(1j * phase)))


def _draw_crests(ax: Axes, phase: FloatArray, times: FrameTimes) -> QuadContourSet | None:
    """Lines where the phase is 0; none where the wave is at no crest, or in a single frame."""
    sine = crest_mask(phase)
    if len(phase) < 2 or not np.isfinite(sine).any():
        return None
    limits = ax.get_xlim(), ax.get_ylim()
    places = np.arange(-1, phase.shape[1] + 1)
    look: Any = {"levels": [0.0], "colors": "black", "linewidths": _CREST}
    crests = ax.contour(times.at, places, np.ma.masked_invalid(sine.T), **look)
    crests.set_path_effects([withStroke(linewidth=_HALO, foreground="white", alpha=0.75)])
    ax.set(xlim=limits[0], ylim=limits[1])
    return crests
