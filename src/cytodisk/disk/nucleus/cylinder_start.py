"""Cytoplasm → cylinder: a one-to-one map to start from, whatever the outlines.

The cytoplasm is a ring between membrane and nuclear outline. On it a function g is harmonic, 0 at the
membrane and 1 at the nucleus, and the angle θ is harmonic with one turn around the nucleus, given at the
membrane. With positive weights, the same for both, (θ, g) is one to one, with θ free at the nucleus or given
there: Tutte's theorem on the cylinder. Where θ is free, mirror the mesh across the nuclear outline: by
symmetry the map of both halves, with θ given on either membrane, has the outline on a straight circle.

In arms g falls exponentially, and 1 - g in narrow bays of the nucleus: `even_depth` takes another function.

References
----------
Gortler, Gotsman & Thurston, "Discrete one-forms on meshes and applications to 3D mesh parameterization",
2006, doi:10.1016/j.cagd.2005.05.002.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.harmonic import Weights, cotangents
from cytodisk.disk.nucleus.cone import TURN
from cytodisk.disk.nucleus.even_depth import POWERS, reweighted, reweighted_at_both_ends
from cytodisk.disk.nucleus.outline_angles import (
    mean_along,
    well_spaced,
    wound_like,
)
from cytodisk.errors import MapError
from cytodisk.geometry.nucleus_mesh import NucleusMesh


class CylinderMap(NamedTuple):
    """A map of the cytoplasm onto a cylinder.

    Attributes
    ----------
    angles : ndarray of shape (V,) and dtype float
        θ in radians of each vertex of the cytoplasm, up to whole turns; 0 in the nucleus.
    depth : ndarray of shape (V,) and dtype float
        0 at the membrane, 1 at the nuclear outline and in the nucleus.
    lifts : ndarray of shape (F, 3) and dtype int
        Whole turns to add to the angles of each triangle's corners, so that they fit together; 0 in the
        nucleus.
    weights : {"cotangent", "uniform"}
    twist : float
        How far given angles of the nuclear outline are from free ones in radians, whole turns included; 0
        where they are free.
    """

    angles: FloatArray
    depth: FloatArray
    lifts: IntArray
    weights: Weights
    twist: float


def lifted_angles(angles: FloatArray, lifts: IntArray, triangles: IntArray) -> FloatArray:
    """Angles of the corners of triangles, shape (F, 3), which differ within a triangle as the map does."""
    return np.asarray(angles[triangles] + TURN * lifts)


def cylinder_areas(angles: FloatArray, depth: FloatArray, lifts: IntArray, triangles: IntArray) -> FloatArray:
    """Signed area of triangles on the cylinder (θ, depth), positive as in the cell, shape (F,)."""
    return np.asarray(_areas(lifted_angles(angles, lifts, triangles), depth[triangles]))


def cylinder_start(
    mesh: NucleusMesh,
    membrane_angles: FloatArray,
    centre_yx: FloatArray,
    system: BlockSystem,
    nucleus_angles: FloatArray | None = None,
    twist: float = 0.0,
) -> CylinderMap:
    """Map the cytoplasm one to one onto the cylinder, with the membrane at given angles.

    Parameters
    ----------
    mesh : NucleusMesh
    membrane_angles : ndarray of shape (B,) and dtype float
        In radians, strictly increasing, all within one turn.
    centre_yx : ndarray of shape (2,) and dtype float
        A point strictly inside the nuclear outline.
    system : BlockSystem
        Of this mesh.
    nucleus_angles : ndarray of shape (N,) and dtype float, optional
        Angles of the nuclear outline, strictly increasing within one turn, up to whole turns; by default θ is
        free there.
    twist : float
        That of the frame before, where angles are given: whole turns are counted so that they go on from it.
        From three quarters of a turn on one is taken back, so that the cytoplasm between an outline that
        turns and one that does not is not wound up without end.

    Returns
    -------
    CylinderMap
        With `depth` a power of g.

    Raises
    ------
    MapError
        Rounding turns triangles over with all weights.
    """
    problem = _Problem(mesh, _Form.around(mesh, centre_yx), system, membrane_angles, nucleus_angles, twist)
    choices: tuple[Weights, ...] = ("cotangent", "uniform")
    for weights in choices:
        edge_weights = cotangents(mesh) if weights == "cotangent" else _uniform(mesh)
        for power in POWERS:
            found = _solved(problem, edge_weights, power)
            if found is not None:
                return CylinderMap(*found[:3], weights, found[3])
    for power in POWERS:
        found = _solved(problem, _uniform(mesh), power, both_ends=True)
        if found is not None:
            return CylinderMap(*found[:3], "uniform", found[3])
    raise MapError(
        f"no map of the cytoplasm was found ({len(mesh.vertices_yx)} vertices): in double precision "
        "triangles turn over; the nucleus or the cell is too branched for its size; correct the masks, or "
        "try a larger edge_length"
    )


def _uniform(mesh: NucleusMesh) -> FloatArray:
    return np.full(3 * len(mesh.triangles), 0.5)


class _Form(NamedTuple):
    """The angle around a point in the nucleus.

    Attributes
    ----------
    angles : ndarray of shape (V,) and dtype float
        From -π to π.
    steps : ndarray of shape (F, 3) and dtype float
        From corner k to corner k + 1 of each triangle, from -π to π; their sum is 0 in the cytoplasm.
    """

    angles: FloatArray
    steps: FloatArray

    @classmethod
    def around(cls, mesh: NucleusMesh, centre_yx: FloatArray) -> _Form:
        away = mesh.vertices_yx - centre_yx
        angles = np.arctan2(away[:, 0], away[:, 1])
        corners = angles[mesh.triangles]
        return cls(angles, _wrapped(np.roll(corners, -1, axis=1) - corners))

    def around_loop(self, loop: IntArray) -> FloatArray:
        """Angles along a loop around the point, without jumps."""
        return np.asarray(
            self.angles[loop[0]] + np.append(0.0, np.cumsum(_wrapped(np.diff(self.angles[loop]))))
        )


def _wrapped(angles: FloatArray) -> FloatArray:
    return np.asarray(angles - TURN * np.round(angles / TURN))


class _Problem(NamedTuple):
    """What a map of the cytoplasm is asked for."""

    mesh: NucleusMesh
    form: _Form
    system: BlockSystem
    membrane_angles: FloatArray
    nucleus_angles: FloatArray | None
    twist: float


def _solved(
    problem: _Problem, edge_weights: FloatArray, power: float, both_ends: bool = False
) -> tuple[FloatArray, FloatArray, IntArray, float] | None:
    """θ, a power of g, lifts and twist; None if a triangle is not positive."""
    mesh, form, system, membrane_angles, nucleus_angles, twist = problem
    given = np.full(len(mesh.vertices_yx), np.nan)
    given[mesh.boundary] = membrane_angles - form.around_loop(mesh.boundary)
    inner = mesh.nucleus_boundary
    around = form.around_loop(inner)
    angles, g = _harmonic(mesh, form, edge_weights, given, system)
    at_nucleus, wound = angles[inner] - form.angles[inner] + around, 0.0
    if nucleus_angles is not None:
        away = mean_along(mesh, nucleus_angles - at_nucleus)
        wound = wound_like(away, twist)
        at_nucleus = nucleus_angles + wound - away
    given[inner] = well_spaced(mesh, at_nucleus) - around
    if both_ends:
        _, rest = _harmonic(mesh, form, edge_weights, given, system, ends=(1.0, 0.0))
        weights = reweighted_at_both_ends(mesh, edge_weights, g, rest, power)
    else:
        weights = reweighted(mesh, edge_weights, g, np.maximum(g, 0.0) ** power)
    angles, depth = _harmonic(mesh, form, weights, given, system)
    lifts = _lifts(mesh, form, angles)
    areas = cylinder_areas(angles, depth, lifts, mesh.triangles)[~mesh.inside]
    return (angles, depth, lifts, wound) if (areas > 0.0).all() else None


def _lifts(mesh: NucleusMesh, form: _Form, angles: FloatArray) -> IntArray:
    """Whole turns that make the corners' angles differ as the form with what is single-valued of θ does."""
    own = (angles - form.angles)[mesh.triangles]
    one = form.steps[:, 0] + own[:, 1] - own[:, 0]
    two = -form.steps[:, 2] + own[:, 2] - own[:, 0]
    corners = angles[mesh.triangles]
    lifts = np.zeros((len(mesh.triangles), 3), dtype=np.int64)
    lifts[:, 1] = np.round((one - (corners[:, 1] - corners[:, 0])) / TURN)
    lifts[:, 2] = np.round((two - (corners[:, 2] - corners[:, 0])) / TURN)
    lifts[mesh.inside] = 0
    return lifts


def _harmonic(
    mesh: NucleusMesh,
    form: _Form,
    edge_weights: FloatArray,
    given: FloatArray,
    system: BlockSystem,
    ends: tuple[float, float] = (0.0, 1.0),
) -> tuple[FloatArray, FloatArray]:
    """θ and g of all vertices; `given` holds θ less the form's angle, `ends` g at membrane and nucleus."""
    n_vertices = len(mesh.vertices_yx)
    values = np.zeros((n_vertices, 2))
    values[:, 0] = np.where(np.isnan(given), 0.0, given)
    values[mesh.boundary, 1], values[mesh.nucleus_boundary, 1] = ends
    pinned = np.zeros((n_vertices, 2), dtype=bool)
    pinned[mesh.vertex_inside] = True
    pinned[:, 0] |= ~np.isnan(given)
    pinned[: mesh.n_boundary + mesh.n_nucleus, 1] = True
    right = np.zeros((len(system.vertex), 2))
    weights = edge_weights.reshape(3, -1)
    arrays = mesh.triangles, mesh.inside, weights, form.steps, values, pinned
    _fill(*arrays, (system.unknown, system.place), (system.blocks, right))
    pins = pinned[system.vertex]
    for axis in (0, 1):
        system.blocks[system.diagonal[pins[:, axis]], axis, axis] = 1.0
    right = np.where(pins, values[system.vertex], right)
    system.factorise()
    values[system.vertex] = system.solve(right)
    angles, g = values[:, 0] + form.angles, values[:, 1]
    angles[mesh.vertex_inside], g[mesh.vertex_inside] = 0.0, ends[1]
    return angles, g


@njit(cache=True)
def _fill(
    triangles: IntArray,
    inside: BoolArray,
    weights: FloatArray,
    steps: FloatArray,
    values: FloatArray,
    pinned: BoolArray,
    pattern: tuple[IntArray, IntArray],
    filled: tuple[FloatArray, FloatArray],
) -> None:
    """Laplacians of θ less the form's angle (axis 0), and of g (axis 1), on the cytoplasm's triangles."""
    (unknown, place), (blocks, right) = pattern, filled
    blocks[:] = 0.0
    for t in range(triangles.shape[0]):
        if inside[t]:
            continue
        for k in range(3):
            l = (k + 1) % 3
            weight = weights[k, t]
            for own, other, step in ((k, l, steps[t, k]), (l, k, -steps[t, k])):
                i, j = triangles[t, own], triangles[t, other]
                n = unknown[i]
                if n < 0:
                    continue
                for axis in range(2):
                    if pinned[i, axis]:
                        continue
                    blocks[place[t, own, own], axis, axis] += weight
                    if axis == 0:
                        right[n, 0] += weight * step
                    if pinned[j, axis]:
                        right[n, axis] += weight * values[j, axis]
                    elif place[t, own, other] >= 0:
                        blocks[place[t, own, other], axis, axis] -= weight


@njit(cache=True)
def _areas(angles: FloatArray, depth: FloatArray) -> FloatArray:
    areas = np.empty(len(angles))
    for t in range(len(angles)):
        x1, y1 = angles[t, 1] - angles[t, 0], depth[t, 1] - depth[t, 0]
        x2, y2 = angles[t, 2] - angles[t, 0], depth[t, 2] - depth[t, 0]
        areas[t] = 0.5 * (x1 * y2 - x2 * y1)
    return areas
