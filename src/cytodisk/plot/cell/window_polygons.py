"""Draw polar windows in the cell as polygons, by their outlines or filled with colours."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import BoundaryNorm, Colormap, ListedColormap

from cytodisk.arrays import FloatArray
from cytodisk.errors import WindowError
from cytodisk.plot.cell.cell_axes import draw_nucleus, draw_outline, frame_cell
from cytodisk.plot.cell.hole_marks import cover_holes
from cytodisk.plot.layer_looks import NUCLEUS_LINE, layer_fills
from cytodisk.plot.style import LAYER_COLOURS, SIGNAL_COLOURS, colour_map, signal_limits
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows, PolarGrid

_NUCLEUS_WIDTH = 0.8  # points, of the nuclear outline among thin lines


def draw_windows(
    ax: Axes,
    windows: CellWindows,
    *,
    by_layer: bool = False,
    color: str = "white",
    nucleus_color: str = NUCLEUS_LINE,
    linewidth: float = 0.25,
    alpha: float | None = None,
) -> PolyCollection:
    """Draw the windows over a cell, and the outline of its nucleus; `frame_cell` fits the axes.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    by_layer : bool
        Fill each window with the colour of its layer, blue in the nucleus; see `alpha` for windows over an
        image.
    color, nucleus_color : str
        Colours of the lines of windows, of those in the nucleus and of its outline.
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
    polygons = window_polygons(windows)
    inside = np.repeat(windows.grid.compartments == "nucleus", windows.sectors)
    lines = [nucleus_color if within else color for within in inside]
    style = {"edgecolors": lines, "linewidths": linewidth, "alpha": alpha}
    drawn = add_windows(ax, polygons, windows.grid, by_layer=by_layer, style=style)
    if windows.disk.nucleus is not None:
        draw_nucleus(ax, windows.disk, color=nucleus_color, linewidth=max(linewidth, _NUCLEUS_WIDTH))
    return drawn


def draw_window_means(
    ax: Axes,
    windows: CellWindows,
    values: Any,
    *,
    scale: Scale | None = None,
    cmap: str | Colormap = SIGNAL_COLOURS,
    limits: tuple[float, float] | None = None,
) -> PolyCollection:
    """Fill each window of a cell with the colour of its value.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    values : array_like of shape (layers, sectors)
        NaN is drawn light grey, as excluded holes are.
    scale : Scale, optional
        By default that of the windows; without a pixel size the scale bar is in px.
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
        There is no such colour map.

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
    polygons = window_polygons(windows)
    drawn = add_filled_windows(ax, polygons, table, cmap, limits)
    cover_holes(ax, windows.disk)
    draw_outline(ax, windows.disk, linewidth=0.25)
    frame_cell(ax, windows.disk, scale=scale_for(windows, scale))
    return drawn


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
    drawn.set_clim(*(limits or signal_limits(table)))
    ax.add_collection(drawn, autolim=False)
    return drawn


def add_windows(
    ax: Axes,
    polygons_xy: list[FloatArray],
    grid: PolarGrid,
    *,
    by_layer: bool,
    style: dict[str, Any],
) -> PolyCollection:
    """Add polygons, by window number, empty or with the colours of their layers.

    Parameters
    ----------
    ax : Axes
    polygons_xy : list of ndarray of shape (N, 2) and dtype float
    grid : PolarGrid
    by_layer : bool
    style : dict
        Of the lines.

    Returns
    -------
    PolyCollection
    """
    if not by_layer:
        drawn = PolyCollection(polygons_xy, facecolors="none", **style)
    else:
        colours = colour_map(LAYER_COLOURS)
        if grid.nucleus_layers:
            colours = ListedColormap(layer_fills(grid.layers, grid.nucleus_layers))
        norm = BoundaryNorm(np.arange(grid.layers + 1) - 0.5, colours.N)
        drawn = PolyCollection(polygons_xy, cmap=colours, norm=norm, **style)
        drawn.set_array(np.repeat(np.arange(grid.layers), grid.sectors))
    ax.add_collection(drawn, autolim=False)
    return drawn


def window_polygons(windows: CellWindows) -> list[FloatArray]:
    """Outlines of windows in the cell, (x, y), by window number.

    Parameters
    ----------
    windows : CellWindows

    Returns
    -------
    list of ndarray of shape (N, 2) and dtype float

    Raises
    ------
    WindowError
        `windows` have no outlines: only polar windows have.
    """
    if not isinstance(windows, CellWindows):
        raise WindowError(
            f"windows must be polar windows on a cell, got {type(windows).__name__}, which has no outlines: "
            "use draw_window_labels"
        )
    return [polygon[:, ::-1] for polygon in windows.polygons()]
