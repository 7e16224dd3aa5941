"""How large the windows in a cell are, in pixels."""

import numpy as np

from cytodisk.arrays import IntArray
from cytodisk.windows.polar_windows import CellWindows

FEW_PX = 10.0
"""Pixels of a window from which on its mean is worth something by itself."""


def window_sizes(windows: CellWindows) -> dict[str, float | int]:
    """Sizes of a cell's windows; layers deeper than the cell, and windows wholly in holes, do not count.

    Parameters
    ----------
    windows : CellWindows

    Returns
    -------
    dict
        window_area_error, see `CellWindows.area_error`; median_window_px and smallest_window_px, areas in
        square pixels; windows_below_10px and windows_below_1px, shares of the windows;
        windows_between_pixels, the number of windows that hold the centre of no pixel.
    """
    areas = windows.areas[windows.grid.present]
    if windows.holes is not None:
        areas = areas[areas > 0.0]
    with np.errstate(divide="ignore"):  # of an empty window it is infinite
        error = windows.area_error
    return {
        "window_area_error": error,
        "median_window_px": float(np.median(areas)),
        "smallest_window_px": float(areas.min()),
        "windows_below_10px": float((areas < FEW_PX).mean()),
        "windows_below_1px": float((areas < 1.0).mean()),
        "windows_between_pixels": len(between_pixels(windows)),
    }


def between_pixels(windows: CellWindows) -> IntArray:
    """Numbers of the windows that hold the centre of no pixel."""
    weights, grid = windows.weights, windows.grid
    window = np.repeat(np.arange(weights.shape[0]), np.diff(weights.indptr))
    known = np.zeros(weights.shape[0], dtype=bool)
    known[window[weights.data > 1.0 - 1e-9]] = True  # the whole pixel
    held = np.ones(len(known), dtype=bool) if windows.holes is None else np.diff(weights.indptr) > 0
    open_ = np.flatnonzero(~known & held & np.repeat(grid.present, grid.sectors))
    if not open_.size:
        return open_
    shared = np.zeros(weights.shape[1], dtype=bool)
    shared[weights.indices[~known[window]]] = True  # in an open window, or in layers deeper than the cell
    centres = windows.disk.placed_mask.pixels_yx[shared].astype(np.float64)
    known[grid.window_of(windows.disk.to_disk(centres, outside="nearest"))] = True
    return np.asarray(open_[~known[open_]])
