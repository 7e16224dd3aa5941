"""Equiareal relaxation by projected Newton steps that cannot turn a triangle over (design of this package).

The energy is a barrier: it grows without bound as a triangle loses its area, so from a valid start no
accepted step leaves the valid maps.

Far from the minimum the area term's Hessian is the Gauss-Newton one: log det J is close to linear over a
step, where (log det J)² bends away from its parabola and even turns concave above e. On cells with thin necks
this takes fewer steps (`benchmarks/reference_masks.py` prints how many).
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.energy import derivatives, energy, largest_step
from cytodisk.disk.ldl import Factorisation
from cytodisk.errors import MapError
from cytodisk.geometry.mesh import Mesh, hat_gradients, triangle_areas

_SAFE_SHARE = 0.9  # of the step at which the first triangle would lose its area
_SUFFICIENT = 1e-4  # Armijo: share of the predicted decrease that a step must reach
_HALVINGS = 50
DECREMENT = 4e-5
GAUSS_NEWTON_ABOVE = 1e-2  # decrement below which the whole projected Hessian takes over
MAX_STEPS = 500


@dataclass(frozen=True)
class Relaxed:
    """Result of a relaxation.

    Attributes
    ----------
    vertices_uv : ndarray of shape (V, 2) and dtype float
    steps : int
        Newton steps taken.
    converged : bool
        Whether the Newton decrement fell below `DECREMENT` within `MAX_STEPS`; if not, the map is valid but
        its area error could still fall.
    """

    vertices_uv: FloatArray
    steps: int
    converged: bool


def relax(
    mesh: Mesh,
    start_uv: FloatArray,
    shape_weight: float,
    anchor_uv: FloatArray | None = None,
    inertia: float = 0.0,
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
    problem = _Problem(mesh, start_uv, shape_weight, *anchored)
    uv, value = start_uv, problem.energy(start_uv)
    if not np.isfinite(value):
        raise MapError("relaxation needs a start without flipped triangles")
    gauss = True
    for step in range(MAX_STEPS):
        direction, decrement = problem.newton_direction(uv, gauss)
        gauss = gauss and decrement > GAUSS_NEWTON_ABOVE
        if decrement < DECREMENT:
            return Relaxed(uv, step, True)
        moved = problem.search(uv, direction, value, decrement)
        if moved is None:  # no descent left in double precision
            return Relaxed(uv, step, False)
        uv, value = moved
    return Relaxed(uv, MAX_STEPS, False)


class _Problem:
    """The energy of one mesh with everything that stays the same between steps."""

    def __init__(
        self, mesh: Mesh, uv: FloatArray, shape_weight: float, anchor_uv: FloatArray, inertia: float
    ):
        areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
        scale = np.sqrt(triangle_areas(uv[:, ::-1], mesh.triangles).sum() / areas.sum())
        self._hats = hat_gradients(mesh.vertices_yx * scale, mesh.triangles)
        self._share = areas / areas.sum()
        self._triangles = mesh.triangles
        self._weight = shape_weight
        self._n_boundary = mesh.n_boundary
        self._pattern = _HessianPattern(mesh)
        self._factors: Factorisation | None = None
        corner_share = np.repeat(self._share / 3.0, 3)
        share = np.bincount(mesh.triangles.ravel(), corner_share, minlength=len(uv))[mesh.n_boundary :]
        self._anchor = anchor_uv[mesh.n_boundary :]
        self._inertia = inertia * share

    def energy(self, uv: FloatArray) -> float:
        moved = np.square(uv[self._n_boundary :] - self._anchor).sum(axis=1)
        area_and_shape = float(energy(uv, self._triangles, self._hats, self._share, self._weight))
        return area_and_shape + float(self._inertia @ moved)

    def newton_direction(self, uv: FloatArray, gauss: bool) -> tuple[FloatArray, float]:
        """Step of every vertex, and the energy it promises to save to first order."""
        pattern = self._pattern
        gradient = np.empty(pattern.upper.shape[0])
        derivatives(
            uv,
            self._triangles,
            self._hats,
            self._share,
            self._weight,
            gradient,
            pattern.unknown,
            pattern.first,
            pattern.second,
            pattern.upper.data,
            gauss,
        )
        if self._inertia.any():
            gradient += (2.0 * self._inertia[:, None] * (uv[self._n_boundary :] - self._anchor)).ravel()
            pattern.upper.data[pattern.diagonal] += np.repeat(2.0 * self._inertia, 2)
        if self._factors is None:
            self._factors = Factorisation(pattern.upper)
        else:
            self._factors.update(pattern.upper)
        step = self._factors.solve(-gradient)
        direction = np.zeros_like(uv)
        direction[self._n_boundary :] = step.reshape(-1, 2)
        return direction, -float(gradient @ step)

    def search(
        self, uv: FloatArray, direction: FloatArray, value: float, decrement: float
    ) -> tuple[FloatArray, float] | None:
        """Armijo backtracking from the longest step that keeps every triangle positive."""
        barrier = largest_step(uv, direction, self._triangles, self._hats)
        size = min(1.0, _SAFE_SHARE * barrier)
        for _ in range(_HALVINGS):
            moved = uv + size * direction
            new_value = self.energy(moved)
            if new_value <= value - _SUFFICIENT * size * decrement:
                return moved, new_value
            size *= 0.5
        return None


class _HessianPattern:
    """Where the 2×2 blocks of the Hessian's upper triangle lie in one CSC matrix.

    Unknown n is interior vertex n, with its u in row 2 n and its v in row 2 n + 1.

    Attributes
    ----------
    upper : csc_matrix of shape (2 M, 2 M)
        M interior vertices; values to be filled.
    unknown : ndarray of shape (V,) and dtype int
        Number of each vertex among the unknowns, -1 for the boundary.
    diagonal : ndarray of shape (2 M,) and dtype int
        Place of the diagonal in the matrix's values.
    first, second : ndarray of shape (F, 3, 3) and dtype int
        Place in the matrix's values of the first row of a block's two columns, for the corners (row, column)
        of a triangle; -1 below the diagonal or at the boundary.
    """

    def __init__(self, mesh: Mesh):
        n = len(mesh.vertices_yx) - mesh.n_boundary
        self.unknown = np.concatenate([np.full(mesh.n_boundary, -1), np.arange(n)])
        corner = self.unknown[mesh.triangles]
        row, column = np.broadcast_arrays(corner[:, :, None], corner[:, None, :])
        stored = (row >= 0) & (column >= row)
        blocks, which = np.unique(column[stored] * n + row[stored], return_inverse=True)
        column, row = blocks // n, blocks % n
        first_block = np.searchsorted(column, np.arange(n + 1))
        above = np.diff(first_block) - 1  # blocks above the diagonal, by block column
        start = np.concatenate([[0], np.cumsum(4 * above + 3)])
        first = start[column] + 2 * (np.arange(len(blocks)) - first_block[column])
        second = first + 2 * above[column] + 1
        self.first, self.second = np.full(stored.shape, -1), np.full(stored.shape, -1)
        self.first[stored], self.second[stored] = first[which], second[which]
        self.upper = self._matrix(n, row, column, first, second, start, above)
        self.diagonal = self.upper.indptr[1:] - 1  # last in its column

    @staticmethod
    def _matrix(
        n: int,
        row: IntArray,
        column: IntArray,
        first: IntArray,
        second: IntArray,
        start: IntArray,
        above: IntArray,
    ) -> sparse.csc_matrix:
        off_diagonal = row != column
        indices = np.empty(start[-1], dtype=np.int64)
        indices[first] = indices[second] = 2 * row
        indices[first[off_diagonal] + 1] = 2 * row[off_diagonal] + 1
        indices[second + 1] = 2 * row + 1
        column_start = np.empty(2 * n + 1, dtype=np.int64)
        column_start[0::2] = start
        column_start[1::2] = start[:-1] + 2 * above + 1
        return sparse.csc_matrix((np.zeros(start[-1]), indices, column_start), shape=(2 * n, 2 * n))
