"""Windows of any kind in a cell, drawn pixel by pixel: those that have no outlines, too."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.image import AxesImage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import WindowError
from cytodisk.plot.field_of_view import frame_field
from cytodisk.plot.layer_looks import CYTOPLASM_COLOURS, NUCLEUS_COLOURS
from cytodisk.plot.outline_sides import outline_sides
from cytodisk.plot.style import LAYER_COLOURS, LINE_COLOUR
from cytodisk.windows.on_cell import WindowsOnCell

_DARKEST, _LIGHTEST = 0.05, 0.9  # share of the colours that is used
_PALE = 0.35  # share of white in every other sector


def draw_window_labels(ax: Axes, windows: WindowsOnCell) -> AxesImage:
    """Draw which pixel is in which window: dark at the edge, light inside, every other sector paler.

    Layers of a nucleus are blue, those of its cytoplasm brown to yellow.

    Works for edge-based windows and rings as for polar ones. White pixels of the cell are in no window.

    Parameters
    ----------
    ax : Axes
    windows : WindowsOnCell
        Such as from `polar_windows`, `edge_windows` or `ring_windows`, on a cell.

    Returns
    -------
    AxesImage

    Raises
    ------
    WindowError
        `windows` are not windows on a cell.

    See Also
    --------
    draw_windows : Outlines of polar windows.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> windows = cd.edge_windows(cd.simulate.disk(15), layers=3, sectors=8)
    >>> figure, ax = plt.subplots()
    >>> image = cd.plot.draw_window_labels(ax, windows)
    """
    if not isinstance(windows, WindowsOnCell):
        raise WindowError(f"windows must be those on a cell, got {type(windows).__name__}: use grid.on(disk)")
    mask = windows.mask_without_holes
    grid = windows.layers, windows.sectors
    drawn = draw_label_image(ax, windows.labels, mask, grid, getattr(windows.grid, "nucleus_layers", 0))
    rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    frame_field(ax, (rows[0] - 1.5, rows[-1] + 1.5, columns[0] - 1.5, columns[-1] + 1.5))
    return drawn


def draw_label_image(
    ax: Axes, labels: Any, mask: BoolArray, grid: tuple[int, int], nucleus_layers: int = 0
) -> AxesImage:
    """Draw which pixel is in which window, with the outline of the cell along the sides of its pixels.

    Parameters
    ----------
    ax : Axes
    labels : ndarray of shape (H, W) and dtype int, or None
        layer · sectors + sector, -1 for none. None if there are no windows: the cell is left white.
    mask : ndarray of shape (H, W) and dtype bool
    grid : (int, int)
        Layers and sectors.
    nucleus_layers : int
        How many of the layers are in the nucleus, the last ones.

    Returns
    -------
    AxesImage
    """
    numbers = np.full(mask.shape, -1) if labels is None else labels
    drawn = ax.imshow(window_colours(numbers, grid, nucleus_layers), interpolation="nearest")
    sides: Any = list(outline_sides(mask) - 0.5)
    ax.add_collection(LineCollection(sides, colors=LINE_COLOUR, linewidths=0.25))
    return drawn


def window_colours(labels: Any, grid: tuple[int, int], nucleus_layers: int = 0) -> FloatArray:
    """Colour of each pixel by its window.

    Parameters
    ----------
    labels : ndarray of shape (H, W) and dtype int
    grid : (int, int)
        Layers and sectors.
    nucleus_layers : int
        How many of the layers are in the nucleus, the last ones: they are blue, the others brown to yellow.

    Returns
    -------
    ndarray of shape (H, W, 3) and dtype float
        Red, green, blue; white where there is no window.
    """
    layers, sectors = grid
    layer, sector = np.divmod(labels, sectors)
    outer = layers - nucleus_layers
    cytoplasm = CYTOPLASM_COLOURS if nucleus_layers else mpl.colormaps[LAYER_COLOURS]
    colours = np.asarray(cytoplasm(_shares(layer, outer)))[..., :3]
    if nucleus_layers:
        nucleus = np.asarray(NUCLEUS_COLOURS(_shares(layer - outer, nucleus_layers)))[..., :3]
        colours = np.where((layer < outer)[..., None], colours, nucleus)
    pale = _PALE * (sector % 2)[..., None]
    return np.where((labels >= 0)[..., None], colours * (1.0 - pale) + pale, 1.0)


def _shares(layer: Any, layers: int) -> Any:
    """Place of layers in a map of colours."""
    return _DARKEST + (_LIGHTEST - _DARKEST) * layer / max(layers - 1, 1)
