"""Interior → disk by a harmonic map with the boundary given (paper A.2.1 ii)."""

from typing import Literal

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.errors import MapError
from cytodisk.geometry.mesh import Mesh, hat_gradients, triangle_areas

Weights = Literal["cotangent", "uniform"]


def harmonic_map(
    mesh: Mesh, boundary_uv: FloatArray, system: BlockSystem | None = None
) -> tuple[FloatArray, Weights]:
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
    system : BlockSystem, optional
        Of this mesh, if there is one already.

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
    system = system or BlockSystem(mesh)
    choices: tuple[Weights, ...] = ("cotangent", "uniform")
    flipped = 0
    for weights in choices:
        edge_weights = cotangents(mesh) if weights == "cotangent" else np.full(3 * len(mesh.triangles), 0.5)
        uv = weighted_means(mesh, edge_weights, boundary_uv, system)
        flipped = int((~(triangle_areas(uv[:, ::-1], mesh.triangles) > 0)).sum())
        if not flipped:
            return uv, weights
    raise MapError(
        f"the harmonic map of this cell ({len(mesh.vertices_yx)} vertices) turns {flipped} triangles over in "
        "double precision: the cell is too branched for its size; try a larger edge_length"
    )


def harmonic_extension(
    mesh: Mesh, boundary_values: FloatArray, system: BlockSystem | None = None
) -> FloatArray:
    """Values at all vertices that are harmonic inside and given at the boundary.

    Parameters
    ----------
    mesh : Mesh
    boundary_values : ndarray of shape (B, 2) and dtype float
        Two numbers a boundary vertex, such as a displacement.
    system : BlockSystem, optional
        Of this mesh, if there is one already.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    return weighted_means(mesh, cotangents(mesh), boundary_values, system or BlockSystem(mesh))


def fading_extension(
    mesh: Mesh, boundary_values: FloatArray, fade_px: float, system: BlockSystem | None = None
) -> FloatArray:
    """Values at all vertices that are given at the boundary and fade inwards, as exp(-depth / fade).

    Solves f = fade² Δf (the screened Laplace equation).

    Parameters
    ----------
    mesh : Mesh
    boundary_values : ndarray of shape (B, 2) and dtype float
        Two numbers a boundary vertex, such as a displacement.
    fade_px : float
        In the unit of the mesh.
    system : BlockSystem, optional
        Of this mesh, if there is one already.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    pull = vertex_areas(mesh) / fade_px**2
    return weighted_means(mesh, cotangents(mesh), boundary_values, system or BlockSystem(mesh), pull)


def vertex_areas(mesh: Mesh) -> FloatArray:
    """A third of the triangles around each vertex, shape (V,); the sum is the area of the mesh."""
    corner_area = np.repeat(triangle_areas(mesh.vertices_yx, mesh.triangles) / 3.0, 3)
    return np.asarray(np.bincount(mesh.triangles.ravel(), corner_area, minlength=len(mesh.vertices_yx)))


def cotangents(mesh: Mesh) -> FloatArray:
    """Half the cotangent opposite each edge of each triangle, edge k → k + 1 of triangle t in row k F + t."""
    hats = hat_gradients(mesh.vertices_yx, mesh.triangles)
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    x, y = np.ascontiguousarray(hats.transpose(2, 1, 0))
    return np.concatenate([-areas * (x[k] * x[(k + 1) % 3] + y[k] * y[(k + 1) % 3]) for k in range(3)])


def weighted_means(
    mesh: Mesh,
    edge_weights: FloatArray,
    boundary_uv: FloatArray,
    system: BlockSystem,
    pull_to_zero: FloatArray | None = None,
) -> FloatArray:
    """Positions with every interior vertex at the weighted mean of its neighbours.

    Parameters
    ----------
    mesh : Mesh
    edge_weights : ndarray of shape (3 F,) and dtype float
        Of edge k → k + 1 of triangle t in entry k F + t; an edge has the sum of what its triangles give it.
    boundary_uv : ndarray of shape (B, 2) and dtype float
    system : BlockSystem
        Of this mesh; u and v are two copies of one system.
    pull_to_zero : ndarray of shape (V,) and dtype float, optional
        Weight of a neighbour at zero that each vertex has besides.

    Returns
    -------
    ndarray of shape (V, 2) and dtype float
    """
    out = np.zeros((len(mesh.vertices_yx), 2))
    out[: mesh.n_boundary] = boundary_uv
    weights = edge_weights.reshape(3, -1)
    right = np.zeros((len(system.vertex), 2))
    fill_laplacian(mesh.triangles, weights, out, system.unknown, system.place, system.blocks, right)
    if pull_to_zero is not None:
        for axis in (0, 1):
            system.blocks[system.diagonal, axis, axis] += pull_to_zero[system.vertex]
    system.factorise()
    out[system.vertex] = system.solve(right)
    return out


@njit(cache=True)
def fill_laplacian(
    triangles: IntArray,
    weights: FloatArray,
    boundary_uv: FloatArray,
    unknown: IntArray,
    place: IntArray,
    blocks: FloatArray,
    right: FloatArray,
) -> None:
    """Laplacian on the unknown vertices, and on the right what the given ones add."""
    blocks[:] = 0.0
    for t in range(triangles.shape[0]):
        for k in range(3):
            l = (k + 1) % 3
            weight = weights[k, t]
            for own, other in ((k, l), (l, k)):
                n = unknown[triangles[t, own]]
                if n < 0:
                    continue
                for axis in range(2):
                    blocks[place[t, own, own], axis, axis] += weight
                    if place[t, own, other] >= 0:
                        blocks[place[t, own, other], axis, axis] -= weight
                    elif unknown[triangles[t, other]] < 0:
                        right[n, axis] += weight * boundary_uv[triangles[t, other], axis]
