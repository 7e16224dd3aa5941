"""Edge flips that make a triangulation Delaunay in one frame and keep it valid in another."""

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray

_MOST_PASSES = 10
_SLACK = 1e-9  # of a sum of cotangents: four points on a circle stay as they are


def triangle_neighbours(triangles: IntArray) -> IntArray:
    """The triangle on the other side of each edge; edge k runs from corner k to corner k + 1.

    Parameters
    ----------
    triangles : ndarray of shape (F, 3) and dtype int
        All of one orientation.

    Returns
    -------
    ndarray of shape (F, 3) and dtype int
        -1 at the boundary.
    """
    return np.asarray(_across(np.ascontiguousarray(triangles), int(triangles.max()) + 1))


@njit(cache=True)
def _across(triangles: IntArray, n_vertices: int) -> IntArray:
    last = np.full(n_vertices, -1)  # the edge that was seen last of those that leave a vertex ...
    before = np.empty(triangles.size, dtype=np.int64)  # ... and for each edge, the one seen before it
    across = np.full(triangles.shape, -1)
    for t in range(triangles.shape[0]):
        for k in range(3):
            a, b = triangles[t, k], triangles[t, (k + 1) % 3]
            other = last[b]
            while other >= 0:
                s, m = other // 3, other % 3
                if triangles[s, (m + 1) % 3] == a:
                    across[t, k], across[s, m] = s, t
                    break
                other = before[other]
            before[3 * t + k] = last[a]
            last[a] = 3 * t + k
    return across


@njit(cache=True)
def flip_to_delaunay(
    points_uv: FloatArray,
    cell_xy: FloatArray,
    triangles: IntArray,
    neighbours: IntArray,
    n_boundary: int,
    least_area: float,
) -> int:
    """Flip edges, in place, until they are Delaunay in the disk or may not be flipped, in ten rounds at most.

    An edge is flipped if the two angles opposite to it sum to more than π in the disk; where one of its two
    triangles is turned over there, if the flip makes the smaller of the two signed areas larger, which can
    turn it back. It is not flipped if a new triangle would have less than `least_area` in the cell, nor
    if the new edge would join two boundary vertices.

    Parameters
    ----------
    points_uv : ndarray of shape (V, 2) and dtype float
        (u, v) in the disk.
    cell_xy : ndarray of shape (V, 2) and dtype float
        (column, row) in the cell, where every triangle is positive and stays so.
    triangles, neighbours : ndarray of shape (F, 3) and dtype int
        Changed in place; neighbours as from `triangle_neighbours`.
    n_boundary : int
        Vertices below this number are on the boundary.
    least_area : float
        In square pixels; at most 0 lets triangles turn over in the cell.

    Returns
    -------
    int
        Number of flips.
    """
    touched = np.ones(len(triangles), dtype=np.bool_)
    total = 0
    for attempt in range(_MOST_PASSES):
        count = 0
        for t in range(len(triangles)):
            if not touched[t]:
                continue
            touched[t] = False
            for k in range(3):
                s = neighbours[t, k]
                if s < 0 or (attempt == 0 and s < t):  # the other side has tried it
                    continue
                if not _improves(points_uv, cell_xy, triangles, neighbours, t, k, n_boundary, least_area):
                    continue
                flip(triangles, neighbours, t, k)
                for side in range(3):  # their outer edges may have to be flipped now
                    for one in (t, s):
                        if neighbours[one, side] >= 0:
                            touched[neighbours[one, side]] = True
                count += 1
                break
        total += count
        if count == 0:
            break
    return total


@njit(cache=True)
def signed_area_of(points: FloatArray, a: int, b: int, c: int) -> float:
    ab_x, ab_y = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
    ac_x, ac_y = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1]
    return 0.5 * (ab_x * ac_y - ab_y * ac_x)  # type: ignore[no-any-return]


@njit(cache=True)
def _dot(points: FloatArray, a: int, b: int, corner: int) -> float:
    x, y = points[corner, 0], points[corner, 1]
    return (points[a, 0] - x) * (points[b, 0] - x) + (points[a, 1] - y) * (points[b, 1] - y)  # type: ignore[no-any-return]


@njit(cache=True)
def side_of(neighbours: IntArray, t: int, s: int) -> int:
    """Which edge of triangle t it shares with s."""
    if neighbours[t, 0] == s:
        return 0
    return 1 if neighbours[t, 1] == s else 2


@njit(cache=True)
def _improves(
    uv: FloatArray,
    xy: FloatArray,
    triangles: IntArray,
    neighbours: IntArray,
    t: int,
    k: int,
    n_boundary: int,
    least_area: float,
) -> bool:
    s = neighbours[t, k]
    a, b, c = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
    d = triangles[s, (side_of(neighbours, s, t) + 2) % 3]
    if c < n_boundary and d < n_boundary:
        return False
    before_c, before_d = signed_area_of(uv, a, b, c), signed_area_of(uv, b, a, d)
    after_a, after_b = signed_area_of(uv, a, d, c), signed_area_of(uv, d, b, c)
    if before_c > 0.0 and before_d > 0.0:
        cotangents = _dot(uv, a, b, c) / before_c + _dot(uv, a, b, d) / before_d
        if cotangents >= -_SLACK or after_a <= 0.0 or after_b <= 0.0:
            return False
    elif min(after_a, after_b) <= min(before_c, before_d):
        return False
    return signed_area_of(xy, a, d, c) > least_area and signed_area_of(xy, d, b, c) > least_area


@njit(cache=True)
def flip(triangles: IntArray, neighbours: IntArray, t: int, k: int) -> None:
    """Triangles (a, b, c) and (b, a, d) become (a, d, c) and (d, b, c)."""
    s = neighbours[t, k]
    m = side_of(neighbours, s, t)
    a, b, c = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
    d = triangles[s, (m + 2) % 3]
    beyond_bc, beyond_ca = neighbours[t, (k + 1) % 3], neighbours[t, (k + 2) % 3]
    beyond_ad, beyond_db = neighbours[s, (m + 1) % 3], neighbours[s, (m + 2) % 3]
    triangles[t, 0], triangles[t, 1], triangles[t, 2] = a, d, c
    neighbours[t, 0], neighbours[t, 1], neighbours[t, 2] = beyond_ad, s, beyond_ca
    triangles[s, 0], triangles[s, 1], triangles[s, 2] = d, b, c
    neighbours[s, 0], neighbours[s, 1], neighbours[s, 2] = beyond_db, beyond_bc, t
    for beyond, vertex, old, new in ((beyond_ad, d, s, t), (beyond_bc, c, t, s)):
        if beyond >= 0:  # a neighbour may share two edges with this pair: its edge starts at `vertex`
            for side in range(3):
                if triangles[beyond, side] == vertex and neighbours[beyond, side] == old:
                    neighbours[beyond, side] = new
