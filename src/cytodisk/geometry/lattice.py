"""Interior points of a mesh: a triangular lattice, fine at the cell's edge and coarse inside."""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.depth import depth_of

_COARSEST = 16  # √3¹⁶ = 6561 times the finest spacing: beyond any image


def graded_lattice(
    mask: BoolArray,
    edge_length: float,
    growth: float,
    clearance: float = 0.75,
    around: BoolArray | None = None,
) -> FloatArray:
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
    clearance : float
        Smallest depth of a point, in units of `edge_length`.
    around : ndarray of shape (H, W) and dtype bool, optional
        A mask whose lattice this is a part of; by default the mask's own.

    Returns
    -------
    ndarray of shape (M, 2) and dtype float
        (row, column) in pixels; may be empty for thin cells.
    """
    depth = depth_of(np.pad(mask, 1)) - 0.5
    row, column = np.nonzero(mask if around is None else around)
    centre = np.array([row.mean(), column.mean()])
    axis = _long_axis(row - centre[0], column - centre[1])
    return _fill(depth, centre, axis, edge_length, growth, clearance)


def _long_axis(y: FloatArray, x: FloatArray) -> float:
    """Angle of the axis of largest spread, from +x towards +y, so that the lattice turns with the cell."""
    yy, xx, yx = (y**2).sum(), (x**2).sum(), (y * x).sum()
    return float(0.5 * np.arctan2(2.0 * yx, xx - yy))


@njit(cache=True)
def _level(i: int, j: int) -> int:
    """How often the lattice's number of norm 3 divides i + j·exp(πi/3): how many coarser lattices hold it."""
    level = 0
    while level < _COARSEST and (i - j) % 3 == 0:
        i, j = (2 * i + j) // 3, (j - i) // 3
        level += 1
    return level


@njit(cache=True)
def _within(start: float, slope: float, low: float, high: float) -> tuple[float, float]:
    """Range of t in which start + slope t lies between two bounds; none if the first is above the last."""
    if abs(slope) < 1e-12:
        return (-np.inf, np.inf) if low <= start <= high else (np.inf, -np.inf)
    one, other = (low - start) / slope, (high - start) / slope
    return min(one, other), max(one, other)


@njit(cache=True)
def _fill(
    depth: FloatArray, centre: FloatArray, angle: float, spacing: float, growth: float, clearance: float
) -> FloatArray:
    """Kept points of the lattice through `centre`; `depth` is padded by one pixel on each side."""
    height, width = depth.shape
    reach = math.hypot(height, width)
    last_row = int(reach / (math.sqrt(0.75) * spacing)) + 1
    cos, sin = math.cos(angle), math.sin(angle)
    finest = 3.0 ** (0.5 * np.arange(1, _COARSEST + 2))  # a level is too fine from here on
    deepest = (finest - 1.0) * spacing / growth if growth > 0.0 else np.full_like(finest, np.inf)
    points = np.empty((256, 2))
    count = 0
    for j in range(-last_row, last_row + 1):
        across = j * math.sqrt(0.75) * spacing
        first, last = _within(centre[0] + across * cos, sin, -1.0, height - 1.0)
        other_first, other_last = _within(centre[1] - across * sin, cos, -1.0, width - 1.0)
        first, last = max(first, other_first, -reach), min(last, other_last, reach)
        if first > last:
            continue
        shift = 0.5 * j - j // 2
        for k in range(math.floor(first / spacing - shift), math.ceil(last / spacing - shift) + 1):
            i = k - j // 2
            along = (i + 0.5 * j) * spacing
            y = centre[0] + along * sin + across * cos
            x = centre[1] + along * cos - across * sin
            row, column = math.floor(y) + 1, math.floor(x) + 1
            if row < 0 or column < 0 or row >= height - 1 or column >= width - 1:
                continue
            level = _level(i, j)
            if depth[row, column] - 1.5 > deepest[level]:  # so is the point: depth changes by 1 a pixel
                continue
            t, s = y + 1.0 - row, x + 1.0 - column
            upper = depth[row, column] * (1.0 - s) + depth[row, column + 1] * s
            lower = depth[row + 1, column] * (1.0 - s) + depth[row + 1, column + 1] * s
            here = upper * (1.0 - t) + lower * t
            if here < clearance * spacing:
                continue
            if 1.0 + growth * here / spacing >= finest[level]:
                continue
            if count == len(points):
                points = np.concatenate((points, np.empty_like(points)))
            points[count, 0], points[count, 1] = y, x
            count += 1
    return points[:count].copy()
