"""The edges of a triangulation, each in the directions in which triangles run along it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, IntArray


@dataclass(frozen=True, eq=False)
class HalfEdges:
    """Directed edges of triangles, sorted by the vertex they leave and then by the one they reach.

    Attributes
    ----------
    first : ndarray of shape (V + 1,) and dtype int
        Edges first[a] to first[a + 1] leave vertex a.
    end : ndarray of shape (3 F,) and dtype int
        Vertex that each edge reaches.
    outer : ndarray of shape (3 F,) and dtype bool
        Whether no triangle runs along the edge the other way round.
    n_edges : int
        Edges without regard to direction.
    """

    first: IntArray
    end: IntArray
    outer: BoolArray
    n_edges: int

    @property
    def start(self) -> IntArray:
        """Vertex that each edge leaves, shape (3 F,)."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))

    @property
    def all_used(self) -> bool:
        """Whether every vertex belongs to a triangle."""
        return bool((np.diff(self.first) > 0).all())

    @property
    def repeated(self) -> bool:
        """Whether two triangles run along an edge the same way: then they are on the same side of it."""
        return bool(((np.diff(self.start) == 0) & (np.diff(self.end) == 0)).any())

    @property
    def euler_characteristic(self) -> int:
        """Vertices - edges + triangles; 1 for a topological disk."""
        return len(self.first) - 1 - self.n_edges + len(self.end) // 3


def half_edges(triangles: IntArray, n_vertices: int) -> HalfEdges:
    """Directed edges of a triangulation.

    Parameters
    ----------
    triangles : ndarray of shape (F, 3) and dtype int
        All below `n_vertices`.
    n_vertices : int

    Returns
    -------
    HalfEdges
    """
    first, end, start = _sorted_edges(triangles, n_vertices)
    return HalfEdges(first, end, *_without_opposite(first, end, start))


def triangle_edges(triangles: IntArray) -> IntArray:
    """The three edges of each triangle as (from, to), shape (3 F, 2); edge k of triangle t in row k F + t."""
    return np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])


@njit(cache=True)
def _sorted_edges(triangles: IntArray, n_vertices: int) -> tuple[IntArray, IntArray, IntArray]:
    """End of each edge, by its start and then by itself; and start of each, by its end and then by itself.

    As many edges reach a vertex as leave it, so that both are found from `first`.
    """
    first = np.zeros(n_vertices + 1, dtype=np.int64)
    for t in range(triangles.shape[0]):
        for k in range(3):
            first[triangles[t, k] + 1] += 1
    for a in range(n_vertices):
        first[a + 1] += first[a]
    start, end = np.empty(first[-1], dtype=np.int64), np.empty(first[-1], dtype=np.int64)
    filled = first[:-1].copy()
    for t in range(triangles.shape[0]):
        for k in range(3):
            b = triangles[t, (k + 1) % 3]
            start[filled[b]] = triangles[t, k]
            filled[b] += 1
    _turn_around(first, start, end)
    _turn_around(first, end, start)
    return first, end, start


@njit(cache=True)
def _turn_around(first: IntArray, one: IntArray, other: IntArray) -> None:
    """Edges listed at one of their ends are listed at the other one, each list in ascending order."""
    filled = first[:-1].copy()
    for b in range(len(first) - 1):
        for place in range(first[b], first[b + 1]):
            a = one[place]
            other[filled[a]] = b
            filled[a] += 1


@njit(cache=True)
def _without_opposite(first: IntArray, end: IntArray, start: IntArray) -> tuple[BoolArray, int]:
    outer = np.empty(len(end), dtype=np.bool_)
    n_edges = 0
    for a in range(len(first) - 1):
        back = first[a]
        for place in range(first[a], first[a + 1]):
            b = end[place]
            while back < first[a + 1] and start[back] < b:
                back += 1
            outer[place] = back == first[a + 1] or start[back] != b
            repeated = place > first[a] and end[place - 1] == b
            if not repeated and (a <= b or outer[place]):
                n_edges += 1
    return outer, n_edges
