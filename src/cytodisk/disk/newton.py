"""Equiareal relaxation by Gauss-Newton steps that cannot turn a triangle over (design of this package).

Areas are averaged around vertices (`vertex_energy`). One area a triangle would be about as many constraints
as there are unknowns: the triangulation locks, as linear elements do in an incompressible solid, and the mesh
chooses the map (`newton_triangles`, kept for comparison). Averages leave half as many constraints, so that
the shape term chooses, and a cell that is mirrored or meshed anew gets nearly the same map.

The energy is a barrier: it grows without bound as a triangle loses its area, so from a valid start no
accepted step leaves the valid maps.

It ends where a step promises to save little of the energy. Cells with long arms would take many more steps,
which would move about one pixel in ten into the next of 10 × 60 windows, and change the area error of windows
by less than 0.01 (`tests/disk/test_newton.py`). In cells without arms next to nothing is left to move.
"""

from __future__ import annotations

from abc import ABC, abstractmethod

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.energy import largest_step
from cytodisk.disk.pressure_blocks import PressureSystem
from cytodisk.disk.relaxed import Relaxed
from cytodisk.disk.vertex_energy import averaged_elements, averaged_energy, fill_step, step_of
from cytodisk.errors import MapError
from cytodisk.geometry.mesh import Mesh, hat_gradients, triangle_areas

_SAFE_SHARE = 0.9  # of the step at which the first triangle would lose its area
_SUFFICIENT = 1e-4  # Armijo: share of the predicted decrease that a step must reach
_TRIALS = 50
_SHORTEST, _LONGEST = 0.1, 0.7  # of a step that was too long: bounds of the next one
DECREMENT = 5e-4  # the relaxation ends where a step saves less
_LOST = 1e-3 * DECREMENT  # a step that climbs by more has lost its digits: no exact one climbs
MAX_STEPS = 500
_STIFFER, _STIFFEST = 30.0, 20.0  # shape weight far out: more by so many times the decrement, at most so much
_NEAR = 10.0  # times the last decrement: from there on the shape weight is the given one
_DAMPINGS = (0.0, 1e-8, 1e-6, 1e-4, 1e-2)  # share of the diagonal that is added to it


def relax(
    mesh: Mesh,
    start_uv: FloatArray,
    shape_weight: float,
    anchor_uv: FloatArray | None = None,
    inertia: float = 0.0,
    system: BlockSystem | None = None,
) -> Relaxed:
    """Move the interior vertices of a valid map until each has its share of the area around it.

    Parameters
    ----------
    mesh : Mesh
        No interior edge may join two boundary vertices.
    start_uv : ndarray of shape (V, 2) and dtype float
        A valid map: every triangle positive. Boundary vertices stay where they are.
    shape_weight : float
        Weight of shape against area in the energy; > 0.
    anchor_uv : ndarray of shape (V, 2) and dtype float, optional
        Where the vertices would rather be, such as where the last frame of a movie puts them.
    inertia : float
        Weight of the mean squared distance from there, over the disk's area, that is added to the energy.
    system : BlockSystem, optional
        Of this mesh, if there is one already.

    Returns
    -------
    Relaxed

    Raises
    ------
    MapError
        The start is not valid.

    References
    ----------
    Averaged areas: Bonet & Burton, "A simple average nodal pressure tetrahedral element for incompressible
    and nearly incompressible dynamic explicit applications", 1998. De Souza Neto, Andrade Pires & Owen,
    "F-bar-based linear triangles and tetrahedra for finite strain analysis of nearly incompressible solids",
    2005, doi:10.1002/nme.1187
    """
    problem = _Problem(mesh, system or BlockSystem(mesh), start_uv, shape_weight)
    if anchor_uv is not None and inertia:
        problem.pull_to(anchor_uv, inertia * problem.vertex_shares[:, None])
    return descended(problem, start_uv)


def descended(problem: GaussNewton, start: FloatArray) -> Relaxed:
    """Go down the energy of a problem from a valid map until a step saves next to nothing.

    Parameters
    ----------
    problem : GaussNewton
    start : ndarray of shape (V, 2) and dtype float

    Returns
    -------
    Relaxed

    Raises
    ------
    MapError
        The start is not valid.
    """
    shape_weight = problem.shape_weight
    uv, value = start, problem.energy(start)
    if not np.isfinite(value):
        raise MapError("relaxation needs a start without flipped triangles")
    most = np.inf  # of the shape weight
    for step in range(MAX_STEPS):
        direction, decrement = problem.descent(uv)
        if -_LOST < decrement < DECREMENT and problem.shape_weight == shape_weight:
            return Relaxed(uv, step, True)
        moved = problem.search(uv, direction, value, decrement) if decrement > 0.0 else None
        if moved is None and problem.shape_weight == shape_weight:  # no descent left in double precision
            return Relaxed(uv, step, False)
        uv, value = moved or (uv, value)
        most = min(most, _shape_weight_far_out(shape_weight, decrement if moved else 0.0))
        if most != problem.shape_weight:
            problem.shape_weight = most
            value = problem.energy(uv)
    return Relaxed(uv, MAX_STEPS, False)


def _shape_weight_far_out(shape_weight: float, decrement: float) -> float:
    """A larger weight while a step still saves much; the given one near the end."""
    if decrement < _NEAR * DECREMENT:
        return shape_weight
    return shape_weight * (1.0 + min(_STIFFER * decrement, _STIFFEST))


class GaussNewton(ABC):
    """An energy of places of vertices, with everything that stays the same between steps.

    Attributes
    ----------
    shape_weight : float
        May change between steps.
    """

    def __init__(self, system: BlockSystem, shape_weight: float):
        self.shape_weight = shape_weight
        self._system = PressureSystem(system.pattern)
        self._vertex = system.vertex
        self._pull: FloatArray | None = None
        self._anchor = np.empty((0, 2))

    def pull_to(self, anchor: FloatArray, pull: FloatArray) -> None:
        """Add the squared distance of each vertex from an anchor (V, 2) times a weight (V, 2) or (V, 1)."""
        self._anchor, self._pull = anchor[self._vertex], pull[self._vertex]

    @abstractmethod
    def own_energy(self, uv: FloatArray) -> float:
        """Energy without the pull; infinite where a triangle is not positive."""

    @abstractmethod
    def fill(self, uv: FloatArray, system: PressureSystem, right: FloatArray) -> None:
        """Fill the blocks and the right-hand side of a step, as `vertex_energy.fill_step`."""

    @abstractmethod
    def largest_step(self, uv: FloatArray, direction: FloatArray) -> float:
        """Largest step that keeps every triangle positive, to first order at least."""

    def moved(self, uv: FloatArray, step: FloatArray) -> FloatArray:
        """Where a step leads."""
        return uv + step

    def energy(self, uv: FloatArray) -> float:
        """Energy with the pull; infinite where a triangle is not positive."""
        value = self.own_energy(uv)
        if self._pull is not None:
            value += float((self._pull * np.square(uv[self._vertex] - self._anchor)).sum())
        return value

    def descent(self, uv: FloatArray) -> tuple[FloatArray, float]:
        """Step of every vertex, and the energy it promises to save to first order.

        A triangle of next to no area makes the matrix so uneven that its factors can lose all digits, and the
        step would climb: the diagonal is then raised by a little.
        """
        for damping in _DAMPINGS:
            direction, decrement = self.gauss_newton_direction(uv, damping)
            if decrement > -_LOST:
                break
        return direction, decrement

    def gauss_newton_direction(self, uv: FloatArray, damping: float = 0.0) -> tuple[FloatArray, float]:
        """The step with the diagonal raised by a share of it, and what it saves."""
        system, diagonal = self._system, self._system.pattern.diagonal
        right = np.empty((len(self._vertex), 3))
        self.fill(uv, system, right)
        if self._pull is not None:
            pull = np.broadcast_to(2.0 * self._pull, (len(self._vertex), 2))
            right[:, :2] -= pull * (uv[self._vertex] - self._anchor)
            for axis in (0, 1):
                system.blocks[diagonal, axis, axis] += pull[:, axis]
        if damping:
            for axis in (0, 1):
                system.blocks[diagonal, axis, axis] *= 1.0 + damping
        system.factorise()
        direction, saved = step_of(system.solve(right), right, self._vertex, len(uv))
        return direction, float(saved)

    def search(
        self, uv: FloatArray, direction: FloatArray, value: float, decrement: float
    ) -> tuple[FloatArray, float] | None:
        """Armijo search from the longest step that keeps every triangle positive.

        A step that is too long is followed by the lowest point of the parabola through what is known.
        """
        size = min(1.0, _SAFE_SHARE * self.largest_step(uv, direction))
        for _ in range(_TRIALS):
            moved = self.moved(uv, size * direction)
            new_value = self.energy(moved)
            if new_value <= value - _SUFFICIENT * size * decrement:
                return moved, new_value
            excess = new_value - value + size * decrement  # above the tangent
            lowest = 0.5 * size * decrement / excess if np.isfinite(excess) else 0.5
            size *= min(max(lowest, _SHORTEST), _LONGEST)
        return None


class _Problem(GaussNewton):
    """The energy of one mesh without a nucleus."""

    def __init__(self, mesh: Mesh, system: BlockSystem, uv: FloatArray, shape_weight: float):
        super().__init__(system, shape_weight)
        areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
        scale = np.sqrt(triangle_areas(uv[:, ::-1], mesh.triangles).sum() / areas.sum())
        hats = hat_gradients(mesh.vertices_yx * scale, mesh.triangles)
        share = areas / areas.sum()
        self._cell = averaged_elements(mesh.triangles, hats, share, system.unknown)

    @property
    def vertex_shares(self) -> FloatArray:
        """A third of the shares of the triangles around each vertex, shape (V,)."""
        corner_share = np.repeat(self._cell.share / 3.0, 3)
        return np.asarray(np.bincount(self._cell.triangles.ravel(), corner_share), dtype=np.float64)

    def own_energy(self, uv: FloatArray) -> float:
        return float(averaged_energy(uv, self._cell, self.shape_weight))

    def fill(self, uv: FloatArray, system: PressureSystem, right: FloatArray) -> None:
        pattern = system.pattern
        fill_step(uv, self._cell, self.shape_weight, pattern.place, pattern.diagonal, system.blocks, right)

    def largest_step(self, uv: FloatArray, direction: FloatArray) -> float:
        return float(largest_step(uv, direction, self._cell.triangles, self._cell.hats))
