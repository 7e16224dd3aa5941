"""Triangles that may overlap → which is drawn first over each subpixel, and where several are."""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray


def paint_triangles(
    triangles: FloatArray, windows: IntArray, shape: tuple[int, int]
) -> tuple[IntArray, BoolArray]:
    """Window of the first triangle that holds each point of a grid, and where another window has it, too.

    A side that two triangles share belongs to one of them, so neighbours that do not overlap never count as
    such.

    Parameters
    ----------
    triangles : ndarray of shape (T, 3, 2) and dtype float
        Corners, (row, column) of the grid; either way around.
    windows : ndarray of shape (T,) and dtype int
    shape : (int, int)
        Of the grid.

    Returns
    -------
    window : ndarray of shape (H, W) and dtype int
        -1 where there is none.
    overlap : ndarray of shape (H, W) and dtype bool
    """
    return _paint(np.ascontiguousarray(triangles), windows, shape)


@njit(cache=True)
def _paint(triangles: FloatArray, windows: IntArray, shape: tuple[int, int]) -> tuple[IntArray, BoolArray]:
    window, overlap = np.full(shape, -1, dtype=np.int64), np.zeros(shape, dtype=np.bool_)
    for number in range(len(triangles)):
        a, b, c = triangles[number]
        if _side(c[0], c[1], a, b) < 0.0:
            b, c = c, b
        top = max(math.ceil(min(a[0], b[0], c[0])), 0)
        bottom = min(math.floor(max(a[0], b[0], c[0])), shape[0] - 1)
        left = max(math.ceil(min(a[1], b[1], c[1])), 0)
        right = min(math.floor(max(a[1], b[1], c[1])), shape[1] - 1)
        for row in range(top, bottom + 1):
            for column in range(left, right + 1):
                y, x = float(row), float(column)
                if not (_holds(y, x, a, b) and _holds(y, x, b, c) and _holds(y, x, c, a)):
                    continue
                if window[row, column] < 0:
                    window[row, column] = windows[number]
                elif window[row, column] != windows[number]:
                    overlap[row, column] = True
    return window, overlap


@njit(cache=True)
def _side(y: float, x: float, start: FloatArray, end: FloatArray) -> float:
    """Above 0 on the left of an edge; the very opposite for the edge backwards, to the last digit."""
    if end[0] < start[0] or (end[0] == start[0] and end[1] < start[1]):
        return -_side_forwards(y, x, end, start)
    return _side_forwards(y, x, start, end)


@njit(cache=True)
def _side_forwards(y: float, x: float, start: FloatArray, end: FloatArray) -> float:
    return float((end[1] - start[1]) * (y - start[0]) - (end[0] - start[0]) * (x - start[1]))


@njit(cache=True)
def _holds(y: float, x: float, start: FloatArray, end: FloatArray) -> bool:
    """Whether a point is on the inner side of an edge; on the edge itself in one of its two directions."""
    side = _side(y, x, start, end)
    if side != 0.0:
        return side > 0.0
    return bool(end[0] > start[0] or (end[0] == start[0] and end[1] > start[1]))
