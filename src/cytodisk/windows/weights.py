"""Shares of pixels in the polar windows of a cell, none of which is left empty."""

import numpy as np
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray, Int32Array, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.polar_layout import PolarLayout
from cytodisk.windows.raster import windows_of_all_subpixels
from cytodisk.windows.shares import PER_SIDE, PIXELS_AT_ONCE, Subpixels, WindowShares, gather_shares
from cytodisk.windows.subpixels import subpixel_places

_FINE = 16  # subpixels along a pixel's side


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
    pixels = disk.placed_mask.pixels_yx
    if disk.method == "advection":
        coarse: IntArray | Int32Array = windows_of_subpixels(grid, disk, pixels, PER_SIDE)
    else:
        coarse = windows_of_all_subpixels(grid, disk, pixels, PER_SIDE)
    whole = [Subpixels(np.arange(len(pixels)), coarse, np.full(len(pixels), 1.0 / PER_SIDE**2))]
    shares = gather_shares(pixels, grid.n_windows, whole)
    present = np.repeat(grid.present, grid.sectors)
    empty = np.flatnonzero((np.diff(shares.weights.indptr) == 0) & present)
    if not empty.size:
        return shares
    near = np.unique(_pixels_at(disk, pixels, grid.centres_uv[empty]))
    kept = np.delete(np.arange(len(pixels)), near)
    coarse = coarse[kept]
    fine = windows_of_subpixels(grid, disk, pixels[near], _FINE)
    empty = np.flatnonzero((_held(grid, coarse) + _held(grid, fine) == 0) & present)
    extra = _pixels_at(disk, pixels, grid.centres_uv[empty])
    counts = np.full(len(pixels), PER_SIDE**2)
    counts[near] = _FINE**2
    counts += np.bincount(extra, minlength=len(pixels))
    sizes = (kept, coarse), (near, fine), (extra, empty[:, None])
    subpixels = [Subpixels(pixel, window, 1.0 / counts[pixel]) for pixel, window in sizes]
    return gather_shares(pixels, grid.n_windows, subpixels)


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


def _held(grid: PolarLayout, window: IntArray | Int32Array) -> IntArray:
    """Number of subpixels in each window."""
    return np.bincount(window.ravel(), minlength=grid.n_windows)


def _pixels_at(disk: DiskMap, pixels: IntArray, points_uv: FloatArray) -> IntArray:
    """Mask pixel nearest to the place of each disk point in the cell."""
    if not len(points_uv):
        return np.empty(0, dtype=np.int64)
    _, nearest = cKDTree(pixels).query(disk.to_cell(points_uv))
    return np.asarray(nearest, dtype=np.int64)
