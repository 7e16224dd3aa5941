"""Shares of pixels in the polar windows of a cell, none of which is left empty."""

import numpy as np
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.polar_layout import PolarLayout
from cytodisk.windows.raster import paint_windows
from cytodisk.windows.shares import (
    FINE,
    PER_SIDE,
    PIXELS_AT_ONCE,
    WindowShares,
    gather_shares,
    shares_by_strips,
)
from cytodisk.windows.subpixels import subpixel_places


def window_shares(grid: PolarLayout, disk: DiskMap) -> WindowShares:
    """Weights of a cell's pixels in its windows, and moments of the windows.

    Every pixel is divided into 4×4 subpixels. Each goes whole to the window it maps into; one outside the
    outline goes with the nearest outline point. Pixels at windows without a subpixel are divided into 16×16.
    A window that is still empty gets one more subpixel of the pixel at its centre, which counts as a square
    of the whole pixel's width in the moments.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap

    Returns
    -------
    WindowShares
        Columns of the weights sum to 1, and no row is empty but those of layers deeper than the cell.
    """
    if disk.method == "advection":
        shares = shares_by_strips(
            disk.placed_mask,
            grid.n_windows,
            lambda pixels: windows_of_subpixels(grid, disk, pixels, PER_SIDE),
        )
    else:
        shares = gather_shares(disk.placed_mask, grid.n_windows, paint_windows(grid, disk))
    present = np.repeat(grid.present, grid.sectors)
    empty = np.flatnonzero((np.diff(shares.weights.indptr) == 0) & present)
    if not empty.size:
        return shares
    subpixels = shares.subpixels
    pixel, place = _pixels_at(disk, grid.centres_uv[empty])
    near, first = np.unique(pixel, return_index=True)
    fine = windows_of_subpixels(grid, disk, place[first], FINE).astype(np.int32)
    divided = dict(zip(near.tolist(), fine, strict=True))
    shares = gather_shares(disk.placed_mask, grid.n_windows, subpixels.with_divided(divided))
    empty = np.flatnonzero((np.diff(shares.weights.indptr) == 0) & present)
    if not empty.size:
        return shares
    pixel, _ = _pixels_at(disk, grid.centres_uv[empty])
    for number, window in zip(pixel.tolist(), empty, strict=True):
        own = divided[number] if number in divided else subpixels.of_pixel(number)
        divided[number] = np.append(own, np.int32(window))
    return gather_shares(disk.placed_mask, grid.n_windows, subpixels.with_divided(divided))


def windows_of_subpixels(grid: PolarLayout, disk: DiskMap, pixels_yx: IntArray, per_side: int) -> IntArray:
    """Window that each subpixel of some pixels maps into.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column).
    per_side : int
        Subpixels along a pixel's side.

    Returns
    -------
    ndarray of shape (P, subpixels) and dtype int
    """
    window = np.empty((len(pixels_yx), per_side**2), dtype=np.int64)
    for first in range(0, len(pixels_yx), PIXELS_AT_ONCE):
        block = slice(first, first + PIXELS_AT_ONCE)
        points = subpixel_places(pixels_yx[block], per_side).reshape(-1, 2)
        window[block] = grid.window_of(disk.to_disk(points, outside="nearest")).reshape(-1, per_side**2)
    return window


def _pixels_at(disk: DiskMap, points_uv: FloatArray) -> tuple[IntArray, IntArray]:
    """Number and place of the mask pixel nearest to where each disk point is in the cell."""
    placed = disk.placed_mask
    height, width = placed.box.shape
    numbers = np.flatnonzero(placed.box)
    points_yx = disk.to_cell(points_uv) - placed.corner
    nearest = np.clip(np.rint(points_yx).astype(np.int64), 0, (height - 1, width - 1))
    beside = ~placed.box[tuple(nearest.T)]
    if beside.any():
        pixels = np.column_stack(np.divmod(numbers, width))
        nearest[beside] = pixels[cKDTree(pixels).query(points_yx[beside])[1]]
    return np.searchsorted(numbers, nearest @ (width, 1)), nearest + placed.corner
