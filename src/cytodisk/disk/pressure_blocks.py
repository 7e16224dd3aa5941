"""Symmetric systems with three unknowns, u, v and a pressure, at each interior vertex of a mesh.

The matrix is quasi-definite: positive definite in the places, negative definite in the pressures. Every
order of elimination then has its LDLᵀ factors without pivoting (Vanderbei 1995), so that the pattern of the
2×2 blocks serves these 3×3 blocks, too.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.block_pattern import BlockPattern, FactorPattern
from cytodisk.disk.lanes import ROW, take_off_column


class PressureSystem:
    """A quasi-definite matrix of 3×3 blocks on the interior vertices of a mesh, and its LDLᵀ factors.

    Attributes
    ----------
    pattern : BlockPattern
    blocks : ndarray of shape (P, 3, 3) and dtype float
        The matrix, to be filled: the upper triangle, and of the blocks on the diagonal the upper half.

    References
    ----------
    Vanderbei, "Symmetric quasidefinite matrices", 1995, doi:10.1137/0805005
    """

    def __init__(self, pattern: BlockPattern):
        self.pattern = pattern
        self.blocks = np.empty((len(pattern.row), 3, 3))
        self._factor = np.empty((len(pattern.factor.below), 9))
        self._inverse = np.empty((len(pattern.vertex), 6))

    def factorise(self) -> None:
        """Compute the factors of `blocks`."""
        pattern = self.pattern
        _factorise(self.blocks, pattern.first, pattern.row, pattern.factor, self._factor, self._inverse)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution for one right-hand side, (N, 3), with the last factors."""
        start, below = self.pattern.factor.start, self.pattern.factor.below
        return np.asarray(_solve(start, below, self._factor, self._inverse, right))


@njit(cache=True, error_model="numpy", fastmath={"contract"})  # fused multiply and add: a sixth faster
def _factorise(
    blocks: FloatArray,
    first: IntArray,
    row: IntArray,
    pattern: FactorPattern,
    factor: FloatArray,
    inverse: FloatArray,
) -> None:
    """Fill the factor, row after row, and the upper halves of the inverses of its diagonal blocks.

    `factor` holds the nine numbers of a block in a row.
    """
    start, below, row_start, left, where = pattern
    n = len(first) - 1
    work = np.zeros((n, 3 * ROW))  # column k of what is left of the matrix
    for k in range(n):
        for block in range(first[k], first[k + 1]):
            i = row[block]
            for p in range(3):
                for q in range(3):
                    work[i, ROW * p + q] = blocks[block, p, q]
        d00, d01, d02 = work[k, 0], work[k, 1], work[k, 2]
        d11, d12, d22 = work[k, ROW + 1], work[k, ROW + 2], work[k, 2 * ROW + 2]
        for q in range(3 * ROW):
            work[k, q] = 0.0
        for entry in range(row_start[k], row_start[k + 1]):
            i, own = left[entry], where[entry]
            take_off_column(work, i, factor, below, start[i], own)
            v00, v01, v02 = inverse[i, 0], inverse[i, 1], inverse[i, 2]
            v11, v12, v22 = inverse[i, 3], inverse[i, 4], inverse[i, 5]
            y00, y01, y02 = work[i, 0], work[i, 1], work[i, 2]
            y10, y11, y12 = work[i, ROW], work[i, ROW + 1], work[i, ROW + 2]
            y20, y21, y22 = work[i, 2 * ROW], work[i, 2 * ROW + 1], work[i, 2 * ROW + 2]
            for q in range(3 * ROW):
                work[i, q] = 0.0
            l00, l01 = y00 * v00 + y10 * v01 + y20 * v02, y00 * v01 + y10 * v11 + y20 * v12
            l10, l11 = y01 * v00 + y11 * v01 + y21 * v02, y01 * v01 + y11 * v11 + y21 * v12
            l20, l21 = y02 * v00 + y12 * v01 + y22 * v02, y02 * v01 + y12 * v11 + y22 * v12
            l02, l12 = y00 * v02 + y10 * v12 + y20 * v22, y01 * v02 + y11 * v12 + y21 * v22
            l22 = y02 * v02 + y12 * v12 + y22 * v22
            factor[own, 0], factor[own, 1], factor[own, 2] = l00, l01, l02
            factor[own, 3], factor[own, 4], factor[own, 5] = l10, l11, l12
            factor[own, 6], factor[own, 7], factor[own, 8] = l20, l21, l22
            d00 -= l00 * y00 + l01 * y10 + l02 * y20
            d01 -= l00 * y01 + l01 * y11 + l02 * y21
            d02 -= l00 * y02 + l01 * y12 + l02 * y22
            d11 -= l10 * y01 + l11 * y11 + l12 * y21
            d12 -= l10 * y02 + l11 * y12 + l12 * y22
            d22 -= l20 * y02 + l21 * y12 + l22 * y22
        _fill_inverse(d00, d01, d02, d11, d12, d22, inverse[k])


@njit(cache=True, error_model="numpy")
def _fill_inverse(
    d00: float, d01: float, d02: float, d11: float, d12: float, d22: float, inverse: FloatArray
) -> None:
    """Upper half of the inverse of a symmetric 3×3 matrix, from its cofactors."""
    c00, c01, c02 = d11 * d22 - d12 * d12, d02 * d12 - d01 * d22, d01 * d12 - d02 * d11
    over = 1.0 / (d00 * c00 + d01 * c01 + d02 * c02)
    inverse[0], inverse[1], inverse[2] = c00 * over, c01 * over, c02 * over
    inverse[3], inverse[4] = (d00 * d22 - d02 * d02) * over, (d01 * d02 - d00 * d12) * over
    inverse[5] = (d00 * d11 - d01 * d01) * over


@njit(cache=True)
def _solve(
    start: IntArray, below: IntArray, factor: FloatArray, inverse: FloatArray, right: FloatArray
) -> FloatArray:
    out = right.copy()
    n = len(out)
    for i in range(n):
        x, y, z = out[i, 0], out[i, 1], out[i, 2]
        for block in range(start[i], start[i + 1]):
            j = below[block]
            out[j, 0] -= factor[block, 0] * x + factor[block, 1] * y + factor[block, 2] * z
            out[j, 1] -= factor[block, 3] * x + factor[block, 4] * y + factor[block, 5] * z
            out[j, 2] -= factor[block, 6] * x + factor[block, 7] * y + factor[block, 8] * z
    for i in range(n - 1, -1, -1):
        a, b, c = out[i, 0], out[i, 1], out[i, 2]
        x = inverse[i, 0] * a + inverse[i, 1] * b + inverse[i, 2] * c
        y = inverse[i, 1] * a + inverse[i, 3] * b + inverse[i, 4] * c
        z = inverse[i, 2] * a + inverse[i, 4] * b + inverse[i, 5] * c
        for block in range(start[i], start[i + 1]):
            j = below[block]
            a, b, c = out[j, 0], out[j, 1], out[j, 2]
            x -= factor[block, 0] * a + factor[block, 3] * b + factor[block, 6] * c
            y -= factor[block, 1] * a + factor[block, 4] * b + factor[block, 7] * c
            z -= factor[block, 2] * a + factor[block, 5] * b + factor[block, 8] * c
        out[i, 0], out[i, 1], out[i, 2] = x, y, z
    return out
