"""Symmetric systems with two unknowns, u and v, at each interior vertex of a mesh.

The matrix has a 2×2 block for each vertex and each edge between two of them. Where the blocks of its factor
lie is found once for a mesh; a factorisation then only computes, and u and v of a vertex go together, which
takes half the time of a factorisation that knows of single numbers (`benchmarks/factorisation.py`).
"""

from __future__ import annotations

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.block_pattern import BlockPattern, FactorPattern
from cytodisk.geometry.mesh import Mesh


class BlockSystem:
    """A positive definite matrix of 2×2 blocks on the interior vertices of a mesh, and its LDLᵀ factors.

    Attributes
    ----------
    pattern : BlockPattern
    unknown, vertex, place, diagonal : ndarray
        Those of the pattern.
    blocks : ndarray of shape (P, 2, 2) and dtype float
        The matrix, to be filled: the upper triangle, and both halves of the blocks on the diagonal.
    """

    def __init__(self, mesh: Mesh):
        self.pattern = BlockPattern(mesh)
        self.unknown, self.vertex = self.pattern.unknown, self.pattern.vertex
        self.place, self.diagonal = self.pattern.place, self.pattern.diagonal
        self.blocks = np.empty((len(self.pattern.row), 2, 2))
        self._factor = np.empty((len(self.pattern.factor.below), 2, 2))
        self._inverse = np.empty((len(self.vertex), 2, 2))

    def factorise(self) -> None:
        """Compute the factors of `blocks`."""
        pattern = self.pattern
        _factorise(self.blocks, pattern.first, pattern.row, pattern.factor, self._factor, self._inverse)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution for one right-hand side, (N, 2), with the last factors."""
        start, below = self.pattern.factor.start, self.pattern.factor.below
        return np.asarray(_solve(start, below, self._factor, self._inverse, right))


@njit(cache=True, error_model="numpy")
def _factorise(
    blocks: FloatArray,
    first: IntArray,
    row: IntArray,
    pattern: FactorPattern,
    factor: FloatArray,
    inverse: FloatArray,
) -> None:
    """Fill the factor, row after row, and the inverses of its diagonal blocks."""
    start, below, row_start, left, where = pattern
    n = len(first) - 1
    work = np.zeros((n, 2, 2))  # column k of what is left of the matrix
    for k in range(n):
        for block in range(first[k], first[k + 1]):
            for p in range(2):
                for q in range(2):
                    work[row[block], p, q] = blocks[block, p, q]
        d00, d01, d11 = work[k, 0, 0], work[k, 0, 1], work[k, 1, 1]
        for entry in range(row_start[k], row_start[k + 1]):
            i, own = left[entry], where[entry]
            y00, y01, y10, y11 = work[i, 0, 0], work[i, 0, 1], work[i, 1, 0], work[i, 1, 1]
            for p in range(2):
                for q in range(2):
                    work[i, p, q] = 0.0
            for block in range(start[i], own):
                j = below[block]
                l00, l01, l10, l11 = (
                    factor[block, 0, 0],
                    factor[block, 0, 1],
                    factor[block, 1, 0],
                    factor[block, 1, 1],
                )
                work[j, 0, 0] -= l00 * y00 + l01 * y10
                work[j, 0, 1] -= l00 * y01 + l01 * y11
                work[j, 1, 0] -= l10 * y00 + l11 * y10
                work[j, 1, 1] -= l10 * y01 + l11 * y11
            v00, v01, v11 = inverse[i, 0, 0], inverse[i, 0, 1], inverse[i, 1, 1]
            l00, l01 = y00 * v00 + y10 * v01, y00 * v01 + y10 * v11
            l10, l11 = y01 * v00 + y11 * v01, y01 * v01 + y11 * v11
            factor[own, 0, 0], factor[own, 0, 1] = l00, l01
            factor[own, 1, 0], factor[own, 1, 1] = l10, l11
            d00 -= l00 * y00 + l01 * y10
            d01 -= l00 * y01 + l01 * y11
            d11 -= l10 * y01 + l11 * y11
        for p in range(2):
            for q in range(2):
                work[k, p, q] = 0.0
        det = d00 * d11 - d01 * d01
        inverse[k, 0, 0], inverse[k, 1, 1] = d11 / det, d00 / det
        inverse[k, 0, 1] = inverse[k, 1, 0] = -d01 / det


@njit(cache=True)
def _solve(
    start: IntArray, below: IntArray, factor: FloatArray, inverse: FloatArray, right: FloatArray
) -> FloatArray:
    out = right.copy()
    n = len(out)
    for i in range(n):
        x, y = out[i, 0], out[i, 1]
        for block in range(start[i], start[i + 1]):
            j = below[block]
            out[j, 0] -= factor[block, 0, 0] * x + factor[block, 0, 1] * y
            out[j, 1] -= factor[block, 1, 0] * x + factor[block, 1, 1] * y
    for i in range(n - 1, -1, -1):
        x = inverse[i, 0, 0] * out[i, 0] + inverse[i, 0, 1] * out[i, 1]
        y = inverse[i, 1, 0] * out[i, 0] + inverse[i, 1, 1] * out[i, 1]
        for block in range(start[i], start[i + 1]):
            j = below[block]
            x -= factor[block, 0, 0] * out[j, 0] + factor[block, 1, 0] * out[j, 1]
            y -= factor[block, 0, 1] * out[j, 0] + factor[block, 1, 1] * out[j, 1]
        out[i, 0], out[i, 1] = x, y
    return out
