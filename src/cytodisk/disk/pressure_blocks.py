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


class PressureSystem:
    """A quasi-definite matrix of 3×3 blocks on the interior vertices of a mesh, and its LDLᵀ factors.

    Attributes
    ----------
    pattern : BlockPattern
    blocks : ndarray of shape (P, 3, 3) and dtype float
        The matrix, to be filled: the upper triangle, and both halves of the blocks on the diagonal.

    References
    ----------
    Vanderbei, "Symmetric quasidefinite matrices", 1995, doi:10.1137/0805005
    """

    def __init__(self, pattern: BlockPattern):
        self.pattern = pattern
        self.blocks = np.empty((len(pattern.row), 3, 3))
        self._factor = np.empty((len(pattern.factor.below), 3, 3))
        self._inverse = np.empty((len(pattern.vertex), 3, 3))

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
    """Fill the factor, row after row, and the inverses of its diagonal blocks."""
    start, below, row_start, left, where = pattern
    n = len(first) - 1
    work = np.zeros((n, 3, 3))  # column k of what is left of the matrix
    for k in range(n):
        for block in range(first[k], first[k + 1]):
            for p in range(3):
                for q in range(3):
                    work[row[block], p, q] = blocks[block, p, q]
        d00, d01, d02 = work[k, 0, 0], work[k, 0, 1], work[k, 0, 2]
        d11, d12, d22 = work[k, 1, 1], work[k, 1, 2], work[k, 2, 2]
        for entry in range(row_start[k], row_start[k + 1]):
            i, own = left[entry], where[entry]
            y00, y01, y02 = work[i, 0, 0], work[i, 0, 1], work[i, 0, 2]
            y10, y11, y12 = work[i, 1, 0], work[i, 1, 1], work[i, 1, 2]
            y20, y21, y22 = work[i, 2, 0], work[i, 2, 1], work[i, 2, 2]
            for p in range(3):
                for q in range(3):
                    work[i, p, q] = 0.0
            for block in range(start[i], own):
                j = below[block]
                for p in range(3):
                    l0, l1, l2 = factor[block, p, 0], factor[block, p, 1], factor[block, p, 2]
                    work[j, p, 0] -= l0 * y00 + l1 * y10 + l2 * y20
                    work[j, p, 1] -= l0 * y01 + l1 * y11 + l2 * y21
                    work[j, p, 2] -= l0 * y02 + l1 * y12 + l2 * y22
            v00, v01, v02 = inverse[i, 0, 0], inverse[i, 0, 1], inverse[i, 0, 2]
            v11, v12, v22 = inverse[i, 1, 1], inverse[i, 1, 2], inverse[i, 2, 2]
            l00, l01, l02 = _row_times(y00, y10, y20, v00, v01, v02, v11, v12, v22)
            l10, l11, l12 = _row_times(y01, y11, y21, v00, v01, v02, v11, v12, v22)
            l20, l21, l22 = _row_times(y02, y12, y22, v00, v01, v02, v11, v12, v22)
            factor[own, 0, 0], factor[own, 0, 1], factor[own, 0, 2] = l00, l01, l02
            factor[own, 1, 0], factor[own, 1, 1], factor[own, 1, 2] = l10, l11, l12
            factor[own, 2, 0], factor[own, 2, 1], factor[own, 2, 2] = l20, l21, l22
            d00 -= l00 * y00 + l01 * y10 + l02 * y20
            d01 -= l00 * y01 + l01 * y11 + l02 * y21
            d02 -= l00 * y02 + l01 * y12 + l02 * y22
            d11 -= l10 * y01 + l11 * y11 + l12 * y21
            d12 -= l10 * y02 + l11 * y12 + l12 * y22
            d22 -= l20 * y02 + l21 * y12 + l22 * y22
        for p in range(3):
            for q in range(3):
                work[k, p, q] = 0.0
        _fill_inverse(d00, d01, d02, d11, d12, d22, inverse[k])


@njit(cache=True)
def _row_times(
    x: float,
    y: float,
    z: float,
    v00: float,
    v01: float,
    v02: float,
    v11: float,
    v12: float,
    v22: float,
) -> tuple[float, float, float]:
    """(x, y, z) times a symmetric 3×3 matrix."""
    return x * v00 + y * v01 + z * v02, x * v01 + y * v11 + z * v12, x * v02 + y * v12 + z * v22


@njit(cache=True, error_model="numpy")
def _fill_inverse(
    d00: float, d01: float, d02: float, d11: float, d12: float, d22: float, inverse: FloatArray
) -> None:
    """Inverse of a symmetric 3×3 matrix, from its cofactors."""
    c00, c01, c02 = d11 * d22 - d12 * d12, d02 * d12 - d01 * d22, d01 * d12 - d02 * d11
    over = 1.0 / (d00 * c00 + d01 * c01 + d02 * c02)
    inverse[0, 0], inverse[1, 1], inverse[2, 2] = (
        c00 * over,
        (d00 * d22 - d02 * d02) * over,
        (d00 * d11 - d01 * d01) * over,
    )
    inverse[0, 1] = inverse[1, 0] = c01 * over
    inverse[0, 2] = inverse[2, 0] = c02 * over
    inverse[1, 2] = inverse[2, 1] = (d01 * d02 - d00 * d12) * over


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
            for p in range(3):
                out[j, p] -= factor[block, p, 0] * x + factor[block, p, 1] * y + factor[block, p, 2] * z
    for i in range(n - 1, -1, -1):
        a, b, c = out[i, 0], out[i, 1], out[i, 2]
        x = inverse[i, 0, 0] * a + inverse[i, 0, 1] * b + inverse[i, 0, 2] * c
        y = inverse[i, 1, 0] * a + inverse[i, 1, 1] * b + inverse[i, 1, 2] * c
        z = inverse[i, 2, 0] * a + inverse[i, 2, 1] * b + inverse[i, 2, 2] * c
        for block in range(start[i], start[i + 1]):
            a, b, c = out[below[block], 0], out[below[block], 1], out[below[block], 2]
            x -= factor[block, 0, 0] * a + factor[block, 1, 0] * b + factor[block, 2, 0] * c
            y -= factor[block, 0, 1] * a + factor[block, 1, 1] * b + factor[block, 2, 1] * c
            z -= factor[block, 0, 2] * a + factor[block, 1, 2] * b + factor[block, 2, 2] * c
        out[i, 0], out[i, 1], out[i, 2] = x, y, z
    return out
