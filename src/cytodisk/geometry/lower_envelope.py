"""Nearest pixels outside a mask: by column, and the lower envelope of the distances to them in a row."""

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray


@njit(cache=True, error_model="numpy")
def outside_in_column(inside: BoolArray) -> IntArray:
    """Nearest row outside the mask in each pixel's column, in the shape of the mask; -1 if there is none.

    The margin is no part of the image.
    """
    height, width = inside.shape
    found = np.full(inside.shape, -1, dtype=np.int64)
    for row in range(1, height - 1):
        for column in range(1, width - 1):
            found[row, column] = found[row - 1, column] if inside[row, column] else row
    for row in range(height - 3, 0, -1):
        for column in range(1, width - 1):
            below, own = found[row + 1, column], found[row, column]
            if below >= 0 and (own < 0 or below - row < row - own):
                found[row, column] = below
    return found


@njit(cache=True, error_model="numpy")
def lower_envelope(
    row: int, outside: IntArray, columns: tuple[int, int], lowest: IntArray, begin: FloatArray
) -> int:
    """Lower envelope of the squared distances from a row to the pixels outside, by column: see `depth_of`.

    Columns are the first and the last that count: for a stretch of pixels inside the ones beside it, for
    what lies beyond them is further from all of the stretch.
    """
    count = 0
    for column in range(columns[0], columns[1] + 1):
        if outside[column] < 0:
            continue
        height = float(outside[column] - row) ** 2
        meet = -np.inf
        while count > 0:
            last = lowest[count - 1]
            rise = height - float(outside[last] - row) ** 2
            meet = 0.5 * (rise / (column - last) + column + last)
            if meet > begin[count - 1]:
                break
            count -= 1
            meet = -np.inf
        lowest[count], begin[count] = column, meet
        count += 1
    return count
