"""Equiareal relaxation of a cell with its nucleus, compartment by compartment (design of this package).

The steps are those of `disk.newton`, the energy is that of `compartment_energy`: a barrier, so that from a
valid start no accepted step leaves the valid maps. The nuclear outline slides along its circle until the two
compartments agree where it is best.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.newton import DECREMENT, GaussNewton, descended
from cytodisk.disk.nucleus.compartment_energy import (
    CompartmentElements,
    compartment_energy,
    fill_compartments,
    largest_compartment_step,
)
from cytodisk.disk.nucleus.cone import TURN
from cytodisk.disk.nucleus.outline_steps import add_loop, loop_energy
from cytodisk.disk.pressure_blocks import PressureSystem
from cytodisk.disk.relaxed import Relaxed
from cytodisk.disk.vertex_energy import shared_out
from cytodisk.geometry.mesh import hat_gradients, triangle_areas
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.geometry.polygon import arc_lengths

_HOLDS = 2  # times a step is computed anew
_SOON = 0.3  # of a step, at which a triangle would turn over
_WORTH = 0.03  # of what the step saves, that is left without them at least
_HOLD = 1e3  # times its diagonal that a vertex which is held has more
_OUTLINE = 1.0  # weight of the steps of the nuclear outline, over that of shape
_CORE = 0.3  # radius in the nucleus' own disk within which a step turns vertices less


def relax_compartments(
    mesh: NucleusMesh,
    start: FloatArray,
    lifts: IntArray,
    radius: float,
    shape_weight: float,
    system: BlockSystem,
    *,
    anchored: tuple[FloatArray, float] | None = None,
    slide: bool = True,
) -> Relaxed:
    """Move vertices of a valid map until each has its share of the area of its compartment.

    Parameters
    ----------
    mesh : NucleusMesh
    start : ndarray of shape (V, 2) and dtype float
        Of the cytoplasm and the nuclear outline (θ, p), p = (1 - r²) / 2; inside the nucleus (u, v) of its
        own unit disk. Every triangle positive; the membrane stays where it is.
    lifts : ndarray of shape (F, 3) and dtype int
        Whole turns to add to the angles of corners.
    radius : float
        Of the nucleus in the disk.
    shape_weight : float
        Weight of shape against area in the energy; > 0.
    system : BlockSystem
        Of this mesh.
    anchored : (ndarray of shape (V, 2) and dtype float, float), optional
        Where the vertices would rather be, in the frames of the start, and the weight of the mean squared
        distance from there.
    slide : bool
        Whether vertices of the nuclear outline may change their angles.

    Returns
    -------
    Relaxed
        Its places are in the frames of the start.

    Raises
    ------
    MapError
        The start is not valid.
    """
    problem = Compartments(mesh, system, lifts, radius, shape_weight, slide)
    if anchored is not None:
        anchor, inertia = anchored
        problem.pull_to(anchor, inertia * problem.metric(anchor))
    return descended(problem, start)


def _pairs(mesh: NucleusMesh, system: BlockSystem) -> IntArray:
    """Block of each step between neighbours on the nuclear outline, (N,)."""
    pairs = np.empty(mesh.n_nucleus, dtype=np.int64)
    first, stop = mesh.n_boundary, mesh.n_boundary + mesh.n_nucleus
    for k in range(3):
        start, end = mesh.triangles[:, k], mesh.triangles[:, (k + 1) % 3]
        step = (
            (start >= first) & (start < stop) & ((end - start == 1) | ((start == stop - 1) & (end == first)))
        )
        step &= (end >= first) & (end < stop)
        l = (k + 1) % 3
        pairs[start[step] - first] = np.maximum(system.place[step, k, l], system.place[step, l, k])
    return pairs


def _complex(uv: FloatArray) -> Any:
    return uv[:, 0] + 1j * uv[:, 1]


class Compartments(GaussNewton):
    """The energy of one mesh with a nucleus; places, lifts and the others as for `relax_compartments`.

    Attributes
    ----------
    cell : CompartmentElements
    """

    def __init__(
        self,
        mesh: NucleusMesh,
        system: BlockSystem,
        lifts: IntArray,
        radius: float,
        shape_weight: float,
        slide: bool,
    ):
        super().__init__(system, shape_weight)
        areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
        hats = hat_gradients(mesh.vertices_yx, mesh.triangles)
        share = np.empty(len(areas))
        for part, of_disk, own_area in (
            (mesh.inside, radius**2, np.pi),
            (~mesh.inside, 1.0 - radius**2, np.pi * (1.0 - radius**2)),
        ):
            total = areas[part].sum()
            share[part] = of_disk * areas[part] / total
            hats[part] /= np.sqrt(own_area / total)
        self._loop = mesh.nucleus_boundary
        interior = system.unknown.copy()
        interior[self._loop] = -1
        sliding = np.zeros(len(mesh.vertices_yx), dtype=bool)
        sliding[self._loop] = True
        self.cell = CompartmentElements(
            mesh.triangles,
            hats,
            share,
            *shared_out(mesh.triangles, share, interior, len(system.vertex)),
            mesh.inside,
            np.asarray(TURN * lifts, dtype=np.float64),
            sliding,
        )
        self._free: BoolArray = np.ones((len(sliding), 2), dtype=bool)
        self._free[sliding, 1] = False
        self._free[sliding, 0] = slide
        self._free[: mesh.n_boundary] = False
        self._slide = slide
        self._held, self._roots = np.zeros(len(mesh.vertices_yx)), np.empty(len(areas))
        outline = mesh.vertices_yx[self._loop]
        lengths = arc_lengths(outline)
        self._loop_share = lengths / lengths.sum()
        self._loop_weight = _OUTLINE * shape_weight
        self._pair = _pairs(mesh, system)
        self._radius, self._inside = radius, mesh.vertex_inside

    def metric(self, places: FloatArray) -> FloatArray:
        """Share of the disk around each vertex, times the squared length of its two steps there, (V, 2)."""
        corner_share = np.repeat(self.cell.share / 3.0, 3)
        shares = np.bincount(self.cell.triangles.ravel(), corner_share)
        square = 1.0 - 2.0 * places[:, 1]
        lengths = np.column_stack([square, 1.0 / square])
        lengths[self._inside] = self._radius**2
        lengths[~self._free] = 0.0
        return np.asarray(shares[:, None] * lengths)

    def own_energy(self, uv: FloatArray) -> float:
        at_outline = loop_energy(uv[self._loop, 0], self._loop_share, self._loop_weight)
        if not np.isfinite(at_outline):
            return np.inf
        return float(at_outline + compartment_energy(uv, self.cell, self.shape_weight))

    def descent(self, uv: FloatArray) -> tuple[FloatArray, float]:
        """Step of every vertex, and the energy it promises to save to first order.

        A triangle that the step would soon turn over would make it short for all: its corners are held, and
        the others' step is computed anew. Where that saves next to nothing, it is no sign of the end: the
        step of all is taken.
        """
        self._held[:] = 0.0
        free = held = super().descent(uv)
        for _ in range(_HOLDS):
            if self.largest_step(uv, held[0]) >= _SOON:
                break
            self._held[self.cell.triangles[self._roots < _SOON]] += _HOLD
            held = super().descent(uv)
        return held if held[1] > max(_WORTH * free[1], DECREMENT) else free

    def moved(self, uv: FloatArray, step: FloatArray) -> FloatArray:
        """Where a step leads: vertices inside the nucleus turn about its centre with those of its outline."""
        found = uv + step
        z, d = _complex(uv[self._inside]), _complex(step[self._inside])
        turn = (d * z.conj()).imag / np.maximum(np.abs(z) ** 2, _CORE**2)
        turned = z * np.exp(1j * turn) + d - 1j * turn * z
        found[self._inside] = np.column_stack([turned.real, turned.imag])
        return found

    def fill(self, uv: FloatArray, system: PressureSystem, right: FloatArray) -> None:
        pattern = system.pattern
        places = pattern.unknown, pattern.place, pattern.diagonal
        fill_compartments(uv, self.cell, self.shape_weight, self._free, places, system.blocks, right)
        if self._held.any():
            for axis in (0, 1):
                system.blocks[pattern.diagonal, axis, axis] *= 1.0 + self._held[self._vertex]
        if self._slide:
            steps = uv[self._loop, 0], self._loop_share, self._loop_weight
            ends = pattern.unknown[self._loop], self._pair, pattern.diagonal
            add_loop(*steps, *ends, system.blocks, right)

    def largest_step(self, uv: FloatArray, direction: FloatArray) -> float:
        return float(largest_compartment_step(uv, direction, self.cell, self._roots))
