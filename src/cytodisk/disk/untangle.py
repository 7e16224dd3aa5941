"""Mend a nearly valid map: triangles that are flipped, or nearly, push their corners apart."""

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.geometry.mesh import Mesh, triangle_areas

_LEAST_AREA = 1e-10  # of a triangle in the disk that a relaxation may start from
_PUSHED = 0.1  # of its share of the disk: less is too small for a triangle
_WANTED = 2.0  # times that is what it is given
_SWEEPS = 100


def untangled(mesh: Mesh, uv: FloatArray) -> FloatArray | None:
    """Move interior vertices by little until no triangle is flipped.

    Triangle after triangle, each that is too small moves its corners along the gradient of its area, by the
    least motion that makes it large enough, until none is too small.

    Parameters
    ----------
    mesh : Mesh
    uv : ndarray of shape (V, 2) and dtype float
        Vertices in the disk; the boundary is on the circle in order.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float, or None
        Every triangle positive; None if that was not reached. A map without flipped triangles comes back as
        it is.

    References
    ----------
    The projection of a constraint, as in Müller et al., "Position based dynamics", 2007,
    doi:10.1016/j.jvcir.2007.01.005.
    """
    found = triangle_areas(uv[:, ::-1], mesh.triangles)
    if (found > _LEAST_AREA).all():
        return uv
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    least = _PUSHED * np.pi / areas.sum() * areas
    positive = found > _LEAST_AREA
    least[positive] = np.minimum(least, 0.5 * found)[positive]
    moved = uv.copy()
    return moved if _push_apart(moved, mesh.triangles, mesh.n_boundary, least) else None


@njit(cache=True, error_model="numpy")
def _push_apart(uv: FloatArray, triangles: IntArray, n_boundary: int, least: FloatArray) -> bool:
    """Whether all triangles became large enough; `uv` is changed."""
    gradient = np.empty((3, 2))
    for _ in range(_SWEEPS):
        done = True
        for t in range(triangles.shape[0]):
            size = 0.0
            for k in range(3):
                b, c = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
                gradient[k, 0] = 0.5 * (uv[b, 1] - uv[c, 1])
                gradient[k, 1] = 0.5 * (uv[c, 0] - uv[b, 0])
                if triangles[t, k] >= n_boundary:
                    size += gradient[k, 0] ** 2 + gradient[k, 1] ** 2
            a, c = triangles[t, 0], triangles[t, 2]
            area = gradient[2, 0] * (uv[c, 0] - uv[a, 0]) + gradient[2, 1] * (uv[c, 1] - uv[a, 1])
            if area >= least[t]:
                continue
            done = False
            if not size > 0.0:
                return False
            for k in range(3):
                vertex = triangles[t, k]
                if vertex >= n_boundary:
                    for axis in range(2):
                        uv[vertex, axis] += (_WANTED * least[t] - area) / size * gradient[k, axis]
        if done:
            return True
    return False
