"""Draw in the cell: signal, windows, mesh and distortion.

x and y are pixels, pixel centres at integers, y downwards as in an image. The axes themselves are hidden;
a scale bar stands for them.
"""

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import BoundaryNorm, Colormap
from matplotlib.image import AxesImage
from matplotlib.patches import Polygon

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.distortion import Distortion
from cytodisk.errors import ParameterError, SignalError, WindowError
from cytodisk.plot.style import (
    DIVERGING_COLOURS,
    LAYER_COLOURS,
    LINE_COLOUR,
    SIGNAL_COLOURS,
    colour_map,
    scale_bar,
    signal_limits,
)
from cytodisk.windows.cell_windows import CellWindows

DISTORTION_LABEL = "disk area / cell area, log2"

_MARGIN = 0.03  # of the cell's longer side
_DISTORTION_SHARE = 0.99  # of the cell's area whose colours are not cut off
_LEAST_LIMIT = 0.1  # log2, so that a perfect map does not show rounding errors in full colour


def frame_cell(ax: Axes, disk: DiskMap, *, pixel_size_um: float | None = None) -> None:
    """Fit the axes to a cell, hide them, and draw a scale bar below.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    pixel_size_um : float, optional
        Micrometres a pixel; without it the bar is in px.

    Raises
    ------
    ParameterError
        The pixel size is not a positive number.

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
    low, high = disk.outline_yx.min(axis=0), disk.outline_yx.max(axis=0)
    margin = _MARGIN * float((high - low).max())
    ax.set_aspect("equal")
    ax.set_xlim(low[1] - margin, high[1] + margin)
    ax.set_ylim(high[0] + margin, low[0] - margin)
    ax.set_axis_off()
    scale_bar(ax, pixel_size_um)


def draw_outline(ax: Axes, disk: DiskMap, *, color: str = LINE_COLOUR, linewidth: float = 0.4) -> Polygon:
    """Draw the cell's outline.

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

    See Also
    --------
    draw_cell : With the signal below.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> figure, ax = plt.subplots()
    >>> outline = cd.plot.draw_outline(ax, cd.map_to_disk(cd.simulate.disk(12)))
    >>> outline.get_xy().shape[1]
    2
    """
    outline = Polygon(disk.outline_yx[:, ::-1], fill=False, edgecolor=color, linewidth=linewidth, zorder=3)
    ax.add_artist(outline)  # add_patch would measure all its points, for limits that the callers set
    return outline


def draw_cell(
    ax: Axes,
    image: Any,
    disk: DiskMap,
    *,
    pixel_size_um: float | None = None,
    cmap: str | Colormap = "gray",
    limits: tuple[float, float] | None = None,
) -> AxesImage:
    """Draw the signal around a cell with the cell's outline.

    Parameters
    ----------
    ax : Axes
    image : array_like of shape (H, W)
        One channel of one frame, of the shape of the mask.
    disk : DiskMap
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale bar is in px.
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
        The pixel size is not a positive number, or there is no such colour map.

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
    values = np.asarray(image)
    if values.shape != disk.mask.shape:
        raise SignalError(
            f"image has shape {values.shape}, the mask {disk.mask.shape}: pass one channel of one frame"
        )
    low, high = limits or signal_limits(values, disk.mask)
    drawn = ax.imshow(values, cmap=colour_map(cmap), vmin=low, vmax=high)
    draw_outline(ax, disk, color="white", linewidth=0.3)
    frame_cell(ax, disk, pixel_size_um=pixel_size_um)
    return drawn


def draw_windows(
    ax: Axes,
    windows: CellWindows,
    *,
    by_layer: bool = False,
    color: str = "white",
    linewidth: float = 0.25,
    alpha: float | None = None,
) -> PolyCollection:
    """Draw the windows over a cell; `frame_cell` fits the axes when nothing else did.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    by_layer : bool
        Fill each window with the colour of its layer.
    color : str
        Colour of the lines.
    linewidth : float
        In points.
    alpha : float, optional
        Opacity, 0 to 1.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number.

    Raises
    ------
    WindowError
        `windows` have no outlines: only polar windows have.

    See Also
    --------
    draw_disk_windows : The windows on the disk.
    draw_window_means : Filled with the colours of values.
    draw_window_labels : Windows of any kind, by pixel.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.disk(12))
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(disk)
    >>> figure, ax = plt.subplots()
    >>> polygons = cd.plot.draw_windows(ax, windows, color="black")
    >>> len(polygons.get_paths())
    24
    """
    style = {"edgecolors": color, "linewidths": linewidth, "alpha": alpha}
    polygons = [polygon[:, ::-1] for polygon in _with_outlines(windows).polygons()]
    return add_windows(ax, polygons, *windows.areas.shape, by_layer=by_layer, style=style)


def draw_window_means(
    ax: Axes,
    windows: CellWindows,
    values: Any,
    *,
    pixel_size_um: float | None = None,
    cmap: str | Colormap = SIGNAL_COLOURS,
    limits: tuple[float, float] | None = None,
) -> PolyCollection:
    """Fill each window of a cell with the colour of its value.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    values : array_like of shape (layers, sectors)
        NaN is drawn light grey.
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale bar is in px.
    cmap : str or Colormap
    limits : (float, float), optional
        Limits of the colours; by default percentiles 1 and 99.5 of the values.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number.

    Raises
    ------
    WindowError
        `values` has another shape than the windows, or `windows` have no outlines: only polar ones have.
    ParameterError
        The pixel size is not a positive number, or there is no such colour map.

    See Also
    --------
    draw_disk_means : The same on the disk.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> mask = cd.simulate.disk(12)
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(cd.map_to_disk(mask))
    >>> means = cd.sample(windows, cd.simulate.ring_signal(mask))["mean"]
    >>> figure, ax = plt.subplots()
    >>> polygons = cd.plot.draw_window_means(ax, windows, means)
    """
    table = window_values(values, windows.areas.shape)
    polygons = [polygon[:, ::-1] for polygon in _with_outlines(windows).polygons()]
    drawn = add_filled_windows(ax, polygons, table, cmap, limits)
    draw_outline(ax, windows.disk, linewidth=0.25)
    frame_cell(ax, windows.disk, pixel_size_um=pixel_size_um)
    return drawn


def _with_outlines(windows: CellWindows) -> CellWindows:
    if not isinstance(windows, CellWindows):
        raise WindowError(
            f"windows must be polar windows on a cell, got {type(windows).__name__}, which has no outlines: "
            "use draw_window_labels"
        )
    return windows


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


def draw_area_distortion(
    ax: Axes, disk: DiskMap, *, pixel_size_um: float | None = None, limit: float | None = None
) -> PolyCollection:
    """Fill each triangle of the cell with the colour of log2 λ, its share of the disk over that of the cell.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale bar is in px.
    limit : float, optional
        Colours go from -limit to limit, white at 0; by default as far as 99 % of the cell's area goes.

    Returns
    -------
    PolyCollection
        One polygon a triangle; its label, for a colour bar, is "disk area / cell area, log2".

    Raises
    ------
    ParameterError
        The pixel size or the limit is not a positive number.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.ellipse((8, 16)))
    >>> figure, ax = plt.subplots()
    >>> triangles = cd.plot.draw_area_distortion(ax, disk)
    >>> triangles.get_label()
    'disk area / cell area, log2'
    """
    if limit is not None and not 0 < limit < np.inf:
        raise ParameterError(f"limit must be a positive number, got {limit!r}: pass None to have it chosen")
    top = limit if limit is not None else distortion_limit(disk.distortion)
    corners = disk.vertices_yx[disk.triangles][:, :, ::-1]
    drawn = PolyCollection(
        list(corners),
        cmap=colour_map(DIVERGING_COLOURS),
        edgecolors="face",
        linewidths=0.1,
        label=DISTORTION_LABEL,
    )
    drawn.set_array(np.log2(disk.distortion.triangle_area_ratio))
    drawn.set_clim(-top, top)
    ax.add_collection(drawn, autolim=False)
    draw_outline(ax, disk, color="0.5", linewidth=0.25)
    frame_cell(ax, disk, pixel_size_um=pixel_size_um)
    return drawn


def distortion_limit(distortion: Distortion) -> float:
    """The |log2 λ| that all but 1 % of the cell's area stays below, at least 0.1.

    Parameters
    ----------
    distortion : Distortion

    Returns
    -------
    float
    """
    size = np.abs(np.log2(distortion.triangle_area_ratio))
    order = np.argsort(size)
    below = np.cumsum(distortion.area_share[order])
    at = min(int(np.searchsorted(below, _DISTORTION_SHARE * below[-1])), len(order) - 1)
    return max(float(size[order[at]]), _LEAST_LIMIT)


def window_values(values: Any, shape: tuple[int, ...]) -> FloatArray:
    """Values of windows as an array, checked against the windows' shape.

    Parameters
    ----------
    values : array_like or DataArray of shape (layers, sectors)
    shape : (int, int)
        Layers and sectors.

    Returns
    -------
    ndarray of shape (layers, sectors) and dtype float

    Raises
    ------
    WindowError
        `values` is not numeric or has another shape.
    """
    if isinstance(values, xr.DataArray) and set(values.dims) == {"layer", "sector"}:
        values = values.transpose("layer", "sector")
    array = np.asarray(values)
    if array.dtype.kind not in "biuf":
        raise WindowError(f"values must be numbers, got dtype {array.dtype}: pass one number a window")
    if array.shape != tuple(shape):
        raise WindowError(
            f"values has shape {array.shape}, the windows {tuple(shape)}: pass one number a window, "
            "such as sample(windows, signal)['mean'] of one channel"
        )
    return array.astype(np.float64)


def add_filled_windows(
    ax: Axes,
    polygons_xy: list[FloatArray],
    table: FloatArray,
    cmap: str | Colormap,
    limits: tuple[float, float] | None,
) -> PolyCollection:
    """Add polygons, by window number, with the colours of a (layer, sector) table.

    Parameters
    ----------
    ax : Axes
    polygons_xy : list of ndarray of shape (N, 2) and dtype float
    table : ndarray of shape (layers, sectors) and dtype float
    cmap : str or Colormap
    limits : (float, float), optional

    Returns
    -------
    PolyCollection
    """
    drawn = PolyCollection(polygons_xy, cmap=colour_map(cmap), edgecolors="face", linewidths=0.2)
    drawn.set_array(np.ma.masked_invalid(table.ravel()))
    drawn.set_clim(*(limits or signal_limits(table, np.isfinite(table))))
    ax.add_collection(drawn, autolim=False)
    return drawn


def add_windows(
    ax: Axes,
    polygons_xy: list[FloatArray],
    layers: int,
    sectors: int,
    *,
    by_layer: bool,
    style: dict[str, Any],
) -> PolyCollection:
    if not by_layer:
        drawn = PolyCollection(polygons_xy, facecolors="none", **style)
    else:
        colours = colour_map(LAYER_COLOURS)
        norm = BoundaryNorm(np.arange(layers + 1) - 0.5, colours.N)
        drawn = PolyCollection(polygons_xy, cmap=colours, norm=norm, **style)
        drawn.set_array(np.repeat(np.arange(layers), sectors))
    ax.add_collection(drawn, autolim=False)
    return drawn
