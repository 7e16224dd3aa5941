"""Depth of pixels below the edge of a mask."""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray


@njit(cache=True)
def depth_of(mask: BoolArray) -> FloatArray:
    """Distance of each pixel's centre to the nearest pixel outside, 0 outside; `mask` has a border of these.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool
        No pixel of its first and last row and column is set.

    Returns
    -------
    ndarray of shape (H, W) and dtype float
        In pixels, exact: first along columns, then the lower envelope of parabolas along rows.

    References
    ----------
    Felzenszwalb and Huttenlocher, "Distance transforms of sampled functions", 2012,
    doi:10.4086/toc.2012.v008a019
    """
    height, width = mask.shape
    square = np.zeros((height, width))
    for row in range(1, height):
        for column in range(width):
            square[row, column] = square[row - 1, column] + 1.0 if mask[row, column] else 0.0
    for row in range(height - 2, -1, -1):
        for column in range(width):
            square[row, column] = min(square[row, column], square[row + 1, column] + 1.0)
    depth = np.zeros((height, width))
    lowest = np.empty(width, dtype=np.int64)  # columns whose parabolas make up the envelope
    begin = np.empty(width + 1)  # and where each of them begins
    height_of = np.empty(width)
    for row in range(height):
        for column in range(width):
            height_of[column] = square[row, column] ** 2
        count = 0
        for column in range(width):
            meet = -np.inf
            while count > 0:
                last = lowest[count - 1]
                rise = height_of[column] - height_of[last]
                meet = 0.5 * (rise / (column - last) + column + last)
                if meet > begin[count - 1]:
                    break
                count -= 1
                meet = -np.inf
            lowest[count], begin[count] = column, meet
            count += 1
        begin[count] = np.inf
        place = 0
        for column in range(width):
            while begin[place + 1] < column:
                place += 1
            if mask[row, column]:
                depth[row, column] = math.sqrt(height_of[lowest[place]] + (column - lowest[place]) ** 2)
    return depth
