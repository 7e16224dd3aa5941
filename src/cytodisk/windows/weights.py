"""Shares of pixels in the polar windows of a cell, none of which is left empty."""

import numpy as np
from scipy.spatial import cKDTree

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.nucleus.compartment_rule import compartment_windows, is_nuclear, nuclear_box
from cytodisk.windows.nucleus.nucleus_raster import paint_nucleus_windows
from cytodisk.windows.pixel_shares.hole_pixels import hole_pixels, pixels_beside, without_pixels
from cytodisk.windows.pixel_shares.raster import paint_windows
from cytodisk.windows.pixel_shares.shares import (
    FINE,
    PER_SIDE,
    PIXELS_AT_ONCE,
    Subpixels,
    WindowShares,
    gather_shares,
    subpixels_by_strips,
)
from cytodisk.windows.pixel_shares.subpixels import subpixel_places
from cytodisk.windows.polar_layout import PolarLayout


def window_shares(grid: PolarLayout, disk: DiskMap) -> WindowShares:
    """Weights of a cell's pixels in its windows, and moments of the windows.

    Every pixel is divided into 4×4 subpixels. Each goes whole to the window it maps into; one outside the
    outline goes with the nearest outline point. Pixels at windows without a subpixel are divided into 16×16.
    A window that is still empty gets one more subpixel of the pixel at its centre, which counts as a square
    of the whole pixel's width in the moments. Pixels of excluded holes belong to no window; those of a
    nucleus belong to its windows, whole and alone.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap

    Returns
    -------
    WindowShares
        Columns of the weights sum to 1, those of excluded holes to 0. No row is empty but those of layers
        deeper than the cell and of windows that lie wholly in holes.
    """
    placed, left_out = disk.placed_mask, hole_pixels(disk.placed_mask, disk.holes)
    painted = _painted(grid, disk)
    if left_out is None:
        shares = gather_shares(placed, grid.n_windows, painted)
    else:
        shares = gather_shares(placed, grid.n_windows, *without_pixels(painted, left_out, grid.n_windows))
    empty = _empty(grid, shares)
    if not empty.size:
        return shares
    subpixels, in_holes = shares.subpixels, shares.hole_areas
    pixel, place = _pixels_at(grid, disk, empty)
    near, first = np.unique(pixel, return_index=True)
    fine = windows_of_subpixels(grid, disk, place[first], FINE).astype(np.int32)
    divided = dict(zip(near.tolist(), fine, strict=True))
    if left_out is not None:
        divided = {number: own for number, own in divided.items() if not left_out[number]}
        beside = pixels_beside(painted, placed, left_out, empty, near[left_out[near]])
        divided |= _reaching_out(grid, disk, beside, empty)
    shares = gather_shares(placed, grid.n_windows, subpixels.with_divided(divided), in_holes)
    empty = _empty(grid, shares)
    if not empty.size:
        return shares
    pixel, _ = _pixels_at(grid, disk, empty)
    for number, window in zip(pixel.tolist(), empty, strict=True):
        if left_out is not None and left_out[number]:
            continue  # it lies wholly in a hole
        own = divided[number] if number in divided else subpixels.of_pixel(number)
        divided[number] = np.append(own, np.int32(window))
    return gather_shares(placed, grid.n_windows, subpixels.with_divided(divided), in_holes)


def _reaching_out(
    grid: PolarLayout, disk: DiskMap, beside: IntArray, empty: IntArray
) -> dict[int, Int32Array]:
    """Subpixels of pixels beside holes that some windows reach into, by less than a 4×4 subpixel."""
    places = disk.placed_mask.pixels_yx[beside]
    fine = windows_of_subpixels(grid, disk, places, FINE).astype(np.int32)
    reached = np.isin(fine, empty).any(axis=1)
    return dict(zip(beside[reached].tolist(), fine[reached], strict=True))


def _painted(grid: PolarLayout, disk: DiskMap) -> Subpixels:
    """Windows of the subpixels of the filled mask."""
    if disk.nucleus is not None:
        return paint_nucleus_windows(grid, disk)
    if disk.method != "advection":
        return paint_windows(grid, disk)
    return subpixels_by_strips(
        disk.placed_mask, lambda pixels: windows_of_subpixels(grid, disk, pixels, PER_SIDE)
    )


def _empty(grid: PolarLayout, shares: WindowShares) -> IntArray:
    """Numbers of windows without any pixel, but for those of layers deeper than the cell."""
    present = np.repeat(grid.present, grid.sectors)
    return np.flatnonzero((np.diff(shares.weights.indptr) == 0) & present)


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
        if disk.nucleus is None:
            found = grid.window_of(disk.to_disk(points, outside="nearest"))
        else:
            nuclear = np.repeat(is_nuclear(disk, pixels_yx[block]), per_side**2)
            found = compartment_windows(grid, disk, points, nuclear)
        window[block] = found.reshape(-1, per_side**2)
    return window


def _pixels_at(grid: PolarLayout, disk: DiskMap, windows: IntArray) -> tuple[IntArray, IntArray]:
    """Number and place of the mask pixel nearest to the middle of each window, of its own compartment."""
    points_yx = disk.to_cell(grid.centres_uv[windows]) - disk.placed_mask.corner
    if disk.nucleus is None:
        nearest = _nearest_pixels(disk.placed_mask.box, points_yx)
    else:
        nuclear, nearest = nuclear_box(disk), np.empty((len(windows), 2), dtype=np.int64)
        of_nucleus = windows >= grid.cytoplasm_layers * grid.sectors
        nearest[of_nucleus] = _nearest_pixels(nuclear, points_yx[of_nucleus])
        nearest[~of_nucleus] = _nearest_pixels(disk.placed_mask.box & ~nuclear, points_yx[~of_nucleus])
    numbers = np.flatnonzero(disk.placed_mask.box)
    width = disk.placed_mask.box.shape[1]
    return np.searchsorted(numbers, nearest @ (width, 1)), nearest + disk.placed_mask.corner


def _nearest_pixels(box: BoolArray, points_yx: FloatArray) -> IntArray:
    """Pixel of a mask that is nearest to each place in its box, (row, column)."""
    height, width = box.shape
    nearest = np.clip(np.rint(points_yx).astype(np.int64), 0, (height - 1, width - 1))
    beside = ~box[tuple(nearest.T)]
    if beside.any():
        pixels = np.argwhere(box)
        nearest[beside] = pixels[cKDTree(pixels).query(points_yx[beside])[1]]
    return np.asarray(nearest)
