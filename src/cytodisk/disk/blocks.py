"""Symmetric systems with two unknowns, u and v, at each interior vertex of a mesh.

The matrix has a 2×2 block for each vertex and each edge between two of them. Where the blocks of its factor
lie is found once for a mesh; a factorisation then only computes, and u and v of a vertex go together, which
takes half the time of a factorisation that knows of single numbers (`benchmarks/factorisation.py`).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy import sparse

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.ldl import Factorisation
from cytodisk.geometry.half_edges import HalfEdges
from cytodisk.geometry.mesh import Mesh


class BlockSystem:
    """A positive definite matrix of 2×2 blocks on the interior vertices of a mesh, and its LDLᵀ factors.

    Unknowns are numbered in the order in which they are eliminated.

    Attributes
    ----------
    unknown : ndarray of shape (V,) and dtype int
        Number of each vertex among the unknowns; -1 for the boundary.
    vertex : ndarray of shape (N,) and dtype int
        Vertex of each unknown.
    place : ndarray of shape (F, 3, 3) and dtype int
        Block of the corners (row, column) of each triangle; -1 where the row's unknown comes after the
        column's, or either is at the boundary.
    blocks : ndarray of shape (P, 2, 2) and dtype float
        The matrix, to be filled: the upper triangle, and both halves of the blocks on the diagonal.
    diagonal : ndarray of shape (N,) and dtype int
        Block of each unknown with itself.

    References
    ----------
    Davis, "Direct methods for sparse linear systems", 2006, chapter 4, doi:10.1137/1.9780898718881
    """

    def __init__(self, mesh: Mesh):
        n_vertices = len(mesh.vertices_yx)
        edges = mesh.half_edges
        order = _elimination_order(edges, mesh.n_boundary)
        self.vertex = mesh.n_boundary + order
        self.unknown = np.full(n_vertices, -1)
        self.unknown[self.vertex] = np.arange(len(order))
        self._first, self._row = _upper(edges.first, edges.end, self.unknown, self.vertex)
        self.diagonal = self._first[1:] - 1
        self.place = _places(mesh.triangles, self.unknown, self._first, self._row)
        self.blocks = np.empty((len(self._row), 2, 2))
        self._pattern = _factor_pattern(self._first, self._row)
        self._factor = np.empty((len(self._pattern.below), 2, 2))
        self._inverse = np.empty((len(order), 2, 2))

    def factorise(self) -> None:
        """Compute the factors of `blocks`."""
        _factorise(self.blocks, self._first, self._row, self._pattern, self._factor, self._inverse)

    def solve(self, right: FloatArray) -> FloatArray:
        """Solution for one right-hand side, (N, 2), with the last factors."""
        start, below = self._pattern.start, self._pattern.below
        return np.asarray(_solve(start, below, self._factor, self._inverse, right))


def _elimination_order(edges: HalfEdges, n_boundary: int) -> IntArray:
    """Interior vertices, from 0, in an order that keeps the factors sparse: approximate minimum degree."""
    n = len(edges.first) - 1 - n_boundary
    if not n:
        return np.empty(0, dtype=np.int64)
    start, end = edges.start - n_boundary, edges.end - n_boundary
    upper = (start >= 0) & (end > start)
    degree = np.diff(edges.first)[n_boundary:]
    row = np.concatenate([start[upper], np.arange(n)])
    column = np.concatenate([end[upper], np.arange(n)])
    value = np.concatenate([np.full(int(upper.sum()), -1.0), degree + 1.0])
    return Factorisation(sparse.csc_matrix((value, (row, column)), shape=(n, n))).order


@njit(cache=True)
def _upper(first: IntArray, end: IntArray, unknown: IntArray, vertex: IntArray) -> tuple[IntArray, IntArray]:
    """First block of each column and the row of each block; the diagonal is last in its column."""
    n = len(vertex)
    start = np.zeros(n + 1, dtype=np.int64)
    row = np.empty(len(end) + n, dtype=np.int64)
    count = 0
    for column in range(n):
        a = vertex[column]
        for place in range(first[a], first[a + 1]):
            other = unknown[end[place]]
            if 0 <= other < column:
                row[count] = other
                count += 1
        row[count] = column
        count += 1
        start[column + 1] = count
    return start, row[:count].copy()


@njit(cache=True)
def _places(triangles: IntArray, unknown: IntArray, first: IntArray, row: IntArray) -> IntArray:
    place = np.full((triangles.shape[0], 3, 3), -1, dtype=np.int64)
    for t in range(triangles.shape[0]):
        for k in range(3):
            for l in range(3):
                i, j = unknown[triangles[t, k]], unknown[triangles[t, l]]
                if i < 0 or j < i:
                    continue
                block = first[j]
                while row[block] != i:
                    block += 1
                place[t, k, l] = block
    return place


class _Pattern(NamedTuple):
    """Where the blocks of the factor below its diagonal lie, by column and by row.

    Attributes
    ----------
    start, below : ndarray of shape (N + 1,) and (L,)
        First block of each column, and the row of each block in ascending order.
    row_start, left, where : ndarray of shape (N + 1,), (L,) and (L,)
        First entry of each row; column of each entry in ascending order, and its place among the blocks.
    """

    start: IntArray
    below: IntArray
    row_start: IntArray
    left: IntArray
    where: IntArray


@njit(cache=True)
def _factor_pattern(first: IntArray, row: IntArray) -> _Pattern:
    n = len(first) - 1
    parent = np.full(n, -1, dtype=np.int64)
    seen = np.full(n, -1, dtype=np.int64)
    start = np.zeros(n + 1, dtype=np.int64)
    row_start = np.zeros(n + 1, dtype=np.int64)
    below = np.empty(0, dtype=np.int64)
    filled = np.empty(0, dtype=np.int64)
    for filling in (False, True):
        if filling:
            start = np.cumsum(start)
            filled = start[:-1].copy()
            below = np.empty(start[-1], dtype=np.int64)
            seen[:] = -1
        for k in range(n):
            seen[k] = k
            for block in range(first[k], first[k + 1]):
                i = row[block]
                while seen[i] != k:  # up the elimination tree: every column that reaches row k
                    if parent[i] < 0:
                        parent[i] = k
                    if filling:
                        below[filled[i]] = k
                        filled[i] += 1
                    else:
                        start[i + 1] += 1
                        row_start[k + 1] += 1
                    seen[i] = k
                    i = parent[i]
    row_start = np.cumsum(row_start)
    left, where = np.empty(len(below), dtype=np.int64), np.empty(len(below), dtype=np.int64)
    filled = row_start[:-1].copy()
    for i in range(n):
        for block in range(start[i], start[i + 1]):
            k = below[block]
            left[filled[k]], where[filled[k]] = i, block
            filled[k] += 1
    return _Pattern(start, below, row_start, left, where)


@njit(cache=True, error_model="numpy")
def _factorise(
    blocks: FloatArray,
    first: IntArray,
    row: IntArray,
    pattern: _Pattern,
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
