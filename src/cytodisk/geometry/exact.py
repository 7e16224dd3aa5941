"""Sign of a triangle's area, exact: floating point where it is sure, rational arithmetic where not."""

from fractions import Fraction

import numpy as np

from cytodisk.arrays import FloatArray, IntArray

# Shewchuk 1997, doi:10.1007/PL00009321: bound of the rounding error of the plain determinant.
_ERROR_BOUND = (3.0 + 16.0 * 2.0**-53) * 2.0**-53
_UNDERFLOW = 2.0**-1000  # below it products lose digits, which that bound leaves out


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
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    finite = np.isfinite(np.concatenate([a, b, c], axis=1)).all(axis=1)
    with np.errstate(invalid="ignore", over="ignore"):
        left = (a[:, 1] - c[:, 1]) * (b[:, 0] - c[:, 0])
        right = (a[:, 0] - c[:, 0]) * (b[:, 1] - c[:, 1])
        determinant = left - right
        surely = np.abs(determinant) > _ERROR_BOUND * (np.abs(left) + np.abs(right)) + _UNDERFLOW
    sign = np.where(finite & surely, np.sign(determinant), 0.0).astype(np.int64)
    in_doubt = finite & ~surely
    for t in np.flatnonzero(in_doubt):
        sign[t] = _exact_sign(points[triangles[t]])
    return sign, int(in_doubt.sum())


def _exact_sign(corners: FloatArray) -> int:
    (ay, ax), (by, bx), (cy, cx) = ((Fraction(float(y)), Fraction(float(x))) for y, x in corners)
    determinant = (ax - cx) * (by - cy) - (ay - cy) * (bx - cx)
    return (determinant > 0) - (determinant < 0)
