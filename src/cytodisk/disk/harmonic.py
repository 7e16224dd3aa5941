"""Interior → disk by a harmonic map with the boundary given (paper A.2.1 ii)."""

from typing import Literal

import numpy as np
from scipy import sparse

from cytodisk.arrays import FloatArray
from cytodisk.disk.ldl import Factorisation
from cytodisk.errors import MapError
from cytodisk.geometry.mesh import Mesh, hat_gradients, triangle_areas, triangle_edges

Weights = Literal["cotangent", "uniform"]


def harmonic_map(mesh: Mesh, boundary_uv: FloatArray) -> tuple[FloatArray, Weights]:
    """Positions in the disk with every interior vertex at the weighted mean of its neighbours.

    Cotangent weights give the conformal-like map of the paper, but can be negative, so that a triangle
    may turn over. Then the system is solved again with uniform positive weights, for which Tutte's
    theorem gives an embedding.

    Parameters
    ----------
    mesh : Mesh
        No interior edge may join two boundary vertices.
    boundary_uv : ndarray of shape (B, 2) and dtype float
        Boundary vertices on the circle, (u, v).

    Returns
    -------
    vertices_uv : ndarray of shape (V, 2) and dtype float
    weights : {"cotangent", "uniform"}
        Which weights the map was made with.

    Raises
    ------
    MapError
        Both maps turn a triangle over, which only rounding can cause.

    References
    ----------
    u-Unwrap, appendix A.2.1 (ii). Tutte, "How to draw a graph", 1963, doi:10.1112/plms/s3-13.1.743
    """
    choices: tuple[Weights, ...] = ("cotangent", "uniform")
    flipped = 0
    for weights in choices:
        edge_weights = _cotangents(mesh) if weights == "cotangent" else np.full(3 * len(mesh.triangles), 0.5)
        uv = _weighted_means(mesh, edge_weights, boundary_uv)
        flipped = int((~(triangle_areas(uv[:, ::-1], mesh.triangles) > 0)).sum())
        if not flipped:
            return uv, weights
    raise MapError(
        f"the harmonic map of this cell ({len(mesh.vertices_yx)} vertices) turns {flipped} triangles over in "
        "double precision: the cell is too branched for its size; try a larger edge_length"
    )


def harmonic_extension(mesh: Mesh, boundary_values: FloatArray) -> FloatArray:
    """Values at all vertices that are harmonic inside and given at the boundary.

    Parameters
    ----------
    mesh : Mesh
    boundary_values : ndarray of shape (B, 2) and dtype float
        Two numbers a boundary vertex, such as a displacement.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    return _weighted_means(mesh, _cotangents(mesh), boundary_values)


def _cotangents(mesh: Mesh) -> FloatArray:
    """Half the cotangent opposite each edge of each triangle, in the order of `triangle_edges`."""
    hats = hat_gradients(mesh.vertices_yx, mesh.triangles)
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    return np.concatenate([-areas * (hats[:, k] * hats[:, (k + 1) % 3]).sum(axis=1) for k in range(3)])


def _weighted_means(mesh: Mesh, edge_weights: FloatArray, boundary_uv: FloatArray) -> FloatArray:
    n_vertices, n_boundary = len(mesh.vertices_yx), mesh.n_boundary
    start, stop = triangle_edges(mesh.triangles).T
    half = sparse.csr_matrix((edge_weights, (start, stop)), shape=(n_vertices, n_vertices))
    adjacency = half + half.T
    inner = adjacency[n_boundary:]
    laplacian = sparse.diags_array(np.asarray(inner.sum(axis=1)).ravel()) - inner[:, n_boundary:]
    factors = Factorisation(sparse.csc_matrix(sparse.triu(laplacian)))
    right = inner[:, :n_boundary] @ boundary_uv
    interior = [factors.solve(np.ascontiguousarray(right[:, axis])) for axis in (0, 1)]
    return np.concatenate([boundary_uv, np.column_stack(interior)])
