"""Division that says where there is nothing to divide by."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray


def ratio(above: FloatArray | float, below: FloatArray, where: BoolArray) -> FloatArray:
    """above / below where that has a meaning, NaN elsewhere.

    Parameters
    ----------
    above : ndarray or float
    below : ndarray
    where : ndarray of bool
        Of the shape of below.

    Returns
    -------
    ndarray of float64
    """
    nothing = np.full(np.shape(below), np.nan)
    found: FloatArray = np.divide(above, below, out=nothing, where=where)
    return found
