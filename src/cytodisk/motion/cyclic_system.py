"""Linear systems that couple each point of a closed curve to its two neighbours."""

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray


@njit(cache=True)
def solve_cyclic(diagonal: FloatArray, coupling: FloatArray, right: FloatArray) -> FloatArray:
    """Solve a symmetric positive definite cyclic tridiagonal system (Sherman-Morrison).

    Parameters
    ----------
    diagonal : ndarray of shape (N,) and dtype float
        N at least 3.
    coupling : ndarray of shape (N,) and dtype float
        Entry i couples the unknowns i and i + 1; the last one couples the last to the first.
    right : ndarray of shape (N, K) and dtype float
        Right-hand sides.

    Returns
    -------
    ndarray of shape (N, K) and dtype float
    """
    n, k = right.shape
    corner = -diagonal[0]
    x = np.empty((n, k + 1))
    for i in range(n):
        for a in range(k):
            x[i, a] = right[i, a]
        x[i, k] = 0.0
    x[0, k], x[n - 1, k] = corner, coupling[n - 1]
    ratio = np.empty(n)
    one_over = 1.0 / (diagonal[0] - corner)
    for a in range(k + 1):
        x[0, a] *= one_over
    for i in range(1, n):
        ratio[i] = coupling[i - 1] * one_over
        last = coupling[n - 1] ** 2 / corner if i == n - 1 else 0.0
        one_over = 1.0 / (diagonal[i] - last - coupling[i - 1] * ratio[i])
        for a in range(k + 1):
            x[i, a] = (x[i, a] - coupling[i - 1] * x[i - 1, a]) * one_over
    for i in range(n - 2, -1, -1):
        for a in range(k + 1):
            x[i, a] -= ratio[i + 1] * x[i + 1, a]
    end = coupling[n - 1] / corner
    solved = np.empty((n, k))
    for a in range(k):
        factor = (x[0, a] + end * x[n - 1, a]) / (1.0 + x[0, k] + end * x[n - 1, k])
        for i in range(n):
            solved[i, a] = x[i, a] - x[i, k] * factor
    return solved
