"""Which blocks a symmetric matrix on the interior vertices of a mesh has, and which its factor.

Both are found once for a mesh, whatever the size of a block: `blocks` has two unknowns a vertex,
`pressure_blocks` three.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit
from scipy import sparse

from cytodisk.arrays import IntArray
from cytodisk.disk.ldl import Factorisation
from cytodisk.geometry.half_edges import HalfEdges
from cytodisk.geometry.mesh import Mesh


class BlockPattern:
    """A block for each interior vertex of a mesh and for each edge between two of them.

    Unknowns are numbered in the order in which they are eliminated.

    Attributes
    ----------
    unknown : ndarray of shape (V,) and dtype int
        Number of each vertex among the unknowns; -1 for the boundary.
    vertex : ndarray of shape (N,) and dtype int
        Vertex of each unknown.
    first : ndarray of shape (N + 1,) and dtype int
        First block of each column of the upper triangle; the diagonal is last in its column.
    row : ndarray of shape (P,) and dtype int
        Row of each block.
    place : ndarray of shape (F, 3, 3) and dtype int
        Block of the corners (row, column) of each triangle; -1 where the row's unknown comes after the
        column's, or either is at the boundary.
    diagonal : ndarray of shape (N,) and dtype int
        Block of each unknown with itself.
    factor : FactorPattern

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
        self.first, self.row = _upper(edges.first, edges.end, self.unknown, self.vertex)
        self.diagonal = self.first[1:] - 1
        self.place = _places(mesh.triangles, self.unknown, self.first, self.row)
        self.factor = _factor_pattern(self.first, self.row)


def _elimination_order(edges: HalfEdges, n_boundary: int) -> IntArray:
    """Interior vertices, from 0, in an order that keeps the factors sparse: approximate minimum degree."""
    n = len(edges.first) - 1 - n_boundary
    if not n:
        return np.empty(0, dtype=np.int64)
    first, row = _upper(
        edges.first, edges.end, np.arange(-n_boundary, n), np.arange(n_boundary, n_boundary + n)
    )
    value = np.full(len(row), -1.0)
    value[first[1:] - 1] = np.diff(edges.first)[n_boundary:] + 1.0
    return Factorisation(sparse.csc_matrix((value, row, first), shape=(n, n))).order


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
            i = unknown[triangles[t, k]]
            if i < 0:
                continue
            place[t, k, k] = first[i + 1] - 1
            for l in range(3):
                j = unknown[triangles[t, l]]
                if j > i:
                    block = first[j]
                    while row[block] != i:
                        block += 1
                    place[t, k, l] = block
    return place


class FactorPattern(NamedTuple):
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
def _factor_pattern(first: IntArray, row: IntArray) -> FactorPattern:
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
    return FactorPattern(start, below, row_start, left, where)
