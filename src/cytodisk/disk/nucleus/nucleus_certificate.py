"""The proof that a map with a nucleus is a bijection, compartment by compartment, from its arrays alone.

The cytoplasm is mapped onto a cylinder, (share, turn): its corners' turns, with whole turns added, agree
along every edge that two triangles share, so that the map is continuous. Where all triangles are positive and
the two border loops go once around their straight circles, the map has degree 1 and every point is reached
once. The nucleus is mapped onto a convex polygon, as a cell without a nucleus is. On the nuclear outline both
have the same angles, linear along each edge: together they are a bijection onto the disk.
"""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.certificate import (
    Certificate,
    boundary_faults,
    is_the_loop,
    malformed,
    mesh_faults,
    orientation_faults,
    runs_round_once,
)
from cytodisk.disk.nucleus.cone import MOST_LIFT, STEPS_A_TURN
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.geometry.exact import orientations
from cytodisk.geometry.half_edges import HalfEdges, half_edges

_SAME_PLACE = 1e-12


def certify_compartments(
    vertices_yx: FloatArray,
    vertices_uv: FloatArray,
    triangles: IntArray,
    boundary: IntArray,
    nucleus: Nucleus,
) -> Certificate:
    """Check every condition under which a map with a nucleus is a bijection.

    Parameters
    ----------
    vertices_yx, vertices_uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
    boundary : ndarray of shape (B,) and dtype int
    nucleus : Nucleus

    Returns
    -------
    Certificate
        Never raises for a bad map: it says what is wrong.
    """
    faults = malformed(vertices_yx, vertices_uv, triangles, boundary)
    if not faults:
        faults = _malformed_nucleus(len(vertices_yx), triangles, nucleus)
    if faults:
        return Certificate(faults, (), (), len(triangles), 0, 0)
    edges = half_edges(triangles, len(vertices_yx))
    in_cell, exact_cell = orientations(vertices_yx, triangles)
    in_disk, exact_disk = _in_disk(triangles, nucleus)
    found = orientation_faults(in_cell, in_disk)
    found += mesh_faults(edges)
    found += boundary_faults(vertices_yx, vertices_uv, edges, boundary)
    found += _loop_faults(triangles, boundary, nucleus)
    found += _cylinder_faults(triangles, boundary, nucleus)
    found += _circle_faults(vertices_uv, triangles, nucleus)
    return Certificate(
        faults=tuple(found),
        flipped_in_cell=tuple(np.flatnonzero(in_cell <= 0).tolist()),
        flipped_in_disk=tuple(np.flatnonzero(in_disk <= 0).tolist()),
        n_triangles=len(triangles),
        n_exact=exact_cell + exact_disk,
        euler_characteristic=edges.euler_characteristic,
    )


def _malformed_nucleus(n_vertices: int, triangles: IntArray, nucleus: Nucleus) -> tuple[str, ...]:
    faults = []
    places, boundary = nucleus.places, nucleus.boundary
    if places.shape != (n_vertices, 2) or not np.isfinite(places).all():
        faults.append("places of vertices are missing or not finite")
    if nucleus.inside.shape != (len(triangles),) or nucleus.inside.dtype != bool:
        faults.append("it is not told of all triangles whether they lie in the nucleus")
    if nucleus.lifts.shape != triangles.shape or nucleus.lifts.dtype.kind != "i":
        faults.append("whole turns of the triangles' corners are missing or not whole")
    if boundary.dtype.kind != "i":
        faults.append("vertices of the nuclear outline are not whole numbers")
    elif len(boundary) < 3 or boundary.min() < 0 or boundary.max() >= n_vertices:
        faults.append("the nuclear outline names a vertex that does not exist, or has less than three")
    if not faults and (nucleus.inside.all() or not nucleus.inside.any()):
        faults.append("a compartment has no triangle")
    if not 0.0 < nucleus.radius < 1.0:
        faults.append(f"the radius of the nucleus is {nucleus.radius}, not between 0 and 1")
    return tuple(faults)


def _in_disk(triangles: IntArray, nucleus: Nucleus) -> tuple[IntArray, int]:
    """Orientation of each triangle where it is mapped linearly, and how many were decided exactly."""
    corners = nucleus.corners(triangles)
    outer, exact_outer = orientations(corners.reshape(-1, 2), np.arange(3 * len(corners)).reshape(-1, 3))
    inner, exact_inner = orientations(nucleus.own_uv[:, ::-1], triangles[nucleus.inside])
    sign = np.empty(len(triangles), dtype=np.int64)
    sign[~nucleus.inside], sign[nucleus.inside] = outer, inner
    return sign, exact_outer + exact_inner


def _compartment(triangles: IntArray) -> tuple[HalfEdges, IntArray]:
    """Edges of some triangles with their vertices numbered anew, and the old numbers."""
    used, renumbered = np.unique(triangles, return_inverse=True)
    return half_edges(renumbered.reshape(-1, 3), len(used)), used


def _loop_faults(triangles: IntArray, boundary: IntArray, nucleus: Nucleus) -> list[str]:
    """Whether the nuclear outline divides the mesh into a disk and a ring around it."""
    faults = []
    inner, inner_used = _compartment(triangles[nucleus.inside])
    outer, outer_used = _compartment(triangles[~nucleus.inside])
    for name, edges, wanted in (("nucleus", inner, 1), ("cytoplasm", outer, 0)):
        if edges.euler_characteristic != wanted:
            faults.append(
                f"the Euler characteristic of the {name} is {edges.euler_characteristic}, not {wanted}"
            )
    backwards = nucleus.boundary[::-1]
    held = np.isin(nucleus.boundary, inner_used).all() and np.isin(nucleus.boundary, outer_used).all()
    if not held or not np.isin(boundary, outer_used).all():
        return [*faults, "an outline is not one of its compartment"]
    if not is_the_loop(inner, (np.searchsorted(inner_used, nucleus.boundary),)):
        faults.append("the nuclear outline is not the one border of the nucleus")
    loops = (np.searchsorted(outer_used, boundary), np.searchsorted(outer_used, backwards))
    if not is_the_loop(outer, loops):
        faults.append("membrane and nuclear outline are not the two borders of the cytoplasm")
    return faults


def _cylinder_faults(triangles: IntArray, boundary: IntArray, nucleus: Nucleus) -> list[str]:
    """Whether the cytoplasm's map is continuous, and takes its borders once around theirs."""
    faults = []
    ring, lifts = triangles[~nucleus.inside], nucleus.lifts[~nucleus.inside]
    start, end = ring.ravel(), np.roll(ring, -1, axis=1).ravel()
    rise = (np.roll(lifts, -1, axis=1) - lifts).ravel()
    many = int(triangles.max()) + 1
    order = np.argsort(start * many + end, kind="stable")
    key, rise = (start * many + end)[order], rise[order]
    back = np.searchsorted(key, (end * many + start)[order])
    shared = key[np.minimum(back, len(key) - 1)] == (end * many + start)[order]
    if (rise[back[shared]] != -rise[shared]).any():
        faults.append("turns of the cytoplasm's triangles do not agree along an edge")
    share, turn = nucleus.places.T
    for name, loop, level, way in (
        ("membrane", boundary, 0.0, 1),
        ("nuclear outline", nucleus.boundary, 1.0, -1),
    ):
        following = np.roll(loop, -1)
        edge = loop * many + following if way > 0 else following * many + loop
        lifted = way * rise[np.minimum(np.searchsorted(key, edge), len(key) - 1)]
        if (share[loop] != level).any():
            faults.append(f"the {name} is not at share {level:g}")
        if not (turn[following] - turn[loop] + lifted > 0.0).all() or lifted.sum() != 1:
            faults.append(f"turns of the {name} do not increase strictly through one turn")
    in_ring = np.unique(ring)
    if (share[in_ring] < 0.0).any() or (share[in_ring] > 1.0).any():
        faults.append("a share of the cytoplasm is below 0 or above 1")
    steps = turn[in_ring] * STEPS_A_TURN
    whole = (steps == np.rint(steps)) & (turn[in_ring] >= 0.0) & (turn[in_ring] < 1.0)
    if not whole.all() or np.abs(lifts).max() > MOST_LIFT:
        faults.append("whole turns cannot be added exactly to the turns of the cytoplasm")
    return faults


def _circle_faults(vertices_uv: FloatArray, triangles: IntArray, nucleus: Nucleus) -> list[str]:
    """Whether the nucleus' polygon goes once around its centre, and the disk shows what the places say."""
    faults = []
    gaps = np.mod(np.roll(nucleus.places[nucleus.boundary, 1], -1) - nucleus.places[nucleus.boundary, 1], 1.0)
    if not gaps.max() < 0.5 or not runs_round_once(nucleus.own_uv[nucleus.boundary]):
        faults.append(
            "the nuclear outline does not go around the centre of the disk in steps of less than half"
        )
    inner = np.zeros(len(vertices_uv), dtype=bool)
    inner[triangles[nucleus.inside]] = True
    inner[nucleus.boundary] = False
    if not np.abs(nucleus.in_disk(inner) - vertices_uv).max() <= _SAME_PLACE:
        faults.append("vertices in the disk are not where their places in the compartments put them")
    return faults
