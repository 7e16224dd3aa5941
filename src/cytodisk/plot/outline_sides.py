"""Outlines of regions of an image along the sides of its pixels."""

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray


def outline_sides(region: BoolArray) -> FloatArray:
    """Sides of pixels at which a region ends, the border of the image included.

    Parameters
    ----------
    region : ndarray of shape (H, W) and dtype bool

    Returns
    -------
    ndarray of shape (N, 2, 2) and dtype float
        Both ends of each side as (x, y), the image's corner at 0.
    """
    framed = np.pad(region, 1)
    rows, columns = np.nonzero(framed[1:, 1:-1] != framed[:-1, 1:-1])
    level = np.stack([np.stack([columns, rows], 1), np.stack([columns + 1, rows], 1)], 1)
    rows, columns = np.nonzero(framed[1:-1, 1:] != framed[1:-1, :-1])
    upright = np.stack([np.stack([columns, rows], 1), np.stack([columns, rows + 1], 1)], 1)
    return np.concatenate([level, upright]).astype(np.float64)
