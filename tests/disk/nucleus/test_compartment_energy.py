"""The energy of a cell with its nucleus against a plain twin, and its steps against finite differences."""

from typing import NamedTuple

import numpy as np
import pytest
from numpy.testing import assert_allclose

from cytodisk.arrays import FloatArray
from cytodisk.disk.blocks import BlockSystem
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.nucleus.compartment_energy import largest_compartment_step
from cytodisk.disk.nucleus.compartment_newton import Compartments
from cytodisk.disk.nucleus.cone import TURN
from cytodisk.disk.pressure_blocks import PressureSystem
from cytodisk.disk.vertex_energy import EDGE_WEIGHT, SHAPE_CURVATURE
from cytodisk.geometry.mesh import triangle_areas
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.geometry.polygon import arc_lengths
from cytodisk.simulate import random_smooth

WEIGHT, RADIUS = 0.005, 0.6


class Case(NamedTuple):
    mesh: NucleusMesh
    problem: Compartments
    places: FloatArray
    system: BlockSystem


@pytest.fixture(scope="module")
def case() -> Case:
    """A valid map that is best for a much larger shape weight."""
    mask = random_smooth(5, radius=9.0)
    row, column = np.indices(mask.shape) - np.argwhere(mask).mean(axis=0)[:, None, None]
    nucleus = np.hypot(row + 2.0, 1.4 * (column - 1.0)) < 3.5
    meshed = mesh_cell(mask, MappingParameters(edge_length=1.5), nucleus=nucleus)
    mesh, system = meshed.mesh, meshed.system
    assert isinstance(mesh, NucleusMesh)
    disk = map_to_disk(mask, nucleus, edge_length=1.5, nucleus_radius=RADIUS, shape_weight=1.0)
    assert disk.nucleus is not None
    places = disk.nucleus.places.copy()
    depth, turn = places[~mesh.vertex_inside].T
    places[~mesh.vertex_inside] = np.column_stack([TURN * turn, 0.5 * (1.0 - RADIUS**2) * depth])
    problem = Compartments(mesh, system, disk.nucleus.lifts, RADIUS, WEIGHT, True)
    assert np.isfinite(problem.own_energy(places))
    return Case(mesh, problem, places, system)


def jacobians(case: Case, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """J of each triangle in the disk at its middle, from corners alone; and det J."""
    cell = case.problem.cell
    corners = places[cell.triangles]
    corners[..., 0] += cell.turned
    on_circle = cell.sliding[cell.triangles] & cell.inside[:, None]
    angles = places[cell.triangles][..., 0][on_circle]
    corners[on_circle] = np.column_stack([np.cos(angles), np.sin(angles)])
    found = np.einsum("tka,tkb->tab", corners, cell.hats)
    radius = np.sqrt(np.where(cell.inside, 1.0, 1.0 - 2.0 * corners[..., 1].mean(axis=1)))
    found[:, 0] *= radius[:, None]
    found[:, 1] /= radius[:, None]
    return found, np.linalg.det(found)


def outline_steps(case: Case, places: FloatArray) -> FloatArray:
    """Residuals of the steps of the nuclear outline, 0 where each has the outline's share of the turn."""
    angles, lengths = (
        places[case.mesh.nucleus_boundary, 0],
        arc_lengths(case.mesh.vertices_yx[case.mesh.nucleus_boundary]),
    )
    share = lengths / lengths.sum()
    steps = np.mod(np.roll(angles, -1) - angles, TURN)
    x = np.tan(0.5 * steps) / np.tan(0.5 * TURN * share)
    return np.asarray(np.sqrt(WEIGHT * share) * (np.sqrt(x) - 1.0 / np.sqrt(x)))


def residuals(case: Case, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Plain twin: those of the areas, one an interior vertex; and of triangles, two of shape, one of area.

    Those of the steps of the outline follow.
    """
    cell, mesh = case.problem.cell, case.mesh
    found, det = jacobians(case, places)
    on_outline = cell.triangles < mesh.n_boundary + mesh.n_nucleus
    given = cell.share / (~on_outline).sum(axis=1)
    vertex, triangle = cell.triangles[~on_outline], np.nonzero(~on_outline)[0]
    n_vertices = len(mesh.vertices_yx)
    area = np.bincount(vertex, (given * det)[triangle], minlength=n_vertices)
    target = np.bincount(vertex, given[triangle], minlength=n_vertices)
    counts = target > 0.0
    root = np.sqrt(WEIGHT * cell.share / det)
    at_edge = on_outline.any(axis=1)
    of_triangles = np.concatenate(
        [
            root * (found[:, 0, 0] - found[:, 1, 1]),
            root * (found[:, 0, 1] + found[:, 1, 0]),
            np.where(at_edge, np.sqrt(EDGE_WEIGHT * cell.share) * np.log(det), 0.0),
            outline_steps(case, places),
        ]
    )
    return np.sqrt(target[counts]) * np.log(area[counts] / target[counts]), of_triangles


def unknowns(case: Case) -> list[tuple[int, int]]:
    """Vertex and axis of every number that may change, in the order of the system."""
    loop = set(case.mesh.nucleus_boundary.tolist())
    return [(v, axis) for v in case.system.vertex.tolist() for axis in ((0,) if v in loop else (0, 1))]


def by_differences(case: Case) -> tuple[FloatArray, FloatArray]:
    """Derivatives of the residuals by the unknowns, (residuals, unknowns)."""
    columns, h = [], 1e-7
    for vertex, axis in unknowns(case):
        step = np.zeros_like(case.places)
        step[vertex, axis] = h
        there, back = residuals(case, case.places + step), residuals(case, case.places - step)
        columns.append([(a - b) / (2.0 * h) for a, b in zip(there, back, strict=True)])
    areas, triangles = zip(*columns, strict=True)
    return np.array(areas).T, np.array(triangles).T


def test_each_compartment_has_its_share_of_the_disk(case: Case) -> None:
    cell = case.problem.cell
    assert cell.share[cell.inside].sum() == pytest.approx(RADIUS**2)
    assert cell.share[~cell.inside].sum() == pytest.approx(1.0 - RADIUS**2)
    areas = triangle_areas(case.mesh.vertices_yx, case.mesh.triangles)
    for part in (cell.inside, ~cell.inside):
        assert np.ptp(cell.share[part] / areas[part]) == pytest.approx(0.0, abs=1e-12)
    _, det = jacobians(case, case.places)
    # in (θ, p) the disk's area is dθ dp: that of the ring is π (1 - R²), and det J has its mean of 1
    assert (cell.share * det)[~cell.inside].sum() == pytest.approx(1.0 - RADIUS**2)


def test_the_energy_is_that_of_its_definition(case: Case) -> None:
    areas, triangles = residuals(case, case.places)
    expected = np.square(areas).sum() + np.square(triangles).sum()
    assert case.problem.own_energy(case.places) == pytest.approx(expected, rel=1e-10)


def test_the_energy_of_a_flipped_triangle_is_infinite(case: Case) -> None:
    for vertex in (np.flatnonzero(case.mesh.vertex_inside)[0], case.mesh.n_boundary + 2):
        flipped = case.places.copy()
        flipped[vertex, 0] += 2.0
        assert case.problem.own_energy(flipped) == np.inf


def test_the_gradient_and_the_step_agree_with_finite_differences(case: Case) -> None:
    system, numbers = PressureSystem(case.system.pattern), len(case.system.vertex)
    right = np.empty((numbers, 3))
    case.problem.fill(case.places, system, right)
    (areas, triangles), (area_slopes, slopes) = residuals(case, case.places), by_differences(case)
    own = [2 * case.system.unknown[v] + axis for v, axis in unknowns(case)]
    expected = -2.0 * (slopes.T @ triangles)
    assert_allclose(right[:, :2].ravel()[own], expected, atol=1e-5 * np.abs(expected).max())
    held = np.setdiff1d(np.arange(2 * numbers), own)
    assert (right[:, :2].ravel()[held] == 0.0).all()

    direction, saved = case.problem.gauss_newton_direction(case.places)
    gradient = 2.0 * (area_slopes.T @ areas) - expected
    step = np.array([direction[v, axis] for v, axis in unknowns(case)])
    assert saved == pytest.approx(-gradient @ step, rel=1e-5)
    factor = np.ones(len(triangles))
    factor[: 2 * len(case.mesh.triangles)] = SHAPE_CURVATURE
    matrix = 2.0 * area_slopes.T @ area_slopes + 2.0 * slopes.T @ (factor[:, None] * slopes)
    assert_allclose(step, -np.linalg.solve(matrix, gradient), atol=1e-3 * np.abs(step).max())
    outlines = case.mesh.n_boundary + case.mesh.n_nucleus
    assert (direction[: case.mesh.n_boundary] == 0.0).all()
    assert (direction[case.mesh.n_boundary : outlines, 1] == 0.0).all()


def test_steps_save_what_they_promise(case: Case) -> None:
    direction, saved = case.problem.descent(case.places)
    h, before = 1e-6, case.problem.own_energy(case.places)
    there = case.problem.own_energy(case.problem.moved(case.places, h * direction))
    assert (before - there) / h == pytest.approx(saved, rel=1e-3)


def test_no_triangle_turns_over_before_the_largest_step(case: Case) -> None:
    direction = np.random.default_rng(0).normal(size=case.places.shape)
    direction[: case.mesh.n_boundary + case.mesh.n_nucleus] = 0.0
    roots = np.empty(len(case.mesh.triangles))
    first = largest_compartment_step(case.places, direction, case.problem.cell, roots)
    assert first == roots.min()
    _, before = jacobians(case, case.places + 0.999 * first * direction)
    _, after = jacobians(case, case.places + 1.001 * first * direction)
    assert (before > 0.0).all()
    assert after[roots.argmin()] < 0.0
