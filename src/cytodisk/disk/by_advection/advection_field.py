"""The field along which the advection moves its vertices: kernels over the triangles of the disk.

The field f solves Δf = λ − mean λ, with λ the proxy area factor of a triangle, in linear finite elements with
natural boundary. Its gradient flows out of triangles that are too small.
"""

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray

LARGEST_FACTOR = 20.0  # λ of smaller triangles is this; that of turned ones too
_LEAST_MEDIAN = 1e-3  # of the mean area, should most triangles be turned over
_TINY = 1e-300  # should the corners of a triangle meet in one point
_LEAST_FORM = 0.01  # area over the sum of squared sides: thinner ones count as this; √3/12 is equilateral


@njit(cache=True)
def signed_areas(uv: FloatArray, triangles: IntArray) -> FloatArray:
    """Area of each triangle in the disk, not positive where it is turned over, shape (F,)."""
    areas = np.empty(len(triangles))
    for t in range(len(triangles)):
        a, b, c = triangles[t]
        areas[t] = 0.5 * (
            (uv[b, 0] - uv[a, 0]) * (uv[c, 1] - uv[a, 1]) - (uv[b, 1] - uv[a, 1]) * (uv[c, 0] - uv[a, 0])
        )
    return areas


def area_factors(areas: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Proxy area factor λ of each triangle: the median area in the disk over its own.

    Parameters
    ----------
    areas : ndarray of shape (F,) and dtype float
        Signed areas in the disk.

    Returns
    -------
    factors : ndarray of shape (F,) and dtype float
        λ, above 0 and at most `LARGEST_FACTOR`.
    sizes : ndarray of shape (F,) and dtype float
        The areas they belong to: those of smaller and of turned triangles are raised.

    References
    ----------
    u-Unwrap, appendix A.2.1 (iii).
    """
    median = max(float(np.median(areas)), _LEAST_MEDIAN * float(areas.mean()))
    sizes = np.maximum(areas, median / LARGEST_FACTOR)
    return median / sizes, sizes


@njit(cache=True)
def edge_cotangents(uv: FloatArray, triangles: IntArray, areas: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Half the cotangent opposite to each edge in the disk; edge k runs from corner k to corner k + 1.

    A triangle counts by its size, turned over or not, and a thin one as if it were thicker: so the
    Laplacian of these weights stays positive semidefinite and no triangle stiffens it without bound.

    Parameters
    ----------
    uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
    areas : ndarray of shape (F,) and dtype float
        Signed areas.

    Returns
    -------
    weights : ndarray of shape (F, 3) and dtype float
    sizes : ndarray of shape (F,) and dtype float
        Area that each triangle was counted with, above 0.
    """
    weights, sizes = np.empty((len(triangles), 3)), np.empty(len(triangles))
    for t in range(len(triangles)):
        squares = 0.0
        for k in range(3):
            a, b, c = triangles[t, k], triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            squares += (uv[b, 0] - uv[a, 0]) ** 2 + (uv[b, 1] - uv[a, 1]) ** 2
            weights[t, k] = (uv[a, 0] - uv[c, 0]) * (uv[b, 0] - uv[c, 0]) + (uv[a, 1] - uv[c, 1]) * (
                uv[b, 1] - uv[c, 1]
            )
        sizes[t] = max(abs(areas[t]), _LEAST_FORM * squares, _TINY)
        for k in range(3):
            weights[t, k] *= 0.25 / sizes[t]
    return weights, sizes


@njit(cache=True)
def laplacian_times(weights: FloatArray, triangles: IntArray, values: FloatArray) -> FloatArray:
    """The positive Laplacian with these edge weights times values at vertices, shape (V,)."""
    out = np.zeros(len(values))
    for t in range(len(triangles)):
        for k in range(3):
            a, b = triangles[t, k], triangles[t, (k + 1) % 3]
            flow = weights[t, k] * (values[a] - values[b])
            out[a] += flow
            out[b] -= flow
    return out


@njit(cache=True)
def vertex_sources(
    factors: FloatArray, sizes: FloatArray, triangles: IntArray, n_vertices: int
) -> FloatArray:
    """What the field's equation has on its right: ∫ (mean λ − λ) over each vertex's share of its triangles.

    Parameters
    ----------
    factors, sizes : ndarray of shape (F,) and dtype float
        As `area_factors` returns them.
    triangles : ndarray of shape (F, 3) and dtype int
    n_vertices : int

    Returns
    -------
    ndarray of shape (V,) and dtype float
        Sums to 0.
    """
    mean = (factors * sizes).sum() / sizes.sum()
    out = np.zeros(n_vertices)
    for t in range(len(triangles)):
        part = sizes[t] * (mean - factors[t]) / 3.0
        for k in range(3):
            out[triangles[t, k]] += part
    return out


@njit(cache=True)
def vertex_gradients(
    field: FloatArray, uv: FloatArray, triangles: IntArray, areas: FloatArray, sizes: FloatArray
) -> FloatArray:
    """Gradient of a field on each triangle, averaged onto vertices by the triangles' sizes.

    Parameters
    ----------
    field : ndarray of shape (V,) and dtype float
    uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
    areas : ndarray of shape (F,) and dtype float
        Signed areas.
    sizes : ndarray of shape (F,) and dtype float
        As `edge_cotangents` returns them.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
        (d/du, d/dv).
    """
    out, total = np.zeros(uv.shape), np.zeros(len(uv))
    for t in range(len(triangles)):
        turn = 0.5 if areas[t] > 0.0 else -0.5
        du, dv = 0.0, 0.0
        for k in range(3):  # size times gradient, which stays bounded where the size goes to 0
            b, c = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            value = turn * field[triangles[t, k]]
            du -= value * (uv[c, 1] - uv[b, 1])
            dv += value * (uv[c, 0] - uv[b, 0])
        for k in range(3):
            n = triangles[t, k]
            out[n, 0] += du
            out[n, 1] += dv
            total[n] += sizes[t]
    for n in range(len(uv)):
        out[n, 0] /= total[n]
        out[n, 1] /= total[n]
    return out
