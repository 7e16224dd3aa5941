"""Closed polygons → the pixels inside them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray

_PIXELS_AT_ONCE = 2**22  # so that memory does not grow with the window


def pixels_inside(rings_yx: Sequence[FloatArray], rows: slice, columns: slice) -> BoolArray:
    """Pixels of a window whose centres lie inside closed polygons, by the even-odd rule.

    A ring within a ring is a hole. Of pixels whose centre lies on a side, those to the right of it (or below
    a horizontal one) count as inside, so that polygons that share a side share no pixel.

    Parameters
    ----------
    rings_yx : sequence of ndarray of shape (N, 2) and dtype float
        Closed polygons, (row, column) in pixels, pixel centres at integers. The last point may be repeated.
    rows, columns : slice
        Of the window, with start and stop.

    Returns
    -------
    ndarray of shape (rows, columns) and dtype bool

    Notes
    -----
    In each row, every side that crosses it turns all pixels to its right from outside to inside or back.
    """
    height, width = rows.stop - rows.start, columns.stop - columns.start
    if height * width > _PIXELS_AT_ONCE and height > 1:
        step = max(1, _PIXELS_AT_ONCE // width)
        strips = [slice(top, min(top + step, rows.stop)) for top in range(rows.start, rows.stop, step)]
        return np.concatenate([pixels_inside(rings_yx, strip, columns) for strip in strips])
    begins = np.concatenate(list(rings_yx))
    ends = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings_yx])
    down = (begins[:, 0] <= ends[:, 0])[:, None]
    (y0, x0), (y1, x1) = np.where(down, begins, ends).T, np.where(down, ends, begins).T
    first = np.clip(np.ceil(y0), rows.start, rows.stop).astype(np.int64)
    crossed = np.clip(np.ceil(y1), rows.start, rows.stop).astype(np.int64) - first
    side = np.repeat(np.arange(len(first)), crossed)
    row = np.arange(len(side)) - np.repeat(np.cumsum(crossed) - crossed, crossed) + first[side]
    x = x0[side] + (row - y0[side]) * ((x1[side] - x0[side]) / (y1[side] - y0[side]))
    column = np.clip(np.ceil(x), columns.start, columns.stop).astype(np.int64) - columns.start
    turns = np.bincount((row - rows.start) * (width + 1) + column, minlength=height * (width + 1))
    inside: BoolArray = np.cumsum(turns.reshape(height, width + 1), axis=1)[:, :width] % 2 == 1
    return inside
