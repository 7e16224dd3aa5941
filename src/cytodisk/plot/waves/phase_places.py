"""Draw the phase of a wave where it is: on the disk, in the windows of the cell, and along its edge."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.cell.cell_axes import draw_loop, frame_cell
from cytodisk.plot.cell.disk_axes import disk_polygons, frame_disk
from cytodisk.plot.cell.sector_marks import sector_arcs
from cytodisk.plot.cell.window_polygons import add_filled_windows, draw_window_means, window_values
from cytodisk.plot.style import LINE_COLOUR, MISSING_COLOUR, colour_map
from cytodisk.plot.units import scale_for
from cytodisk.plot.waves.phase_colours import PHASE_COLOURS, PHASE_LIMITS
from cytodisk.plot.waves.wave_kymograph import wrapped
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows, PolarGrid, polar_windows

WAY_NAME = "way of the wave"

_EDGE = 2.4  # points
_RING = np.array([1.0, 0.78, 0.0])  # radii: the edge alone is a ring on the disk
_ARROW_RADIUS, _ARROW_DEGREES = 1.16, (290.0, 340.0)
_BORDER = "0.35"


def draw_phase_on_disk(
    ax: Axes, grid: PolarGrid, phase: Any, *, way: int = 0, number_sectors: bool = False
) -> PolyCollection:
    """Fill the windows of the disk with the colour of the wave's phase.

    Parameters
    ----------
    ax : Axes
    grid : PolarGrid
    phase : array_like of shape (layers, sectors) or (sectors,)
        In radians, 0 at a crest, at one time; NaN is drawn light grey. By sector alone, it fills a ring.
    way : {1, -1, 0}
        1 draws an arrow along the rim towards higher sectors, which is clockwise as in the cell's image; -1
        the other way; 0 none.
    number_sectors : bool
        Write the numbers of the sectors at 0°, 90°, 180° and 270° too.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number.

    Raises
    ------
    WindowError
        The phase has another shape than the grid.

    See Also
    --------
    phase_key : What the colours mean.
    draw_phase_on_cell : The same in the cell.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> phase = np.tile(2 * np.pi * np.arange(8) / 8, (3, 1))
    >>> polygons = cd.plot.draw_phase_on_disk(ax, cd.polar_windows(layers=3, sectors=8), phase)
    """
    if np.ndim(phase) == 1:
        ring = polar_windows(layers=2, sectors=grid.sectors).with_radii(_RING)
        table = wrapped(window_values(np.asarray(phase)[None], (1, grid.sectors)))
        polygons, nucleus = disk_polygons(ring)[: grid.sectors], None
    else:
        table = wrapped(window_values(phase, (grid.layers, grid.sectors)))
        polygons, nucleus = disk_polygons(grid), grid.nucleus_radius
    drawn = add_filled_windows(ax, polygons, table, PHASE_COLOURS, PHASE_LIMITS)
    frame_disk(ax, grid.sectors if number_sectors else None, nucleus, angles=False)
    if not number_sectors:
        _without_labels(ax)
    if way:
        _draw_way(ax, way)
    return drawn


def draw_phase_on_cell(
    ax: Axes, windows: CellWindows, phase: Any, *, scale: Scale | None = None
) -> PolyCollection | LineCollection:
    """Draw the wave's phase in the windows of a cell, or along its edge.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
        Of the same frame.
    phase : array_like of shape (layers, sectors) or (sectors,)
        In radians, 0 at a crest, at one time. By sector alone, the edge is coloured.
    scale : Scale, optional
        By default that of the windows.

    Returns
    -------
    PolyCollection or LineCollection
        One polygon a window, or one line a sector.

    Raises
    ------
    WindowError
        The phase has another shape than the windows.
    ParameterError
        It has another number of sectors.

    See Also
    --------
    draw_phase_on_disk : The same on the disk.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> windows = cd.polar_windows(layers=2, sectors=8).on(cd.map_to_disk(cd.simulate.disk(12)))
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_phase_on_cell(ax, windows, 2 * np.pi * np.arange(8) / 8)
    >>> len(lines.get_segments())
    8
    """
    values = wrapped(np.asarray(phase, dtype=np.float64))
    if values.ndim != 1:
        return draw_window_means(ax, windows, values, scale=scale, cmap=PHASE_COLOURS, limits=PHASE_LIMITS)
    if values.size != windows.sectors:
        raise ParameterError(
            f"phase has {values.size} sectors, the windows {windows.sectors}: pass one number a sector"
        )
    return _draw_along_edge(ax, windows, values, scale)


def _draw_along_edge(
    ax: Axes, windows: CellWindows, phase: FloatArray, scale: Scale | None
) -> LineCollection:
    """The edge in the colours of its phase, with thin dark borders, as the lightest is near white."""
    colours = colour_map(PHASE_COLOURS)(np.ma.masked_invalid((phase + np.pi) / (2.0 * np.pi)))
    colours[~np.isfinite(phase)] = (*[float(MISSING_COLOUR)] * 3, 1.0)
    draw_loop(ax, windows.disk.outline_yx, _BORDER, _EDGE + 0.8)
    arcs = [arc[:, ::-1] for arc in sector_arcs(windows)]
    look: Any = {"colors": colours, "linewidths": _EDGE, "zorder": 4, "capstyle": "butt"}
    lines = LineCollection(arcs, **look)
    ax.add_collection(lines, autolim=False)
    frame_cell(ax, windows.disk, scale=scale_for(windows, scale))
    return lines


def _without_labels(ax: Axes) -> None:
    """Of several disks beside each other one has numbers."""
    for text in list(ax.texts):
        text.remove()


def _draw_way(ax: Axes, way: int) -> None:
    """An arrow along the rim, between the numbers of sectors; angles grow clockwise on the page."""
    turn = np.radians(np.linspace(*_ARROW_DEGREES, 25)[:: int(np.sign(way))])
    x, y = _ARROW_RADIUS * np.cos(turn), _ARROW_RADIUS * np.sin(turn)
    look: Any = {"color": LINE_COLOUR, "linewidth": 0.9, "clip_on": False, "solid_capstyle": "butt"}
    ax.plot(x[:-1], y[:-1], gid=WAY_NAME, **look)
    ax.annotate(
        "",
        (float(x[-1]), float(y[-1])),
        (float(x[-3]), float(y[-3])),
        arrowprops={"arrowstyle": "-|>", "color": LINE_COLOUR, "linewidth": 0.9, "shrinkA": 0, "shrinkB": 0},
        annotation_clip=False,
    )
