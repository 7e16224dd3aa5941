from typing import NamedTuple

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.block_pattern import BlockPattern
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.pressure_blocks import PressureSystem
from cytodisk.disk.vertex_energy import (
    EDGE_WEIGHT,
    SHAPE_CURVATURE,
    AveragedElements,
    averaged_elements,
    averaged_energy,
    fill_step,
)
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mesh import Mesh, hat_gradients, mesh_inside, triangle_areas
from cytodisk.geometry.outline import trace_outline

WEIGHT = 0.005


class Problem(NamedTuple):
    mesh: Mesh
    uv: np.ndarray
    cell: AveragedElements
    pattern: BlockPattern


@pytest.fixture(scope="module")
def problem() -> Problem:
    mask, _ = clean_mask(simulate.random_spiky(4, radius=8.0, spike_length=10.0))
    outline = trace_outline(mask)
    mesh = mesh_inside(outline, mask, edge_length=0.9)
    angles = boundary_angles(outline)
    uv, _ = harmonic_map(mesh, np.column_stack([np.cos(angles), np.sin(angles)]))
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    hats = hat_gradients(mesh.vertices_yx * np.sqrt(np.pi / areas.sum()), mesh.triangles)
    pattern = BlockPattern(mesh)
    cell = averaged_elements(mesh.triangles, hats, areas / areas.sum(), pattern.unknown)
    return Problem(mesh, uv, cell, pattern)


def residuals(problem: Problem, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Plain twin: those of the areas, one a vertex, and of the triangles: two of shape, one of area."""
    cell = problem.cell
    jacobians = np.einsum("tka,tkb->tab", uv[cell.triangles], cell.hats)
    det = np.linalg.det(jacobians)
    inside = cell.corner >= 0
    area = np.bincount(cell.corner[inside], (cell.parts * det[:, None])[inside])
    root = np.sqrt(WEIGHT * cell.share / det)
    at_edge = (cell.triangles < problem.mesh.n_boundary).any(axis=1)
    triangles = np.concatenate(
        [
            root * (jacobians[:, 0, 0] - jacobians[:, 1, 1]),
            root * (jacobians[:, 0, 1] + jacobians[:, 1, 0]),
            np.where(at_edge, np.sqrt(EDGE_WEIGHT * cell.share) * np.log(det), 0.0),
        ]
    )
    return np.sqrt(cell.target) * np.log(area / cell.target), triangles


def slopes(problem: Problem) -> tuple[np.ndarray, np.ndarray]:
    """Derivatives of the residuals by the unknowns (u, v of each), by central differences."""
    columns = []
    for vertex in problem.pattern.vertex:
        near = problem.uv[problem.mesh.triangles[(problem.mesh.triangles == vertex).any(axis=1)]]
        h = 1e-5 * np.abs(near - problem.uv[vertex]).max()
        for axis in (0, 1):
            step = np.zeros_like(problem.uv)
            step[vertex, axis] = h
            there, back = residuals(problem, problem.uv + step), residuals(problem, problem.uv - step)
            columns.append([(a - b) / (2.0 * h) for a, b in zip(there, back, strict=True)])
    areas, triangles = zip(*columns, strict=True)
    return np.array(areas).T, np.array(triangles).T


def filled(problem: Problem) -> tuple[PressureSystem, np.ndarray]:
    system = PressureSystem(problem.pattern)
    right = np.empty((len(problem.pattern.vertex), 3))
    fill_step(
        problem.uv, problem.cell, WEIGHT, problem.pattern.place, problem.pattern.diagonal,
        system.blocks, right,
    )  # fmt: skip
    return system, right


def test_every_share_goes_to_interior_vertices(problem: Problem) -> None:
    np.testing.assert_allclose(problem.cell.parts.sum(axis=1), problem.cell.share)
    assert (problem.cell.parts[problem.mesh.triangles < problem.mesh.n_boundary] == 0.0).all()
    assert problem.cell.target.sum() == pytest.approx(1.0)
    assert problem.cell.target.min() > 0.0


def test_the_energy_is_that_of_its_definition(problem: Problem) -> None:
    areas, triangles = residuals(problem, problem.uv)
    expected = (areas**2).sum() + (triangles**2).sum()
    assert averaged_energy(problem.uv, problem.cell, WEIGHT) == pytest.approx(expected, rel=1e-10)
    jacobians = np.einsum("tka,tkb->tab", problem.uv[problem.cell.triangles], problem.cell.hats)
    frobenius = (jacobians**2).sum(axis=(1, 2)) / np.linalg.det(jacobians) - 2.0
    shape = triangles[: 2 * len(frobenius)]
    assert (shape**2).sum() == pytest.approx(WEIGHT * (problem.cell.share * frobenius).sum())


def test_the_energy_of_a_flipped_triangle_is_infinite(problem: Problem) -> None:
    flipped = problem.uv.copy()
    flipped[-1] += 3.0
    assert averaged_energy(flipped, problem.cell, WEIGHT) == np.inf


def test_the_gradient_agrees_with_finite_differences(problem: Problem) -> None:
    _, right = filled(problem)
    (areas, triangles), (_, triangle_slopes) = residuals(problem, problem.uv), slopes(problem)
    np.testing.assert_allclose(right[:, 2], -areas, atol=1e-10)
    expected = -2.0 * (triangle_slopes.T @ triangles)
    np.testing.assert_allclose(right[:, :2].ravel(), expected, atol=1e-5 * np.abs(expected).max())


def test_the_step_is_that_of_the_dense_gauss_newton_matrix(problem: Problem) -> None:
    system, right = filled(problem)
    system.factorise()
    found = system.solve(right)
    (areas, triangles), (area_slopes, slopes_) = residuals(problem, problem.uv), slopes(problem)
    factor = np.repeat([SHAPE_CURVATURE, SHAPE_CURVATURE, 1.0], len(problem.cell.triangles))
    matrix = 2.0 * area_slopes.T @ area_slopes + 2.0 * slopes_.T @ (factor[:, None] * slopes_)
    gradient = 2.0 * (area_slopes.T @ areas + slopes_.T @ triangles)
    expected = -np.linalg.solve(matrix, gradient)
    np.testing.assert_allclose(found[:, :2].ravel(), expected, atol=1e-3 * np.abs(expected).max())
    pressure = 2.0 * (areas + area_slopes @ expected)
    np.testing.assert_allclose(found[:, 2], pressure, atol=1e-3 * np.abs(pressure).max())
    promised = (right[:, :2] * found[:, :2]).sum() + right[:, 2] @ (found[:, 2] + 2.0 * right[:, 2])
    assert promised == pytest.approx(-gradient @ expected, rel=1e-4)
