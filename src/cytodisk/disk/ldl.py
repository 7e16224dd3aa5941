"""Sparse symmetric systems, and the order in which their unknowns are best eliminated."""

import numpy as np
import qdldl
from scipy import sparse

from cytodisk.arrays import FloatArray, IntArray


class Factorisation:
    """LDLᵀ of a symmetric matrix, by QDLDL.

    Parameters
    ----------
    upper : scipy.sparse.csc_matrix of shape (N, N)
        Upper triangle with the diagonal; positive definite.
    """

    def __init__(self, upper: sparse.csc_matrix):
        self._solver = qdldl.Solver(upper, upper=True)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution for one right-hand side of shape (N,)."""
        return np.asarray(self._solver.solve(right))

    @property
    def order(self) -> IntArray:
        """Unknowns in the order in which they were eliminated, shape (N,): approximate minimum degree."""
        return np.asarray(self._solver.factors()[2], dtype=np.int64)
