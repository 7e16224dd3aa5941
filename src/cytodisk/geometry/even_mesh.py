"""A mesh that turns and mirrors with its cell, with interior vertices evenly spaced between its neighbours.

Where spacings of the lattice meet, four and more points lie on one circle, and rounding alone says how a
Delaunay triangulation joins them: a mirrored cell would get another mesh.
"""

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.geometry.flips import flip, side_of, signed_area_of, triangle_neighbours

_ON_CIRCLE = 1e-9  # of the in-circle determinant, in units of the fourth power of the longest side
NEARER_PX = 1e-7
_MOST_ROUNDS = 50
_PASSES = 3
_LEAST_AREA = 0.1  # of what a triangle had before a pass


def join_circles(
    points_yx: FloatArray, triangles: IntArray, n_boundary: int, following: IntArray | None = None
) -> IntArray:
    """Join points that lie on one circle by edges from the one nearest to a place that moves with the cell.

    Parameters
    ----------
    points_yx : ndarray of shape (V, 2) and dtype float
        The first `n_boundary` are the outline.
    triangles : ndarray of shape (F, 3) and dtype int
        A constrained Delaunay triangulation, all areas positive.
    n_boundary : int
    following : ndarray of shape (P,) and dtype int, optional
        The next vertex of each vertex of an outline, where there are several; these are the first ones.
        Edges of outlines stay.

    Returns
    -------
    ndarray of shape (F, 3) and dtype int
        Another constrained Delaunay triangulation of these points.
    """
    triangles = np.ascontiguousarray(triangles).copy()
    distance, neighbours = distances(points_yx, n_boundary), triangle_neighbours(triangles)
    if following is not None:
        ends = np.roll(triangles, -1, axis=1)
        within = (triangles < len(following)) & (ends < len(following))
        start, stop = np.where(within, triangles, 0), np.where(within, ends, 0)
        neighbours[within & ((following[start] == stop) | (following[stop] == start))] = -1
    _join(points_yx, distance, triangles, neighbours)
    return triangles


def distances(points_yx: FloatArray, n_boundary: int) -> FloatArray:
    """Distance of points from a place that moves with the cell, so that they can be told apart.

    Parameters
    ----------
    points_yx : ndarray of shape (V, 2) and dtype float
        The first `n_boundary` are the outline.
    n_boundary : int

    Returns
    -------
    ndarray of shape (V,) and dtype float
        From the mean of the outline's points, each weighted by its squared distance from their plain mean.
    """
    outline = points_yx[:n_boundary]
    far = np.square(outline - outline.mean(axis=0)).sum(axis=1)
    place = (far[:, None] * outline).sum(axis=0) / far.sum()
    return np.asarray(np.hypot(*(points_yx - place).T))


def even_out(points_yx: FloatArray, triangles: IntArray, n_boundary: int) -> FloatArray:
    """Move interior vertices three times to the centre of mass of the triangles around them.

    Vertices stay where a triangle would lose nine tenths of its area.

    Parameters
    ----------
    points_yx : ndarray of shape (V, 2) and dtype float
        The first `n_boundary` stay where they are.
    triangles : ndarray of shape (F, 3) and dtype int
        All areas positive, as they are afterwards.
    n_boundary : int

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    for _ in range(_PASSES):
        points_yx = _pass(points_yx, triangles, n_boundary)
    return points_yx


@njit(cache=True)
def _join(points: FloatArray, distance: FloatArray, triangles: IntArray, neighbours: IntArray) -> None:
    """Flip edges between triangles on one circle, in place, until all of them meet at its nearest point."""
    last_flip = np.zeros(len(triangles), dtype=np.int64)  # the round in which each triangle was last changed
    for attempt in range(1, _MOST_ROUNDS + 1):
        changed = False
        for t in range(len(triangles)):
            for k in range(3):
                s = neighbours[t, k]
                if (
                    s < 0 or max(last_flip[t], last_flip[s]) < attempt - 1
                ):  # both as they were when last tried
                    continue
                a, b, c = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
                d = triangles[s, (side_of(neighbours, s, t) + 2) % 3]
                gain = min(distance[a], distance[b]) - min(distance[c], distance[d])
                if gain > NEARER_PX and _flippable(points, a, b, c, d):
                    flip(triangles, neighbours, t, k)
                    last_flip[t] = last_flip[s] = attempt
                    changed = True
                    break
        if not changed:
            return


@njit(cache=True)
def _flippable(points: FloatArray, a: int, b: int, c: int, d: int) -> bool:
    """Whether triangles (a, b, c) and (b, a, d) lie on one circle, so that edge c-d serves as well as a-b."""
    ay, ax = points[a, 0] - points[d, 0], points[a, 1] - points[d, 1]
    by, bx = points[b, 0] - points[d, 0], points[b, 1] - points[d, 1]
    cy, cx = points[c, 0] - points[d, 0], points[c, 1] - points[d, 1]
    aa, bb, cc = ax * ax + ay * ay, bx * bx + by * by, cx * cx + cy * cy
    inside = aa * (bx * cy - by * cx) - bb * (ax * cy - ay * cx) + cc * (ax * by - ay * bx)
    longest = max(aa, bb, cc)
    if abs(inside) > _ON_CIRCLE * longest * longest:
        return False
    turn = np.sign(signed_area_of(points, a, b, c))
    least = _ON_CIRCLE * longest
    one, other = signed_area_of(points, a, d, c), signed_area_of(points, d, b, c)
    return bool(turn * one > least and turn * other > least)


@njit(cache=True, error_model="numpy")  # a triangle without area gives NaN, which `mesh_inside` refuses
def _pass(points: FloatArray, triangles: IntArray, n_boundary: int) -> FloatArray:
    weighted, weight = np.zeros_like(points), np.zeros(len(points))
    before = np.empty(len(triangles))
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        area = signed_area_of(points, a, b, c)
        before[t] = area
        y = area * ((points[a, 0] + points[b, 0] + points[c, 0]) / 3.0)
        x = area * ((points[a, 1] + points[b, 1] + points[c, 1]) / 3.0)
        for k in range(3):
            vertex = triangles[t, k]
            weight[vertex] += area
            weighted[vertex, 0] += y
            weighted[vertex, 1] += x
    free: BoolArray = np.arange(len(points)) >= n_boundary
    while True:
        moved = points.copy()
        for vertex in range(n_boundary, len(points)):
            if free[vertex]:
                moved[vertex, 0] = weighted[vertex, 0] / weight[vertex]
                moved[vertex, 1] = weighted[vertex, 1] / weight[vertex]
        held = False
        for t in range(len(triangles)):
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            if signed_area_of(moved, a, b, c) / before[t] < _LEAST_AREA:
                held = True
                for k in range(3):
                    free[triangles[t, k]] = False
        if not held:
            return moved
