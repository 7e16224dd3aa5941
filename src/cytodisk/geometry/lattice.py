"""Interior points of a mesh: a triangular lattice, fine at the cell's edge and coarse inside."""

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray, IntArray

_CLEARANCE = 0.62  # smallest depth of an interior point, in units of the spacing at the edge
_COARSEST = 16  # √3¹⁶ = 6561 times the finest spacing: beyond any image


def graded_lattice(mask: BoolArray, edge_length: float, growth: float) -> FloatArray:
    """Points inside a mask whose spacing grows with depth.

    Every third point of a triangular lattice lies on a coarser one, √3 times as wide and turned by 30°,
    and so on. A point is kept if it lies on the lattice whose spacing suits its depth, so the bands
    fit into each other without slivers.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool
    edge_length : float
        Spacing at the edge, in pixels.
    growth : float
        How much the spacing grows for each pixel of depth.

    Returns
    -------
    ndarray of shape (M, 2) and dtype float
        (row, column) in pixels; may be empty for thin cells.
    """
    points, level = _lattice(mask, edge_length)
    depth_of_pixel = ndimage.distance_transform_edt(np.pad(mask, 1)) - 0.5
    depth = ndimage.map_coordinates(depth_of_pixel, points.T + 1, order=1, cval=-1.0)
    wanted = np.log1p(growth * np.maximum(depth, 0) / edge_length) / np.log(np.sqrt(3.0))
    return np.asarray(points[(level >= np.floor(wanted)) & (depth >= _CLEARANCE * edge_length)])


def _lattice(mask: BoolArray, spacing: float) -> tuple[FloatArray, IntArray]:
    """Triangular lattice over a mask and, for each point, how many coarser lattices hold it too.

    It is laid out from the centroid along the longer axis, so that it turns and moves with the cell.
    """
    pixels = np.argwhere(mask)
    centre = pixels.mean(axis=0)
    yy, yx, _, xx = np.cov((pixels - centre).T, bias=True).ravel() if len(pixels) > 1 else np.zeros(4)
    angle = 0.5 * np.arctan2(2.0 * yx, xx - yy)
    reach = np.hypot(*(np.array(mask.shape) + 1.0)) / spacing
    rows = np.arange(-int(reach / np.sqrt(0.75)) - 1, int(reach / np.sqrt(0.75)) + 2)
    columns = np.arange(-int(reach) - 1, int(reach) + 2)
    j, k = (grid.ravel() for grid in np.meshgrid(rows, columns, indexing="ij"))
    i = k - j // 2
    along, across = (i + 0.5 * j) * spacing, j * np.sqrt(0.75) * spacing
    y = centre[0] + along * np.sin(angle) + across * np.cos(angle)
    x = centre[1] + along * np.cos(angle) - across * np.sin(angle)
    inside = (y >= 0) & (x >= 0) & (y <= mask.shape[0] - 1) & (x <= mask.shape[1] - 1)
    return np.column_stack([y[inside], x[inside]]), _level(i[inside], j[inside])


def _level(i: IntArray, j: IntArray) -> IntArray:
    """How often i + j·exp(πi/3) can be divided by the lattice's number of norm 3."""
    level = np.zeros(i.shape, dtype=np.int64)
    rest = np.arange(i.size)
    for _ in range(_COARSEST):
        divisible = (i - j) % 3 == 0
        rest, i, j = rest[divisible], i[divisible], j[divisible]
        i, j = (2 * i + j) // 3, (j - i) // 3
        level[rest] += 1
    return level
