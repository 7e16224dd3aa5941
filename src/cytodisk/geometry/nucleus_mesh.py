"""Outlines of cell and nucleus → one mesh of both, with the nuclear outline as edges."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import MeshError
from cytodisk.geometry.even_mesh import even_out
from cytodisk.geometry.flips import triangle_neighbours
from cytodisk.geometry.half_edges import half_edges
from cytodisk.geometry.lattice import graded_lattice
from cytodisk.geometry.mesh import Mesh, check_mesh
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.triangulation import triangulated


@dataclass(frozen=True)
class NucleusMesh(Mesh):
    """Triangulation of a cell in which the nuclear outline is a loop of edges.

    The first B vertices are the cell's outline, the next N the nuclear outline, both from +x towards +y.

    Attributes
    ----------
    vertices_yx : ndarray of shape (V, 2) and dtype float
        (row, column) in pixels.
    triangles : ndarray of shape (F, 3) and dtype int
        Every area is positive.
    n_boundary : int
        B, the number of vertices of the cell's outline.
    n_nucleus : int
        N, the number of vertices of the nuclear outline.
    inside : ndarray of shape (F,) and dtype bool
        Whether each triangle lies in the nucleus.
    """

    n_nucleus: int
    inside: BoolArray

    @property
    def nucleus_boundary(self) -> IntArray:
        """Indices of the nuclear outline's vertices in order, shape (N,)."""
        return np.arange(self.n_boundary, self.n_boundary + self.n_nucleus)

    @cached_property
    def vertex_inside(self) -> BoolArray:
        """Whether each vertex lies in the nucleus and not on its outline, shape (V,)."""
        found = np.zeros(len(self.vertices_yx), dtype=bool)
        found[self.triangles[self.inside]] = True
        found[: self.n_boundary + self.n_nucleus] = False
        return found


def mesh_with_nucleus(
    outline_yx: FloatArray,
    mask: BoolArray,
    nucleus: BoolArray,
    *,
    edge_length: float,
    growth: float = 0.5,
    clearance: float = 0.75,
) -> NucleusMesh:
    """Triangulate a cell with its nucleus, fine at both outlines and coarse between them and inside.

    No edge joins two vertices of outlines but the outlines' own: such edges are split at their middle.

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        As `trace_outline` returns it for the cell, (row, column) in pixels.
    mask, nucleus : ndarray of shape (H, W) and dtype bool
        Of the cell, and of the nucleus: one piece without holes whose pixels' neighbours are all in the cell.
    edge_length, growth, clearance : float
        As for `mesh_inside`.

    Returns
    -------
    NucleusMesh

    Raises
    ------
    MeshError
        The outlines cross, or an invariant does not hold: those of `mesh_inside`, and a nuclear outline
        that divides the mesh into a disk and a ring.
    """
    inner = trace_outline(nucleus)
    lattices = [
        graded_lattice(part, edge_length, growth, clearance, around=mask)
        for part in (mask & ~nucleus, nucleus)
    ]
    loops = len(outline_yx), len(inner)
    points, triangles = triangulated(np.concatenate([outline_yx, inner, *lattices]), loops)
    if growth > 0.0:
        points = even_out(points, triangles, sum(loops))
    inside = _within_loop_of(triangles, loops)
    order = np.argsort(inside, kind="stable")
    mesh = NucleusMesh(points, triangles[order], loops[0], loops[1], inside[order])
    check_mesh(mesh, outline_yx)
    _check_parts(mesh)
    return mesh


def _within_loop_of(triangles: IntArray, loops: tuple[int, int]) -> BoolArray:
    """Whether each triangle lies inside the second loop."""
    return np.asarray(_flood(np.ascontiguousarray(triangles), triangle_neighbours(triangles), *loops))


@njit(cache=True)
def _flood(triangles: IntArray, neighbours: IntArray, n_boundary: int, n_nucleus: int) -> BoolArray:
    inside = np.zeros(len(triangles), dtype=np.bool_)
    waiting = np.empty(len(triangles), dtype=np.int64)
    count, stop = 0, n_boundary + n_nucleus
    for t in range(len(triangles)):  # those that run along the loop in its direction
        for k in range(3):
            a, b = triangles[t, k], triangles[t, (k + 1) % 3]
            follows = b - a == 1 or (a == stop - 1 and b == n_boundary)
            if n_boundary <= a < stop and n_boundary <= b < stop and follows and not inside[t]:
                inside[t] = True
                waiting[count] = t
                count += 1
    while count > 0:
        count -= 1
        t = waiting[count]
        for k in range(3):
            a, b, across = triangles[t, k], triangles[t, (k + 1) % 3], neighbours[t, k]
            on_loop = n_boundary <= a < stop and n_boundary <= b < stop
            if across >= 0 and not on_loop and not inside[across]:
                inside[across] = True
                waiting[count] = across
                count += 1
    return inside


def _check_parts(mesh: NucleusMesh) -> None:
    """Raise a MeshError unless the nucleus' triangles are a disk and the others a ring around it."""
    for part, expected, name in ((mesh.inside, 1, "nucleus"), (~mesh.inside, 0, "cytoplasm")):
        used, renumbered = np.unique(mesh.triangles[part], return_inverse=True)
        edges = half_edges(renumbered.reshape(-1, 3), len(used))
        if edges.euler_characteristic != expected:
            raise MeshError(
                f"mesh of the {name} has the Euler characteristic {edges.euler_characteristic}, not "
                f"{expected}: the nuclear outline does not run once around inside the cell"
            )
