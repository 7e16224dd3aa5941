"""Draw in the cell: signal, outline and mesh.

x and y are pixels, pixel centres at integers, y downwards as in an image. The axes themselves are hidden;
a scale bar stands for them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import Colormap
from matplotlib.image import AxesImage
from matplotlib.patches import Polygon

from cytodisk.arrays import AnyArray, BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, SignalError
from cytodisk.plot.cell.hole_marks import outline_holes
from cytodisk.plot.field_of_view import field_of_view, frame_field
from cytodisk.plot.style import LINE_COLOUR, colour_map, scale_bar, signal_limits
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale

_MARGIN = 0.03  # of the cell's longer side


def frame_cell(ax: Axes, disk: DiskMap, *, scale: Scale | None = None) -> None:
    """Fit the axes to a cell, hide them, and draw a scale bar below.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    scale : Scale, optional
        By default that of the map; without a pixel size the scale bar is in px.

    See Also
    --------
    scale_bar : The bar alone.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.disk(12))
    >>> figure, ax = plt.subplots()
    >>> outline = cd.plot.draw_outline(ax, disk)
    >>> cd.plot.frame_cell(ax, disk)
    """
    frame_field(ax, field_of_view([disk.outline_yx], _MARGIN))
    scale_bar(ax, scale_for(disk, scale))


def draw_outline(ax: Axes, disk: DiskMap, *, color: str = LINE_COLOUR, linewidth: float = 0.4) -> Polygon:
    """Draw the cell's outline, and that of its nucleus where the map has one.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    color : str
    linewidth : float
        In points.

    Returns
    -------
    Polygon
        The cell's outline.

    See Also
    --------
    draw_cell : With the signal below.
    draw_nucleus : The nuclear outline alone.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> outline = cd.plot.draw_outline(ax, cd.map_to_disk(cd.simulate.disk(12)))
    >>> outline.get_xy().shape[1]
    2
    """
    if disk.nucleus is not None:
        draw_nucleus(ax, disk, color=color, linewidth=linewidth)
    return draw_loop(ax, disk.outline_yx, color, linewidth)


def draw_nucleus(ax: Axes, disk: DiskMap, *, color: str = LINE_COLOUR, linewidth: float = 0.8) -> Polygon:
    """Draw the outline of a cell's nucleus.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
        With a nucleus.
    color : str
    linewidth : float
        In points.

    Returns
    -------
    Polygon

    Raises
    ------
    ParameterError
        The map has no nucleus.

    See Also
    --------
    draw_outline : Both outlines.
    draw_nucleus_profile : What lies between them.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> cell = cd.simulate.cell_with_nucleus("bean")
    >>> disk = cd.map_to_disk(cell.mask, nucleus=cell.nucleus)
    >>> figure, ax = plt.subplots()
    >>> outline = cd.plot.draw_nucleus(ax, disk)
    """
    outline = disk.nucleus_outline_yx
    if outline is None:
        raise ParameterError("disk has no nucleus to draw: pass nucleus to map_to_disk")
    return draw_loop(ax, outline, color, linewidth)


def draw_loop(ax: Axes, points_yx: FloatArray, color: str, linewidth: float) -> Polygon:
    """Draw a closed line through points, (row, column), shape (N, 2)."""
    loop = Polygon(points_yx[:, ::-1], fill=False, edgecolor=color, linewidth=linewidth, zorder=3)
    ax.add_artist(loop)  # add_patch would measure all its points, for limits that the callers set
    return loop


def draw_cell(
    ax: Axes,
    image: Any,
    disk: DiskMap,
    *,
    scale: Scale | None = None,
    cmap: str | Colormap = "gray",
    limits: tuple[float, float] | None = None,
) -> AxesImage:
    """Draw the signal around a cell with the outlines of the cell, its nucleus and excluded holes.

    Parameters
    ----------
    ax : Axes
    image : array_like of shape (H, W)
        One channel of one frame, of the shape of the mask.
    disk : DiskMap
    scale : Scale, optional
        By default that of the map; without a pixel size the scale bar is in px.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours, in the signal's unit; by default the percentiles 1 and 99.5 inside the cell.

    Returns
    -------
    AxesImage

    Raises
    ------
    SignalError
        The image has another shape than the mask.
    ParameterError
        There is no such colour map.

    See Also
    --------
    draw_disk_image : The same on the disk.
    draw_outline : The outline alone.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(12)
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_cell(ax, cd.simulate.ring_signal(mask), cd.map_to_disk(mask))
    """
    values = fitting_image(image, disk.mask, "image")
    low, high = limits or signal_limits(values, disk.mask_without_holes)
    drawn = ax.imshow(values, cmap=colour_map(cmap), vmin=low, vmax=high)
    draw_outline(ax, disk, color="white", linewidth=0.3)
    outline_holes(ax, disk, color="white", linewidth=0.3)
    frame_cell(ax, disk, scale=scale)
    return drawn


def fitting_image(image: Any, mask: BoolArray, name: str) -> AnyArray:
    """An image of the shape of a mask.

    Parameters
    ----------
    image : array_like
    mask : ndarray of shape (H, W) and dtype bool
    name : str
        Name of the argument, for the error.

    Returns
    -------
    ndarray of shape (H, W)

    Raises
    ------
    SignalError
        The image has another shape.
    """
    values = np.asarray(image)
    if values.shape != mask.shape:
        raise SignalError(
            f"{name} has shape {values.shape}, the mask {mask.shape}: pass one channel of one frame"
        )
    return values


def draw_mesh(
    ax: Axes,
    points_yx: FloatArray,
    triangles: IntArray,
    *,
    color: str = "0.35",
    linewidth: float = 0.12,
) -> LineCollection:
    """Draw every edge of a triangulation once.

    Parameters
    ----------
    ax : Axes
    points_yx : ndarray of shape (V, 2) and dtype float
        (row, column); for a mesh in the disk `vertices_uv[:, ::-1]`, or `draw_disk_mesh`.
    triangles : ndarray of shape (F, 3) and dtype int
    color : str
    linewidth : float
        In points.

    Returns
    -------
    LineCollection

    Raises
    ------
    ParameterError
        An array has the wrong shape.

    See Also
    --------
    draw_disk_mesh : The mesh on the disk.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.disk(8))
    >>> figure, ax = plt.subplots()
    >>> edges = cd.plot.draw_mesh(ax, disk.vertices_yx, disk.triangles)
    """
    points, corners = np.asarray(points_yx, dtype=np.float64), np.asarray(triangles)
    for name, array, last in (("points_yx", points, 2), ("triangles", corners, 3)):
        if array.ndim != 2 or array.shape[1] != last:
            raise ParameterError(
                f"{name} must have shape (N, {last}), got {array.shape}: pass a DiskMap's arrays"
            )
    sides = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    edges = np.unique(sides, axis=0)
    lines = LineCollection(list(points[edges][:, :, ::-1]), colors=color, linewidths=linewidth)
    ax.add_collection(lines, autolim=False)
    return lines
