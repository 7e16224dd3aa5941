"""A meshed cell with its nucleus → the map of both."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.harmonic import Weights, harmonic_map
from cytodisk.disk.nucleus.compartment_newton import relax_compartments
from cytodisk.disk.nucleus.cone import STEPS_A_TURN, TURN
from cytodisk.disk.nucleus.cylinder_start import CylinderMap, cylinder_start
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.disk.nucleus.nucleus_guide import NucleusGuide, anchor_places
from cytodisk.disk.relaxed import Relaxed
from cytodisk.geometry.mesh import Mesh, triangle_areas
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.geometry.placed_mask import PlacedMask


class FittedNucleus(NamedTuple):
    """A nucleus that fits its cell.

    Attributes
    ----------
    placed_mask : PlacedMask
    report : NucleusReport
    centre : ndarray of shape (2,) and dtype float
        A place well inside it, in the frame of the cell's box.
    """

    placed_mask: PlacedMask
    report: NucleusReport
    centre: FloatArray


class MappedCompartments(NamedTuple):
    """A cell with its nucleus on the disk.

    Attributes
    ----------
    relaxed : Relaxed
    start : {"cotangent", "uniform", "previous"}
    nucleus : Nucleus
    twist : float
        How far the nucleus has turned against the membrane, in radians; see `CylinderMap`.
    unwound : bool
        Whether a whole turn was taken back since the frame before.
    """

    relaxed: Relaxed
    start: Literal["cotangent", "uniform", "previous"]
    nucleus: Nucleus
    twist: float = 0.0
    unwound: bool = False


def map_compartments(
    mesh: NucleusMesh,
    fitted: FittedNucleus,
    angles: FloatArray,
    shape_weight: float,
    nucleus_radius: float | Literal["area"],
    guide: NucleusGuide | None = None,
    system: BlockSystem | None = None,
) -> MappedCompartments:
    """Map a cell and its nucleus onto the disk, with the membrane at given angles.

    Parameters
    ----------
    mesh : NucleusMesh
    fitted : FittedNucleus
    angles : ndarray of shape (B,) and dtype float
        Of the membrane in radians, strictly increasing, all within one turn.
    shape_weight : float
    nucleus_radius : float or "area"
        "area": the nucleus has its own share of the disk.
    guide : NucleusGuide, optional
        Of the frame before in a movie; without it the nuclear outline slides to where it is mapped best.
    system : BlockSystem, optional
        Of this mesh, if there is one already.

    Returns
    -------
    MappedCompartments

    Raises
    ------
    MapError
        No valid start was found.
    """
    system = system or BlockSystem(mesh)
    radius = _own_radius(mesh) if nucleus_radius == "area" else float(nucleus_radius)
    given = () if guide is None else (guide.angles, guide.twist)
    start = cylinder_start(mesh, angles, fitted.centre, system, *given)
    inner = mesh.nucleus_boundary
    circle = np.column_stack([np.cos(start.angles[inner]), np.sin(start.angles[inner])])
    vertices, uv, weights = _nucleus_start(mesh, circle)
    half = 0.5 * (1.0 - radius**2)
    places = np.column_stack([start.angles, half * start.depth])
    places[vertices] = uv
    unwound = guide is not None and abs(start.twist - guide.twist) > 0.5 * TURN
    anchored = None
    if guide is not None and guide.inertia and not unwound:
        anchored = anchor_places(mesh, guide, places, half), guide.inertia
    relaxed = relax_compartments(
        mesh, places, start.lifts, radius, shape_weight, system, anchored=anchored, slide=guide is None
    )
    turned, lifts = _in_turns(mesh, relaxed.vertices_uv, start, half)
    nucleus = Nucleus(radius, inner, mesh.inside, turned, lifts, fitted.placed_mask, fitted.report)
    uv = nucleus.in_disk(mesh.vertex_inside)
    worse: Weights = "uniform" if "uniform" in (weights, start.weights) else "cotangent"
    made = Relaxed(uv, relaxed.steps, relaxed.converged)
    return MappedCompartments(made, worse, nucleus, start.twist, unwound)


def _own_radius(mesh: NucleusMesh) -> float:
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    return float(np.sqrt(areas[mesh.inside].sum() / areas.sum()))


def _nucleus_start(mesh: NucleusMesh, circle: FloatArray) -> tuple[IntArray, FloatArray, Weights]:
    """Vertices inside the nucleus, and where its own harmonic map has them in its own disk."""
    vertices = np.flatnonzero(mesh.vertex_inside)
    used = np.concatenate([mesh.nucleus_boundary, vertices])
    number = np.empty(len(mesh.vertices_yx), dtype=np.int64)
    number[used] = np.arange(len(used))
    own = Mesh(mesh.vertices_yx[used], number[mesh.triangles[mesh.inside]], mesh.n_nucleus)
    uv, weights = harmonic_map(own, circle)
    return vertices, uv[mesh.n_nucleus :], weights


def _in_turns(
    mesh: NucleusMesh, places: FloatArray, start: CylinderMap, half: float
) -> tuple[FloatArray, IntArray]:
    """Places as (share, turn) in the cytoplasm, and the lifts of turns from 0 to 1."""
    outer = ~mesh.vertex_inside
    steps = np.round(places[:, 0] / TURN * STEPS_A_TURN)
    whole = np.floor(steps / STEPS_A_TURN)
    turned = places.copy()
    turned[outer, 0] = np.clip(places[outer, 1] / half, 0.0, 1.0)
    turned[outer, 1] = steps[outer] / STEPS_A_TURN - whole[outer]
    turned[: mesh.n_boundary, 0], turned[mesh.nucleus_boundary, 0] = 0.0, 1.0
    lifts = start.lifts + whole[mesh.triangles].astype(np.int64)
    lifts -= lifts.min(axis=1, keepdims=True)  # in an arm that winds around the nucleus they may be many
    lifts[mesh.inside] = 0
    return turned, lifts
