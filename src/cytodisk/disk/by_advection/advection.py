"""The paper's area relaxation: vertices flow out of triangles that are too small (paper A.2.1 iii).

The text leaves open how λ becomes a smooth field; read here as Lie advection has it, by Poisson's equation.
It is here for comparison. Flips can turn a triangle back in the disk, but not always without turning it over
in the cell; here they keep the cell whole, and the certificate of the map counts the triangles that stay
turned over in the disk.
"""

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.by_advection.advection_field import (
    area_factors,
    edge_cotangents,
    signed_areas,
    vertex_gradients,
    vertex_sources,
)
from cytodisk.disk.by_advection.poisson import PoissonSolver
from cytodisk.geometry.flips import flip_to_delaunay, triangle_neighbours
from cytodisk.geometry.mesh import Mesh, triangle_areas

STEPS = 500
# Share of its surplus that a large triangle loses in a step. Of 0.005, 0.01 and 0.02 the first turns fewest
# triangles over on the reference masks; larger steps bring shapes with long arms further in 500 steps.
STEP_SIZE = 0.005
_LEAST_IN_CELL = 1e-3  # of the mean area: what a flip must leave of a triangle in the cell


@dataclass(frozen=True)
class Advected:
    """Result of the advection.

    Attributes
    ----------
    vertices_uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
        After the flips; all positive in the cell if it was kept whole, in the disk not necessarily.
    flips : int
        Edges that were flipped.
    steps : int
    """

    vertices_uv: FloatArray
    triangles: IntArray
    flips: int
    steps: int


def advect(mesh: Mesh, start_uv: FloatArray, steps: int = STEPS, *, whole_cell: bool = True) -> Advected:
    """Even out the areas of a mesh's triangles in the disk.

    In each step the proxy area factor of each triangle, λ = median area / area in the disk, gives a smooth
    field f by Poisson's equation Δf = λ − mean λ with natural boundary, as in Lie advection; interior
    vertices move by `STEP_SIZE` times its gradient, so that triangles smaller than average grow. Then edges
    are flipped towards Delaunay in the disk. Boundary vertices stay. The number of steps and their size are
    the same for all cells.

    Parameters
    ----------
    mesh : Mesh
        Isotropic: its triangles are of nearly one size and form in the cell, so that even areas in the
        disk are area shares as in the cell.
    start_uv : ndarray of shape (V, 2) and dtype float
        The harmonic map.
    steps : int
    whole_cell : bool
        Flip no edge whose new triangles would turn over in the cell. Without it, as the text has it, fewer
        or no triangles stay turned over in the disk, but some are in the cell; on shapes with thin parts the
        mesh can then tear, and the next step fails.

    Returns
    -------
    Advected
        Always finite; triangles may be turned over in the disk.

    Notes
    -----
    Where the text is silent: the gradients of triangles are averaged with their areas as weights; λ is at
    most 20, also where a triangle is turned over; thin triangles have the cotangents and gradients of
    thicker ones; Poisson's equation is solved to 5 % of its right-hand side, from the last step's solution;
    after a step at most ten rounds of flips are made, none that joins two boundary vertices.

    References
    ----------
    u-Unwrap, appendix A.2.1 (iii). Zou, Hu, Gu & Hua, "Authalic parameterization of general surfaces using
    Lie advection", 2011, doi:10.1109/TVCG.2011.171
    """
    uv, triangles = np.ascontiguousarray(start_uv), mesh.triangles.copy()
    cell_xy = np.ascontiguousarray(mesh.vertices_yx[:, ::-1])
    neighbours = triangle_neighbours(triangles)
    mean_area = float(triangle_areas(mesh.vertices_yx, triangles).mean())
    least = _LEAST_IN_CELL * mean_area if whole_cell else -np.inf
    solver = PoissonSolver(len(uv))
    flips = 0
    for _ in range(steps):
        uv = uv.copy()
        uv[mesh.n_boundary :] += STEP_SIZE * _direction(uv, triangles, solver)[mesh.n_boundary :]
        flips += flip_to_delaunay(uv, cell_xy, triangles, neighbours, mesh.n_boundary, least)
    return Advected(uv, triangles, flips, steps)


def _direction(uv: FloatArray, triangles: IntArray, solver: PoissonSolver) -> FloatArray:
    areas = signed_areas(uv, triangles)
    weights, sizes = edge_cotangents(uv, triangles, areas)
    field = solver.solve(weights, triangles, vertex_sources(*area_factors(areas), triangles, len(uv)))
    return np.asarray(vertex_gradients(field, uv, triangles, areas, sizes))
