"""Relaxation that counts the area of each triangle, by projected Newton steps (`method="newton-triangles"`).

One area a triangle is about as many constraints as there are unknowns, so the triangulation locks, and the
mesh has a say in where places come to lie. `newton` averages areas around vertices instead; this one is kept
for comparison, and for maps whose inside stays in the lab, where areas do not count.

The energy is a barrier: it grows without bound as a triangle loses its area, so from a valid start no
accepted step leaves the valid maps.

Far from the minimum the area term's Hessian is the Gauss-Newton one: log det J is close to linear over a
step, where (log det J)² bends away from its parabola and even turns concave above e. On cells with thin necks
this takes fewer steps (`benchmarks/reference_masks.py` prints how many).

Near the minimum the projected Hessian overestimates curvature, for what it raises to 0 was negative: steps
are too short and run the same way time after time. They are made longer, with momentum, and taken back where
that does not lower the energy.
"""

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.energy import Elements, derivatives, energy, largest_step
from cytodisk.disk.relaxed import Relaxed
from cytodisk.errors import MapError
from cytodisk.geometry.mesh import Mesh, hat_gradients, triangle_areas

_SAFE_SHARE = 0.9  # of the step at which the first triangle would lose its area
_SUFFICIENT = 1e-4  # Armijo: share of the predicted decrease that a step must reach
_HALVINGS = 50
LONGER, MOMENTUM = 1.5, 0.3  # of a step near the minimum: its own length, and the step before
DECREMENT = 4e-5
GAUSS_NEWTON_ABOVE = 1e-2  # decrement below which the whole projected Hessian takes over
MAX_STEPS = 500


def relax_triangles(
    mesh: Mesh,
    start_uv: FloatArray,
    shape_weight: float,
    anchor_uv: FloatArray | None = None,
    inertia: float = 0.0,
    system: BlockSystem | None = None,
    area_weight: float = 1.0,
) -> Relaxed:
    """Move the interior vertices of a valid map until its triangles have their share of the area.

    Parameters
    ----------
    mesh : Mesh
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
    area_weight : float
        0 leaves areas out: what remains is the shape term, which still keeps triangles from turning over.

    Returns
    -------
    Relaxed

    Raises
    ------
    MapError
        The start is not valid.

    References
    ----------
    Smith, de Goes & Kim, "Analytic eigensystems for isotropic distortion energies", 2019,
    doi:10.1145/3241041
    """
    anchored = (start_uv, 0.0) if anchor_uv is None else (anchor_uv, inertia)
    weights = shape_weight, area_weight
    problem = _Problem(mesh, system or BlockSystem(mesh), start_uv, weights, *anchored)
    uv, value, last = start_uv, problem.energy(start_uv), None
    if not np.isfinite(value):
        raise MapError("relaxation needs a start without flipped triangles")
    gauss = True
    for step in range(MAX_STEPS):
        newton, decrement = problem.newton_direction(uv, gauss)
        gauss = gauss and decrement > GAUSS_NEWTON_ABOVE
        if decrement < DECREMENT:
            return Relaxed(uv, step, decrement > -DECREMENT)
        moved = None
        if last is not None and not gauss:
            moved = problem.search(uv, LONGER * newton + MOMENTUM * last, value, decrement, halvings=1)
        moved = moved or problem.search(uv, newton, value, decrement)
        if moved is None:  # no descent left in double precision
            return Relaxed(uv, step, False)
        last = moved[0] - uv
        uv, value = moved
    return Relaxed(uv, MAX_STEPS, False)


class _Problem:
    """The energy of one mesh with everything that stays the same between steps."""

    def __init__(
        self,
        mesh: Mesh,
        system: BlockSystem,
        uv: FloatArray,
        weights: tuple[float, float],
        anchor_uv: FloatArray,
        inertia: float,
    ):
        areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
        scale = np.sqrt(triangle_areas(uv[:, ::-1], mesh.triangles).sum() / areas.sum())
        hats = hat_gradients(mesh.vertices_yx * scale, mesh.triangles)
        self._weight, area_weight = weights
        self._cell = Elements(mesh.triangles, hats, areas / areas.sum(), area_weight)
        self._system = system
        self._anchor = anchor_uv
        corner_share = np.repeat(self._cell.share / 3.0, 3)
        self._inertia = inertia * np.bincount(mesh.triangles.ravel(), corner_share, minlength=len(uv))
        self._inertia[: mesh.n_boundary] = 0.0

    def energy(self, uv: FloatArray) -> float:
        value = float(energy(uv, *self._cell, self._weight))
        if self._inertia.any():
            value += float((self._inertia * np.square(uv - self._anchor).sum(axis=1)).sum())
        return value

    def newton_direction(self, uv: FloatArray, gauss: bool) -> tuple[FloatArray, float]:
        """Step of every vertex, and the energy it promises to save to first order."""
        system = self._system
        gradient = np.empty((len(system.vertex), 2))
        derivatives(
            uv,
            self._cell,
            self._weight,
            system.unknown,
            system.place,
            gauss,
            gradient,
            system.blocks,
        )
        if self._inertia.any():
            pull = 2.0 * self._inertia[system.vertex, None]
            gradient += pull * (uv - self._anchor)[system.vertex]
            for axis in (0, 1):
                system.blocks[system.diagonal, axis, axis] += pull[:, 0]
        system.factorise()
        step = system.solve(-gradient)
        direction = np.zeros_like(uv)
        direction[system.vertex] = step
        return direction, -float((gradient * step).sum())

    def search(
        self,
        uv: FloatArray,
        direction: FloatArray,
        value: float,
        decrement: float,
        halvings: int = _HALVINGS,
    ) -> tuple[FloatArray, float] | None:
        """Armijo backtracking from the longest step that keeps every triangle positive."""
        barrier = largest_step(uv, direction, self._cell.triangles, self._cell.hats)
        size = min(1.0, _SAFE_SHARE * barrier)
        for _ in range(halvings):
            moved = uv + size * direction
            new_value = self.energy(moved)
            if new_value <= value - _SUFFICIENT * size * decrement:
                return moved, new_value
            size *= 0.5
        return None
