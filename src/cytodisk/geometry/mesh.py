"""Outline → mesh: a triangulation of the cell's inside that is fit to be mapped."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import MeshError
from cytodisk.geometry.even_mesh import even_out
from cytodisk.geometry.half_edges import HalfEdges, half_edges
from cytodisk.geometry.lattice import graded_lattice
from cytodisk.geometry.polygon import signed_area
from cytodisk.geometry.triangulation import triangulated

_AREA_TOLERANCE = 1e-9


@dataclass(frozen=True)
class Mesh:
    """Triangulation of a topological disk.

    The first B vertices are the outline's, in its order: vertex_yx[:B] is the boundary loop.

    Attributes
    ----------
    vertices_yx : ndarray of shape (V, 2) and dtype float
        (row, column) in pixels.
    triangles : ndarray of shape (F, 3) and dtype int
        Vertex indices, from +x towards +y: every area is positive.
    n_boundary : int
        B, the number of boundary vertices.
    """

    vertices_yx: FloatArray
    triangles: IntArray
    n_boundary: int

    @cached_property
    def half_edges(self) -> HalfEdges:
        """Its edges, each in the directions in which triangles run along it."""
        return half_edges(self.triangles, len(self.vertices_yx))

    @property
    def boundary(self) -> IntArray:
        """Indices of the boundary vertices in order, shape (B,)."""
        return np.arange(self.n_boundary)


def mesh_inside(
    outline_yx: FloatArray,
    mask: BoolArray,
    *,
    edge_length: float,
    growth: float = 0.5,
    clearance: float = 0.75,
) -> Mesh:
    """Triangulate the inside of an outline, fine at the edge and coarse inside.

    Every outline point is a boundary vertex. No interior edge joins two boundary vertices: such edges are
    split at their middle, for a triangle with three pinned corners could never change its area, and
    Tutte's theorem, which vouches for the harmonic map, asks for it. A mirrored mask gets the mirrored mesh.

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        As `trace_outline` returns it, (row, column) in pixels.
    mask : ndarray of shape (H, W) and dtype bool
        The mask that the outline was traced around.
    edge_length : float
        Spacing of interior vertices at the edge, in pixels.
    growth : float
        How much the spacing grows for each pixel of depth; 0 for triangles of one size.
    clearance : float
        Smallest depth of a vertex of the lattice, in units of `edge_length`.

    Returns
    -------
    Mesh

    Raises
    ------
    MeshError
        An invariant does not hold: Euler characteristic 1, every vertex used, all areas positive, sum of
        areas equal to the outline's to 1e-9.
    """
    points = np.concatenate([outline_yx, graded_lattice(mask, edge_length, growth, clearance)])
    n_boundary = len(outline_yx)
    points, triangles = triangulated(points, (n_boundary,))
    if growth > 0.0:
        points = even_out(points, triangles, n_boundary)
    mesh = Mesh(points, triangles, n_boundary)
    check_mesh(mesh, outline_yx)
    return mesh


def triangle_areas(points_ab: FloatArray, triangles: IntArray) -> FloatArray:
    """Signed area of each triangle, for points (row, column) or for points (v, u).

    Parameters
    ----------
    points_ab : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int

    Returns
    -------
    ndarray of shape (F,) and dtype float
        Positive from +x towards +y.
    """
    return np.asarray(_areas(np.ascontiguousarray(points_ab), np.ascontiguousarray(triangles)))


@njit(cache=True)
def _areas(points: FloatArray, triangles: IntArray) -> FloatArray:
    areas = np.empty(len(triangles))
    for t in range(len(triangles)):
        a, b, c = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        ab_0, ab_1 = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1]
        ac_0, ac_1 = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1]
        areas[t] = 0.5 * (ab_1 * ac_0 - ab_0 * ac_1)
    return areas


def hat_gradients(vertices_yx: FloatArray, triangles: IntArray) -> FloatArray:
    """Gradient (d/dx, d/dy) of each triangle's three hat functions, 1 at one corner and 0 at the others.

    Parameters
    ----------
    vertices_yx : ndarray of shape (V, 2) and dtype float
        (row, column) in pixels.
    triangles : ndarray of shape (F, 3) and dtype int
        All areas positive.

    Returns
    -------
    ndarray of shape (F, 3, 2) and dtype float
        In 1 / pixel.
    """
    return np.asarray(_hats(vertices_yx, triangles))


@njit(cache=True, error_model="numpy")
def _hats(vertices_yx: FloatArray, triangles: IntArray) -> FloatArray:
    hats = np.empty((triangles.shape[0], 3, 2))
    for t in range(triangles.shape[0]):
        for k in range(3):  # across the side opposite to the corner
            b, c = triangles[t, (k + 1) % 3], triangles[t, (k + 2) % 3]
            hats[t, k, 0] = vertices_yx[b, 0] - vertices_yx[c, 0]
            hats[t, k, 1] = vertices_yx[c, 1] - vertices_yx[b, 1]
        twice = hats[t, 1, 0] * hats[t, 2, 1] - hats[t, 1, 1] * hats[t, 2, 0]
        for k in range(3):
            hats[t, k, 0] /= twice
            hats[t, k, 1] /= twice
    return hats


def check_mesh(mesh: Mesh, outline_yx: FloatArray) -> None:
    """Raise a MeshError if an invariant of `mesh_inside` does not hold."""
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    edges = mesh.half_edges
    faults = []
    if edges.euler_characteristic != 1:
        faults.append("its Euler characteristic is not 1")
    if not edges.all_used:
        faults.append("a vertex belongs to no triangle")
    if not areas.min() > 0:
        faults.append(f"{len(areas) - (areas > 0).sum()} triangles have no area")
    outline_area = signed_area(outline_yx)
    if not abs(areas.sum() - outline_area) <= _AREA_TOLERANCE * outline_area:
        faults.append(f"its area {areas.sum()} is not the outline's {outline_area}")
    if faults:
        raise MeshError(f"mesh of the outline ({len(outline_yx)} points) is not a disk: {'; '.join(faults)}")
