"""Division and means that say where there is nothing to divide by."""

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


def known_mean(
    values: FloatArray, axis: int | tuple[int, ...], weights: FloatArray | None = None
) -> FloatArray:
    """Mean of the values that there are.

    Parameters
    ----------
    values : ndarray of dtype float64
        NaN where there is none.
    axis : int or tuple of int
    weights : ndarray, optional
        Of a shape that values can be multiplied with; by default all are equal.

    Returns
    -------
    ndarray of dtype float64
        NaN where there is no value, or none with a weight.

    Examples
    --------
    >>> import numpy as np
    >>> from cytodisk.population.ratios import known_mean
    >>> known_mean(np.array([[1.0, np.nan, 3.0], [np.nan, np.nan, np.nan]]), 1).tolist()
    [2.0, nan]
    """
    known = np.isfinite(values)
    weight = known.astype(np.float64) if weights is None else np.where(known, weights, 0.0)
    total = weight.sum(axis=axis)
    summed = (np.where(known, values, 0.0) * weight).sum(axis=axis)
    return ratio(summed, total, total > 0)
