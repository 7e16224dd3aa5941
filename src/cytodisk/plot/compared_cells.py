"""Windows of several methods on a few cells of a comparison (the paper's Fig. 3A)."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.image import AxesImage

from cytodisk.arrays import FloatArray
from cytodisk.files import replacing
from cytodisk.plot.comparison import spread_over
from cytodisk.plot.outlines import outline_sides
from cytodisk.plot.sheet import Sheet
from cytodisk.plot.style import DOUBLE_COLUMN_MM, LAYER_COLOURS, LINE_COLOUR, paper_style
from cytodisk.study.compare_parameters import ON_A_MAP, TITLES
from cytodisk.study.comparison import Comparison

_MOST_CELLS = 5
_LEFT, _TOP, _GAP, _WORDS = 6.0, 8.0, 2.0, 4.0  # mm
_BELOW = 5.0
_DPI = 300
_KEY = (
    "dark: layer at the edge, yellow: at the centre; every other sector paler. Percent: windows with signal."
)
_DARKEST, _LIGHTEST = 0.05, 0.9  # share of the colours that is used
_PALE = 0.35  # share of white in every other sector


def draw_compared_cells(comparison: Comparison, cells: Sequence[int] | None = None) -> Path | None:
    """Write `figures/cells.png`: up to five cells, a row a method.

    Layers have colours from the edge (dark) to the centre (light), and every other sector is paler; what lies
    in no window is white.

    Parameters
    ----------
    comparison : Comparison
        Not that of a movie.
    cells : sequence of int, optional
        Which cells, in this order; by default they go from simple to complex.

    Returns
    -------
    Path or None
        None if no cell has windows.

    References
    ----------
    u-Unwrap, Fig. 3A.
    """
    chosen = chosen_cells(comparison) if cells is None else list(cells)[:_MOST_CELLS]
    if not chosen:
        return None
    path = comparison.path / "figures" / "cells.png"
    size = (DOUBLE_COLUMN_MM - _LEFT - 2.0 - _GAP * (_MOST_CELLS - 1)) / _MOST_CELLS
    with paper_style():
        sheet = Sheet(_TOP + len(comparison.methods) * (size + _WORDS + _GAP) + _BELOW)
        for column, cell in enumerate(chosen):
            labels = comparison.labels(cell)
            left = _LEFT + column * (size + _GAP)
            sheet.text(left, _TOP - 2.0, _cell_name(comparison.cells, cell))
            for row, method in enumerate(comparison.methods):
                top = _TOP + row * (size + _WORDS + _GAP)
                ax = sheet.axes(left, top, size, size)
                draw_labels(ax, labels.get(method), labels["mask"], _grid(comparison))
                sheet.text(left, top + size + _WORDS - 1.2, _outcome(comparison, cell, method), color="0.35")
        for row, method in enumerate(comparison.methods):
            middle = _TOP + row * (size + _WORDS + _GAP) + size / 2
            sheet.text(2.0, middle, TITLES[method], rotation=90, va="center", ha="left")
        sheet.text(_LEFT, sheet.height_mm - 1.5, _KEY, color="0.35")
        with replacing(path) as temporary:
            sheet.figure.savefig(temporary, dpi=_DPI)
    return path


def chosen_cells(comparison: Comparison) -> list[int]:
    """Up to five cells, spread over the area error of the first map, or else over empty windows.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of int
        From the simplest on.
    """
    mapped = comparison.cells[comparison.cells["mapped"] > 0]
    for method in (*(name for name in comparison.methods if name in ON_A_MAP), *comparison.methods):
        rows = mapped[mapped["method"] == method]
        if len(rows):
            measure = rows["area_distortion" if method in ON_A_MAP else "empty_windows"]
            return [int(rows["cell"].iloc[place]) for place in spread_over(measure, _MOST_CELLS)]
    return []


def draw_labels(ax: Axes, labels: Any, mask: Any, grid: tuple[int, int]) -> AxesImage | None:
    """Draw which pixel is in which window, with the outline of the cell.

    Parameters
    ----------
    ax : Axes
    labels : ndarray of shape (H, W) and dtype int, or None
        layer · sectors + sector, -1 for none. None if there are no windows: the cell is left white.
    mask : ndarray of shape (H, W) and dtype bool
    grid : (int, int)
        Layers and sectors.

    Returns
    -------
    AxesImage or None
    """
    height, width = mask.shape
    drawn = None
    if labels is not None:
        extent = (0.0, width, height, 0.0)
        drawn = ax.imshow(window_colours(labels, grid), extent=extent, interpolation="nearest")
    ax.add_collection(LineCollection(list(outline_sides(mask)), colors=LINE_COLOUR, linewidths=0.25))
    side = max(height, width) / 2 + 1
    ax.set(xlim=(width / 2 - side, width / 2 + side), ylim=(height / 2 + side, height / 2 - side))
    ax.set_aspect("equal")
    ax.set_axis_off()
    return drawn


def window_colours(labels: Any, grid: tuple[int, int]) -> FloatArray:
    """Colour of each pixel by its window.

    Parameters
    ----------
    labels : ndarray of shape (H, W) and dtype int
    grid : (int, int)
        Layers and sectors.

    Returns
    -------
    ndarray of shape (H, W, 3) and dtype float
        Red, green, blue; white where there is no window.
    """
    layers, sectors = grid
    layer, sector = np.divmod(labels, sectors)
    share = _DARKEST + (_LIGHTEST - _DARKEST) * layer / max(layers - 1, 1)
    colours = np.asarray(mpl.colormaps[LAYER_COLOURS](share))[..., :3]
    pale = _PALE * (sector % 2)[..., None]
    return np.where((labels >= 0)[..., None], colours * (1.0 - pale) + pale, 1.0)


def _grid(comparison: Comparison) -> tuple[int, int]:
    settings = comparison.provenance["parameters"]
    return settings["layers"], settings["sectors"]


def _cell_name(cells: pd.DataFrame, cell: int) -> str:
    rows = cells[(cells["cell"] == cell) & cells["area_px"].notna()]
    return f"cell {cell} ({rows['area_px'].iloc[0]:.0f} px²)"


def _outcome(comparison: Comparison, cell: int, method: str) -> str:
    cells = comparison.cells
    (row,) = cells[(cells["cell"] == cell) & (cells["method"] == method)].to_dict("records")
    if not row["mapped"]:
        return "no map"
    layers, sectors = _grid(comparison)
    words = f"{1 - row['empty_windows'] / (layers * sectors):.0%}"
    if row["coverage"] < 0.995:
        words += f" ({row['coverage']:.0%} of the area)"
    if row["certificate_valid"] is False:
        words += f", {row['flipped']:.0f} flips"
    return words
