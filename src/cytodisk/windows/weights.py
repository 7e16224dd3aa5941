"""How much of each pixel belongs to each window: one sparse matrix."""

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.grid import PolarWindows

_COARSE, _FINE = 4, 16  # parts along a pixel's side
_PIXELS_AT_ONCE = 1024  # whose parts stay in the cache


def window_weights(grid: PolarWindows, disk: DiskMap) -> sparse.csr_array:
    """Weights of a cell's pixels in its windows.

    Every pixel is divided into 4×4 parts, and each part goes whole to the window it maps into; a part
    outside the outline goes with the nearest outline point. Pixels at windows that got no part are divided
    into 16×16. A window that is still empty gets one more part of the pixel at its centre.

    Parameters
    ----------
    grid : PolarWindows
    disk : DiskMap

    Returns
    -------
    csr_array of shape (windows, pixels)
        Pixels of `disk.mask` in row-major order. Columns sum to 1, rows to the window's area in square
        pixels, and no row is empty.
    """
    pixels = np.argwhere(disk.mask)
    pixel, window = _parts(grid, disk, pixels, np.arange(len(pixels)), _COARSE)
    empty = _empty(grid, window)
    if empty.size:
        near = np.unique(_pixels_at(disk, pixels, grid.centres_uv[empty]))
        kept = ~np.isin(pixel, near)
        fine_pixel, fine_window = _parts(grid, disk, pixels, near, _FINE)
        pixel = np.concatenate([pixel[kept], fine_pixel])
        window = np.concatenate([window[kept], fine_window])
        empty = _empty(grid, window)
        pixel = np.concatenate([pixel, _pixels_at(disk, pixels, grid.centres_uv[empty])])
        window = np.concatenate([window, empty])
    share = 1.0 / np.bincount(pixel, minlength=len(pixels))
    return sparse.csr_array(
        sparse.coo_array((share[pixel], (window, pixel)), shape=(grid.n_windows, len(pixels)))
    )


def _parts(
    grid: PolarWindows, disk: DiskMap, pixels: IntArray, chosen: IntArray, per_side: int
) -> tuple[IntArray, IntArray]:
    """Pixel and window of each part of the chosen pixels."""
    steps = (np.arange(per_side) + 0.5) / per_side - 0.5
    offsets = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    window = np.empty(len(chosen) * per_side**2, dtype=np.int64)
    for first in range(0, len(chosen), _PIXELS_AT_ONCE):
        block = chosen[first : first + _PIXELS_AT_ONCE]
        points = (pixels[block, None, :] + offsets).reshape(-1, 2)
        start = first * per_side**2
        uv = disk.to_disk(points, outside="nearest")
        window[start : start + len(points)] = grid.window_of(uv)
    return np.repeat(chosen, per_side**2), window


def _empty(grid: PolarWindows, window: IntArray) -> IntArray:
    return np.flatnonzero(np.bincount(window, minlength=grid.n_windows) == 0)


def _pixels_at(disk: DiskMap, pixels: IntArray, points_uv: FloatArray) -> IntArray:
    """Mask pixel nearest to the place of each disk point in the cell."""
    if not len(points_uv):
        return np.empty(0, dtype=np.int64)
    _, nearest = cKDTree(pixels).query(disk.to_cell(points_uv))
    return np.asarray(nearest, dtype=np.int64)
