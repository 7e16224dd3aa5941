"""Points inside closed polygons → triangles, with the polygons' edges among theirs."""

from typing import Any

import numpy as np
import pythoncdt
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import MeshError
from cytodisk.geometry.even_mesh import NEARER_PX, distances, join_circles
from cytodisk.geometry.half_edges import triangle_edges

_BIG = 3  # corners of the triangle around all points, in which the library inserts them


def triangulated(points_yx: FloatArray, loops: tuple[int, ...]) -> tuple[FloatArray, IntArray]:
    """Constrained Delaunay triangulation inside a loop, with a vertex on every edge that joins two of a loop.

    Parameters
    ----------
    points_yx : ndarray of shape (P, 2) and dtype float
        The first are closed polygons, one after the other, of which the first holds all other points.
    loops : tuple of int
        Points of each polygon.

    Returns
    -------
    points : ndarray of shape (V, 2) and dtype float
        The same with more behind.
    triangles : ndarray of shape (F, 3) and dtype int

    Raises
    ------
    MeshError
        Two edges of the polygons cross.
    """
    following = np.concatenate([np.roll(np.arange(n), -1) + sum(loops[:i]) for i, n in enumerate(loops)])
    found = _constrained_delaunay(points_yx, following, loops[0])
    triangles = join_circles(points_yx, found, loops[0], following if len(loops) > 1 else None)
    return _split_chords(points_yx, triangles, loops[0], following)


def _constrained_delaunay(points_yx: FloatArray, following: IntArray, n_boundary: int) -> IntArray:
    triangulation = pythoncdt.Triangulation(
        pythoncdt.VertexInsertionOrder.AUTO, pythoncdt.IntersectingConstraintEdges.NOT_ALLOWED, 0.0
    )
    points_xy: Any = np.ascontiguousarray(points_yx[:, ::-1])
    triangulation.insert_vertices(points_xy)
    edges: Any = np.column_stack([np.arange(len(following)), following]).astype(np.uint32)
    crossed = f"outline ({n_boundary} points) crosses itself: use trace_outline"
    try:
        triangulation.insert_edges(edges)
    except RuntimeError as error:
        raise MeshError(crossed) from error
    found: Any = triangulation.triangles_array()
    triangles = _within_loop(found.view(np.uint32).reshape(-1, 6), n_boundary)
    if not len(triangles):
        raise MeshError(crossed)
    return triangles


@njit(cache=True)
def _within_loop(triangles: IntArray, n_boundary: int) -> IntArray:
    """Triangles inside the loop of the first vertices, of a triangulation with the library's big triangle.

    Columns are a triangle's vertices and its neighbours, edge k from corner k to corner k + 1. The corners of
    the big triangle, in which points are put one by one, come before all other vertices.
    """
    n = len(triangles)
    outside = np.zeros(n, dtype=np.bool_)
    waiting = np.empty(n, dtype=np.int64)
    count = 0
    for t in range(n):
        if min(triangles[t, 0], triangles[t, 1], triangles[t, 2]) < _BIG:
            outside[t] = True
            waiting[count] = t
            count += 1
    n_outside = count
    while count > 0:
        count -= 1
        t = waiting[count]
        for k in range(3):
            across = triangles[t, 3 + k]
            a, b = np.int64(triangles[t, k]) - _BIG, np.int64(triangles[t, (k + 1) % 3]) - _BIG
            first, last = min(a, b), max(a, b)
            on_loop = last < n_boundary and (last - first == 1 or last - first == n_boundary - 1)
            if across < n and not outside[across] and not (on_loop and first >= 0):
                outside[across] = True
                waiting[count] = across
                count += 1
                n_outside += 1
    inside = np.empty((n - n_outside, 3), dtype=np.int64)
    kept = 0
    for t in range(n):
        if not outside[t]:
            for k in range(3):
                inside[kept, k] = np.int64(triangles[t, k]) - _BIG
            kept += 1
    return inside


def _split_chords(
    points_yx: FloatArray, triangles: IntArray, n_boundary: int, following: IntArray
) -> tuple[FloatArray, IntArray]:
    """Put a vertex on the middle of each edge between two vertices of outlines that is no outline's own."""
    n_pinned = len(following)
    first, second, third = np.ascontiguousarray((triangles < n_pinned).T)
    near = np.flatnonzero((first & second) | (second & third) | (third & first))
    start, stop = triangle_edges(triangles[near]).T
    chord = (start < n_pinned) & (stop < n_pinned)
    chord[chord] = (following[start[chord]] != stop[chord]) & (following[stop[chord]] != start[chord])
    low, high = np.minimum(start, stop)[chord], np.maximum(start, stop)[chord]
    chords, which = np.unique(low * n_pinned + high, return_inverse=True)
    added = np.full(len(start), -1)
    added[chord] = len(points_yx) + which
    middle = added.reshape(3, -1).T  # of edge k of each triangle
    low, high = chords // n_pinned, chords % n_pinned
    points = np.concatenate([points_yx, 0.5 * (points_yx[low] + points_yx[high])])
    split = (middle >= 0).any(axis=1)
    pieces = _subdivide(triangles[near[split]], middle[split], distances(points, n_boundary))
    return points, np.concatenate([np.delete(triangles, near[split], axis=0), *pieces])


def _subdivide(triangles: IntArray, middle: IntArray, distance: FloatArray) -> list[IntArray]:
    """Replace triangles by 2, 3 or 4, where `middle` (F, 3) holds a vertex for edge k, k + 1 or -1.

    Where there is a choice, the corner at the least `distance` gets the edge.
    """
    parts = []
    count = (middle >= 0).sum(axis=1)
    for n_split in (1, 2, 3):
        some = count == n_split
        if not some.any():
            continue
        # Turn each triangle so that its split edges come first.
        first = np.argmax(
            (middle[some] >= 0) & (np.roll(middle[some], 1, axis=1) < 0)
            if n_split < 3
            else middle[some] >= 0,
            axis=1,
        )
        turn = (first[:, None] + np.arange(3)) % 3
        a, b, c = np.take_along_axis(triangles[some], turn, axis=1).T
        p, q, r = np.take_along_axis(middle[some], turn, axis=1).T
        nearer_c = np.fmin(distance[p], distance[c]) + NEARER_PX < np.fmin(distance[a], distance[q])
        from_a, from_c = np.where(nearer_c, c, q), np.where(nearer_c, p, a)
        pieces = {
            1: [(a, p, c), (p, b, c)],
            2: [(p, b, q), (a, p, from_a), (from_c, q, c)],
            3: [(a, p, r), (p, b, q), (r, q, c), (p, q, r)],
        }[n_split]
        parts += [np.column_stack(piece) for piece in pieces]
    return parts
