"""Division that says where there is nothing to divide by."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray


def ratio(
    above: FloatArray | float, below: FloatArray, where: BoolArray, otherwise: float = np.nan
) -> FloatArray:
    """above / below where that has a meaning, `otherwise` elsewhere.

    Parameters
    ----------
    above : ndarray or float
    below : ndarray
    where : ndarray of bool
        Of the shape of below.
    otherwise : float

    Returns
    -------
    ndarray of float64
    """
    nothing = np.full(np.shape(below), otherwise)
    found: FloatArray = np.divide(above, below, out=nothing, where=where)
    return found
