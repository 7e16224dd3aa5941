"""Mend a nearly valid map: the surroundings of flipped triangles are laid out anew."""

import numpy as np
from scipy import sparse

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.ldl import Factorisation
from cytodisk.geometry.mesh import Mesh, triangle_areas, triangle_edges

_LEAST_AREA = 1e-10  # of a triangle in the disk that a relaxation may start from
_ROUNDS = 8


def untangled(mesh: Mesh, uv: FloatArray) -> FloatArray | None:
    """Move interior vertices around flipped triangles to the mean of their neighbours, until none is left.

    Each round takes in one more ring of vertices around what is still flipped; all others stay.

    Parameters
    ----------
    mesh : Mesh
    uv : ndarray of shape (V, 2) and dtype float
        Vertices in the disk; the boundary is on the circle in order.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float, or None
        Every triangle positive; None if that was not reached.
    """
    start, stop = triangle_edges(mesh.triangles).T
    n = len(uv)
    half = sparse.csr_matrix((np.ones(len(start)), (start, stop)), shape=(n, n))
    joined = ((half + half.T) > 0).astype(np.float64).tocsr()
    free = np.zeros(n, dtype=bool)
    for _ in range(_ROUNDS):
        flipped = ~(triangle_areas(uv[:, ::-1], mesh.triangles) > _LEAST_AREA)
        if not flipped.any():
            return uv
        free[mesh.triangles[flipped]] = True
        free = (joined @ free.astype(np.float64)) + free > 0
        free[: mesh.n_boundary] = False
        uv = _neighbour_means(joined, uv, free)
    return None


def _neighbour_means(joined: sparse.csr_matrix, uv: FloatArray, free: BoolArray) -> FloatArray:
    rows = joined[free]
    laplacian = sparse.diags_array(np.asarray(rows.sum(axis=1)).ravel()) - rows[:, free]
    factors = Factorisation(sparse.csc_matrix(sparse.triu(laplacian)))
    right = rows[:, ~free] @ uv[~free]
    moved = uv.copy()
    moved[free] = np.column_stack([factors.solve(np.ascontiguousarray(right[:, k])) for k in (0, 1)])
    return moved
