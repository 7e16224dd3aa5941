"""Draw in the disk: signal, windows and mesh.

u goes to the right and v downwards, as x and y do in the cell's image, so nothing is mirrored. Angles run
from +u towards +v, that is clockwise on the page.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Colormap
from matplotlib.image import AxesImage
from matplotlib.patches import Circle

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.plot.cell.cell_axes import draw_mesh
from cytodisk.plot.cell.mesh_curves import mesh_curves
from cytodisk.plot.cell.window_polygons import add_filled_windows, add_windows, window_values
from cytodisk.plot.style import LINE_COLOUR, MISSING_COLOUR, SIGNAL_COLOURS, colour_map, signal_limits
from cytodisk.windows.polar_windows import PolarGrid

_REACH = 1.26  # of the axes, in radii: room for the angles
_DEGREES_PER_POINT = 1.0
_TICK = (1.03, 1.07)
_LABEL_RADIUS = 1.1


def fit_disk(ax: Axes) -> None:
    """Fit the axes to the unit disk with room for the angles, and hide them."""
    ax.set_aspect("equal")
    ax.set_xlim(-_REACH, _REACH)
    ax.set_ylim(_REACH, -_REACH)
    ax.set_axis_off()


def frame_disk(
    ax: Axes, sectors: int | None = None, nucleus_radius: float | None = None, *, angles: bool = True
) -> None:
    """Fit the axes to the unit disk, hide them, and draw the circle with ticks every 30°, labels every 90°.

    Parameters
    ----------
    ax : Axes
    sectors : int, optional
        Number of sectors of the windows: labels then give the sector that begins there, or holds the angle.
    nucleus_radius : float, optional
        Radius of the nucleus, whose circle is drawn as thick as the rim.
    angles : bool
        Without them labels are the numbers of sectors alone, which take less room.
    """
    fit_disk(ax)
    for radius in (1.0,) if nucleus_radius is None else (1.0, nucleus_radius):
        ax.add_patch(Circle((0.0, 0.0), radius, fill=False, edgecolor=LINE_COLOUR, linewidth=0.6, zorder=3))
    turn = np.radians(np.arange(0, 360, 30))
    rays = np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    ticks = [np.stack([_TICK[0] * ray, _TICK[1] * ray]) for ray in rays]
    ax.add_collection(LineCollection(ticks, colors=LINE_COLOUR, linewidths=0.5), autolim=False)
    for degrees, across, down in (
        (0, "left", "center"),
        (90, "center", "top"),
        (180, "right", "center"),
        (270, "center", "bottom"),
    ):
        u, v = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
        words = f"{degrees}°"
        if sectors is not None:
            number = sectors * degrees // 360
            words = f"sector {number} ({words})" if across == "center" else f"{number}\n{words}"
            words = words if angles else str(number)
        ax.text(_LABEL_RADIUS * u, _LABEL_RADIUS * v, words, ha=across, va=down)


def draw_disk_image(
    ax: Axes,
    disk: DiskMap,
    signal: Any,
    *,
    size: int = 384,
    cmap: str | Colormap = SIGNAL_COLOURS,
    limits: tuple[float, float] | None = None,
) -> AxesImage:
    """Draw a signal on the disk.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    signal : array_like of shape (H, W)
        One channel of one frame, of the shape of the mask; NaN is drawn light grey, as
        excluded holes are.
    size : int
        Pixels across the disk.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours, in the signal's unit; by default the percentiles 1 and 99.5 inside the cell.

    Returns
    -------
    AxesImage

    Raises
    ------
    SignalError
        The signal has another shape than the mask.
    ParameterError
        `size` is below 1, or there is no such colour map.

    See Also
    --------
    draw_cell : The same in the cell.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(12)
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_disk_image(ax, cd.map_to_disk(mask), cd.simulate.ring_signal(mask), size=64)
    """
    image = disk.image(signal, size)
    low, high = limits or signal_limits(signal, disk.mask_without_holes)
    colours = colour_map(cmap).with_extremes(bad=(1.0, 1.0, 1.0, 0.0))
    ax.add_patch(Circle((0.0, 0.0), 1.0, facecolor=MISSING_COLOUR, linewidth=0.0, zorder=-1))
    drawn = ax.imshow(image, cmap=colours, vmin=low, vmax=high, extent=(-1.0, 1.0, 1.0, -1.0))
    frame_disk(ax)
    if disk.nucleus_radius is not None:  # white and thin, as outlines over a signal are in the cell
        circle = Circle((0.0, 0.0), disk.nucleus_radius, fill=False, edgecolor="white", linewidth=0.6)
        ax.add_patch(circle)
    return drawn


def draw_disk_windows(
    ax: Axes,
    grid: PolarGrid,
    *,
    by_layer: bool = False,
    color: str = LINE_COLOUR,
    linewidth: float = 0.25,
) -> PolyCollection:
    """Draw a grid of windows on the disk.

    Parameters
    ----------
    ax : Axes
    grid : PolarGrid
    by_layer : bool
        Fill each window with the colour of its layer.
    color : str
        Colour of the lines.
    linewidth : float
        In points.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number.

    See Also
    --------
    draw_windows : The windows in the cell.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> polygons = cd.plot.draw_disk_windows(ax, cd.polar_windows(layers=3, sectors=8))
    >>> len(polygons.get_paths())
    24
    """
    style = {"edgecolors": color, "linewidths": linewidth}
    drawn = add_windows(ax, disk_polygons(grid), grid, by_layer=by_layer, style=style)
    frame_disk(ax, nucleus_radius=grid.nucleus_radius)
    return drawn


def draw_disk_means(
    ax: Axes,
    grid: PolarGrid,
    values: Any,
    *,
    cmap: str | Colormap = SIGNAL_COLOURS,
    limits: tuple[float, float] | None = None,
    number_sectors: bool = False,
) -> PolyCollection:
    """Fill each window of the disk with the colour of its value.

    Parameters
    ----------
    ax : Axes
    grid : PolarGrid
    values : array_like of shape (layers, sectors)
        NaN is drawn light grey.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of the values.
    number_sectors : bool
        Write the numbers of the sectors at 0°, 90°, 180° and 270° too.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number.

    Raises
    ------
    WindowError
        `values` has another shape than the grid.
    ParameterError
        There is no such colour map.

    See Also
    --------
    draw_window_means : The same in the cell.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> values = np.arange(24.0).reshape(3, 8)
    >>> polygons = cd.plot.draw_disk_means(ax, cd.polar_windows(layers=3, sectors=8), values)
    """
    table = window_values(values, (grid.layers, grid.sectors))
    drawn = add_filled_windows(ax, disk_polygons(grid), table, cmap, limits)
    frame_disk(ax, grid.sectors if number_sectors else None, grid.nucleus_radius)
    return drawn


def draw_disk_mesh(
    ax: Axes, disk: DiskMap, *, color: str = "0.35", linewidth: float = 0.12
) -> LineCollection:
    """Draw the mesh as it lies on the disk; with a nucleus most of its edges are curves there.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    color : str
    linewidth : float
        In points.

    Returns
    -------
    LineCollection

    See Also
    --------
    draw_mesh : The mesh in the cell.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> edges = cd.plot.draw_disk_mesh(ax, cd.map_to_disk(cd.simulate.disk(8)))
    """
    if disk.nucleus is None:
        lines = draw_mesh(ax, disk.vertices_uv[:, ::-1], disk.triangles, color=color, linewidth=linewidth)
    else:
        lines = LineCollection(mesh_curves(disk, disk.nucleus), colors=color, linewidths=linewidth)
        ax.add_collection(lines, autolim=False)
    frame_disk(ax, nucleus_radius=disk.nucleus_radius)
    return lines


def disk_polygons(grid: PolarGrid) -> list[FloatArray]:
    """Outline of every window on the disk.

    Parameters
    ----------
    grid : PolarGrid

    Returns
    -------
    list of ndarray of shape (N, 2) and dtype float
        By window number, (u, v), arcs sampled every degree or finer.
    """
    points = int(np.ceil(360.0 / grid.sectors / _DEGREES_PER_POINT)) + 1
    polygons = []
    for outer, inner in zip(grid.radii[:-1], grid.radii[1:], strict=True):
        for start, stop in zip(grid.angles[:-1], grid.angles[1:], strict=True):
            angle = np.linspace(start, stop, points)
            arc = np.column_stack([np.cos(angle), np.sin(angle)])
            polygons.append(
                np.concatenate([outer * arc, inner * arc[::-1] if inner > 0 else np.zeros((1, 2))])
            )
    return polygons
