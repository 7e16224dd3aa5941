"""Find the triangle that holds a point, and the outline point nearest to one."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray, IntArray

_BLOCK = 8192  # points
_TOLERANCE = 1e-9  # of the mesh's extent: a point this far outside still counts as on the edge


class _Bins(NamedTuple):
    """A grid of bins, and the triangles that touch each.

    Attributes
    ----------
    low : ndarray of shape (2,) and dtype float
        Where the first bin starts.
    size : float
        Side of a bin.
    shape : ndarray of shape (2,) and dtype int
    start : ndarray of shape (bins + 1,) and dtype int
        First entry of each bin in `found`.
    found : ndarray of shape (M,) and dtype int
        Triangles, bin by bin.
    """

    low: FloatArray
    size: float
    shape: IntArray
    start: IntArray
    found: IntArray


class TriangleLocator:
    """Point location in a triangulation, through a grid of bins that list the triangles touching them.

    Parameters
    ----------
    points : ndarray of shape (V, 2) and dtype float
        Vertices in any frame.
    triangles : ndarray of shape (F, 3) and dtype int
        Of either orientation. Where turned triangles lie over others, the first that holds a point is taken;
        triangles without area hold none.
    """

    def __init__(self, points: FloatArray, triangles: IntArray):
        self._points = np.ascontiguousarray(points)
        self._triangles = np.ascontiguousarray(triangles)
        low, high = points.min(axis=0), points.max(axis=0)
        self._slack = _TOLERANCE * float((high - low).max())
        low = low - self._slack
        extent = high - low + self._slack
        size = math.sqrt(float(extent.prod()) / len(triangles))
        shape = np.ceil(extent / size).astype(np.int64)
        listed = _fill_bins(self._points, self._triangles, low, size, shape, self._slack)
        self._bins = _Bins(low, size, shape, *listed)

    def __call__(self, points: FloatArray) -> tuple[IntArray, FloatArray]:
        """Triangle of each point and its barycentric coordinates there.

        Parameters
        ----------
        points : ndarray of shape (N, 2) and dtype float
            In the frame of the vertices; NaN is outside.

        Returns
        -------
        triangle : ndarray of shape (N,) and dtype int
            -1 outside.
        weights : ndarray of shape (N, 3) and dtype float
            They sum to 1; NaN outside.
        """
        return _locate(
            np.ascontiguousarray(points, dtype=np.float64),
            self._points,
            self._triangles,
            self._bins,
            self._slack,
        )

    def carry(self, points: FloatArray, goals: FloatArray) -> FloatArray:
        """Points under the map that is linear on every triangle; `weighted_corners` of located points.

        Parameters
        ----------
        points : ndarray of shape (N, 2) and dtype float
            In the frame of the vertices.
        goals : ndarray of shape (V, 2) and dtype float
            Where the vertices go.

        Returns
        -------
        ndarray of shape (N, 2) and dtype float
            NaN outside.
        """
        moved, goals = np.empty((len(points), 2)), np.ascontiguousarray(goals)
        for first in range(0, len(points), _BLOCK):  # weights and triangles of a block stay in the cache
            block = slice(first, first + _BLOCK)
            moved[block] = weighted_corners(goals, self._triangles, *self(points[block]))
        return moved


@njit(cache=True)
def _band_columns(points: FloatArray, triangle: IntArray, bottom: float, top: float) -> tuple[float, float]:
    """Range of the second coordinate of a triangle within a band of the first."""
    first, last = np.inf, -np.inf
    for k in range(3):
        a, b = triangle[k], triangle[(k + 1) % 3]
        p, q = points[a, 0], points[b, 0]
        if max(p, q) < bottom or min(p, q) > top:
            continue
        for bound in (bottom, top):
            clipped = min(max(p, bound), q) if p < q else min(max(q, bound), p)
            s = (clipped - p) / (q - p) if p != q else 0.0
            x = points[a, 1] + s * (points[b, 1] - points[a, 1])
            first, last = min(first, x), max(last, x)
        if p == q:
            first, last = min(first, points[b, 1]), max(last, points[b, 1])
    return first, last


@njit(cache=True)
def _fill_bins(
    points: FloatArray,
    triangles: IntArray,
    low: FloatArray,
    size: float,
    shape: IntArray,
    slack: float,
) -> tuple[IntArray, IntArray]:
    start = np.zeros(shape[0] * shape[1] + 1, dtype=np.int64)
    found = np.empty(0, dtype=np.int64)
    for filling in (False, True):
        if filling:
            start = np.cumsum(start)
            found = np.empty(start[-1], dtype=np.int64)
        cursor = start.copy()
        for t in range(triangles.shape[0]):
            a, b, c = points[triangles[t, 0], 0], points[triangles[t, 1], 0], points[triangles[t, 2], 0]
            first_row = max(int((min(a, b, c) - slack - low[0]) / size), 0)
            last_row = min(int((max(a, b, c) + slack - low[0]) / size), shape[0] - 1)
            for row in range(first_row, last_row + 1):
                bottom = low[0] + row * size - slack
                left, right = _band_columns(points, triangles[t], bottom, bottom + size + 2.0 * slack)
                if left > right:
                    continue
                first = max(int((left - slack - low[1]) / size), 0)
                last = min(int((right + slack - low[1]) / size), shape[1] - 1)
                for column in range(first, last + 1):
                    place = row * shape[1] + column
                    if filling:
                        found[cursor[place]] = t
                        cursor[place] += 1
                    else:
                        start[place + 1] += 1
    return start, found


@njit(cache=True)
def _locate(
    queries: FloatArray,
    points: FloatArray,
    triangles: IntArray,
    bins: _Bins,
    slack: float,
) -> tuple[IntArray, FloatArray]:
    low, size, shape, start, found = bins
    triangle = np.full(queries.shape[0], -1, dtype=np.int64)
    weights = np.full((queries.shape[0], 3), np.nan)
    w, height = np.empty(3), np.empty(3)
    for n in range(queries.shape[0]):
        y, x = queries[n, 0], queries[n, 1]
        if math.isnan(y) or math.isnan(x):
            continue
        row, column = math.floor((y - low[0]) / size), math.floor((x - low[1]) / size)
        if row < 0 or column < 0 or row >= shape[0] or column >= shape[1]:
            continue
        best = -slack
        place = int(row) * shape[1] + int(column)
        for entry in range(start[place], start[place + 1]):
            t = found[entry]
            total = 0.0
            for k in range(3):
                b, c = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
                by, bx = points[b, 0] - y, points[b, 1] - x
                cy, cx = points[c, 0] - y, points[c, 1] - x
                w[k] = bx * cy - by * cx
                height[k] = math.hypot(points[c, 0] - points[b, 0], points[c, 1] - points[b, 1])
                total += w[k]
            if total == 0.0:
                continue
            # Signed distance to the nearest side, positive inside.
            sign = 1.0 if total > 0.0 else -1.0
            inside = min(sign * w[0] / height[0], sign * w[1] / height[1], sign * w[2] / height[2])
            if inside >= best:
                best = inside
                triangle[n] = t
                for k in range(3):
                    weights[n, k] = w[k] / total
                if inside > 0.0:
                    break
    return triangle, weights


@njit(cache=True)
def weighted_corners(
    values: FloatArray, triangles: IntArray, triangle: IntArray, weights: FloatArray
) -> FloatArray:
    """Weighted mean of the values at a triangle's corners.

    Parameters
    ----------
    values : ndarray of shape (V, 2) and dtype float
        Two numbers a vertex.
    triangles : ndarray of shape (F, 3) and dtype int
    triangle : ndarray of shape (N,) and dtype int
        -1 for none.
    weights : ndarray of shape (N, 3) and dtype float

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        NaN where there is no triangle.
    """
    out = np.full((len(triangle), 2), np.nan)
    for n in range(len(triangle)):
        t = triangle[n]
        if t >= 0:
            a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
            for k in range(2):
                out[n, k] = (
                    weights[n, 0] * values[a, k] + weights[n, 1] * values[b, k] + weights[n, 2] * values[c, k]
                )
    return out


def nearest_on_outline(points: FloatArray, outline: FloatArray) -> tuple[IntArray, FloatArray]:
    """Nearest point of a closed polygon for each point, among the edges at its nearest vertices.

    Parameters
    ----------
    points : ndarray of shape (N, 2) and dtype float
    outline : ndarray of shape (B, 2) and dtype float
        Closed polygon with edges about a pixel long, in the frame of the points.

    Returns
    -------
    edge : ndarray of shape (N,) and dtype int
        Edge i runs from vertex i to vertex i + 1.
    fraction : ndarray of shape (N,) and dtype float
        0 at the start of the edge, 1 at its end.
    """
    n_edges = len(outline)
    tree = cKDTree(outline, leafsize=64, compact_nodes=False, balanced_tree=False)  # built in no time
    _, near = tree.query(points, k=min(4, n_edges))
    edges = np.concatenate([near, near - 1], axis=1) % n_edges
    start = outline[edges]
    along = outline[(edges + 1) % n_edges] - start
    fraction = np.clip(
        ((points[:, None] - start) * along).sum(axis=-1) / (along * along).sum(axis=-1), 0.0, 1.0
    )
    away = points[:, None] - (start + fraction[..., None] * along)
    best = (away * away).sum(axis=-1).argmin(axis=1)[:, None]
    return (
        np.take_along_axis(edges, best, axis=1)[:, 0],
        np.take_along_axis(fraction, best, axis=1)[:, 0],
    )
