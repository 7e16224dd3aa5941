"""Sign of a triangle's area, exact: floating point where it is sure, rational arithmetic where not."""

from fractions import Fraction

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray

# Shewchuk 1997, doi:10.1007/PL00009321: bound of the rounding error of the plain determinant.
_ERROR_BOUND = (3.0 + 16.0 * 2.0**-53) * 2.0**-53
_UNDERFLOW = 2.0**-1000  # below it products lose digits, which that bound leaves out
_DOUBT = 2


def orientations(points: FloatArray, triangles: IntArray) -> tuple[IntArray, int]:
    """Orientation of each triangle, decided exactly.

    Parameters
    ----------
    points : ndarray of shape (V, 2) and dtype float
        (row, column), or (v, u): the sign is positive from the second axis towards the first.
    triangles : ndarray of shape (F, 3) and dtype int

    Returns
    -------
    sign : ndarray of shape (F,) and dtype int
        1, 0 or -1; 0 also where a coordinate is not finite.
    n_exact : int
        How many were in doubt in floating point and decided with rational numbers.

    References
    ----------
    Shewchuk, "Adaptive precision floating-point arithmetic", 1997, doi:10.1007/PL00009321
    """
    points, triangles = np.ascontiguousarray(points), np.ascontiguousarray(triangles)
    sign = _signs(points, triangles)
    in_doubt = np.flatnonzero(sign == _DOUBT)
    for t in in_doubt:
        sign[t] = _exact_sign(points[triangles[t]])
    return sign, len(in_doubt)


@njit(cache=True)
def _signs(points: FloatArray, triangles: IntArray) -> IntArray:
    """Sign of each area, 0 if it is not finite, `_DOUBT` where rounding errors may decide it."""
    sign = np.zeros(len(triangles), dtype=np.int64)
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        left = (points[a, 1] - points[c, 1]) * (points[b, 0] - points[c, 0])
        right = (points[a, 0] - points[c, 0]) * (points[b, 1] - points[c, 1])
        determinant = left - right
        if abs(determinant) > _ERROR_BOUND * (abs(left) + abs(right)) + _UNDERFLOW:
            sign[t] = 1 if determinant > 0.0 else -1
        elif np.isfinite(points[a]).all() and np.isfinite(points[b]).all() and np.isfinite(points[c]).all():
            sign[t] = _DOUBT
    return sign


def _exact_sign(corners: FloatArray) -> int:
    (ay, ax), (by, bx), (cy, cx) = ((Fraction(float(y)), Fraction(float(x))) for y, x in corners)
    determinant = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (determinant > 0) - (determinant < 0)
