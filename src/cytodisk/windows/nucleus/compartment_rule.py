"""Which compartment subpixels belong to: a pixel of the nucleus has all of its own in layers of the nucleus.

The nuclear outline cuts pixels on both sides of it. What it cuts off counts at the nearest place on the
outline, on the pixel's own side. So the windows of each compartment hold its pixels, whole and alone.
"""

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.windows.polar_layout import PolarLayout

TURN = 2.0 * np.pi


def nucleus_of(disk: DiskMap) -> Nucleus:
    """The nucleus of a map that has one."""
    assert disk.nucleus is not None
    return disk.nucleus


def is_nuclear(disk: DiskMap, pixels_yx: IntArray) -> BoolArray:
    """Whether pixels of the image, (row, column) of shape (P, 2), belong to the nucleus, shape (P,)."""
    placed = nucleus_of(disk).placed_mask
    at = pixels_yx - np.array(placed.corner)
    inside = ((at >= 0) & (at < placed.box.shape)).all(axis=1)
    inside[inside] = placed.box[tuple(at[inside].T)]
    return np.asarray(inside)


def nuclear_box(disk: DiskMap) -> BoolArray:
    """The mask of the nucleus in the box of the cell's."""
    cell, nucleus = disk.placed_mask, nucleus_of(disk).placed_mask
    box = np.zeros(cell.box.shape, dtype=bool)
    (y, x), (top, left), (height, width) = nucleus.corner, cell.corner, nucleus.box.shape
    box[y - top : y - top + height, x - left : x - left + width] = nucleus.box
    return box


def compartment_windows(
    grid: PolarLayout, disk: DiskMap, points_yx: FloatArray, nuclear: BoolArray
) -> IntArray:
    """Number of the window that holds each of some points.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap
    points_yx : ndarray of shape (N, 2) and dtype float
        (row, column) in pixels; one outside the cell goes with the nearest place on its outline.
    nuclear : ndarray of shape (N,) and dtype bool
        Whether the pixel of each belongs to the nucleus.

    Returns
    -------
    ndarray of shape (N,) and dtype int
    """
    window = grid.window_of(disk.to_disk(points_yx, outside="nearest"))
    beyond = (window >= grid.cytoplasm_layers * grid.sectors) != nuclear
    window[beyond] = windows_at_border(grid, disk, points_yx[beyond], nuclear[beyond])
    return window


def windows_at_border(
    grid: PolarLayout, disk: DiskMap, points_yx: FloatArray, nuclear: BoolArray
) -> IntArray:
    """Number of the window at the place on the nuclear outline that is nearest to each point.

    Of the two on either side that one is meant which is in the nucleus, or not, as `nuclear` says.
    """
    if not len(points_yx):
        return np.zeros(0, dtype=np.int64)
    nucleus = nucleus_of(disk)
    angles = nucleus.boundary_angles
    side, fraction = nearest_on_outline(points_yx, disk.vertices_yx[nucleus.boundary])
    ends = np.append(angles, angles[0] + TURN)
    turn = (ends[side] + fraction * (ends[side + 1] - ends[side])) / TURN
    sector = np.minimum(np.floor(np.mod(turn, 1.0) * grid.sectors).astype(np.int64), grid.sectors - 1)
    innermost = np.flatnonzero(grid.present[: grid.cytoplasm_layers])[-1]
    return np.asarray(np.where(nuclear, grid.cytoplasm_layers, innermost) * grid.sectors + sector)
