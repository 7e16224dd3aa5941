from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.certificate import certify
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.newton import Relaxed, relax
from cytodisk.geometry.mesh import Mesh, hat_gradients, triangle_areas

WEIGHT = 0.005
INERTIAS = (0.0, 0.1, 1.0, 10.0, 1000.0)


@cache
def start(kind: str = "smooth") -> tuple[Mesh, np.ndarray]:
    cell = mesh_cell(simulate.random_mask(kind, 3), MappingParameters(edge_length=1.5))
    angles = boundary_angles(cell.outline)
    return cell.mesh, harmonic_map(cell.mesh, np.column_stack([np.cos(angles), np.sin(angles)]))[0]


@cache
def anchor(kind: str = "smooth") -> np.ndarray:
    """The inside of the equiareal map, swirled: no vertex on the circle moves."""
    mesh, uv = start(kind)
    equiareal = relax(mesh, uv, WEIGHT).vertices_uv
    turn = 0.5 * np.clip(1.0 - np.hypot(*equiareal.T), 0.0, 1.0)
    u, v = equiareal.T
    return np.column_stack([np.cos(turn) * u - np.sin(turn) * v, np.sin(turn) * u + np.cos(turn) * v])


@cache
def anchored(inertia: float, kind: str = "smooth") -> Relaxed:
    mesh, uv = start(kind)
    return relax(mesh, uv, WEIGHT, anchor(kind), inertia)


def away(uv: np.ndarray, kind: str = "smooth") -> float:
    """Mean squared distance from the anchor; each vertex has a third of its triangles' area in the cell."""
    mesh, _ = start(kind)
    shares = np.repeat(triangle_areas(mesh.vertices_yx, mesh.triangles) / 3.0, 3)
    weight = np.bincount(mesh.triangles.ravel(), shares, len(uv))
    return float((weight * np.square(uv - anchor(kind)).sum(axis=1)).sum() / weight.sum())


def own_energy(mesh: Mesh, uv: np.ndarray) -> float:
    """Plain twin: mean of (log det J)² + weight · |J|² / det J, by area in the cell."""
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    scale = np.sqrt(triangle_areas(start()[1][:, ::-1], mesh.triangles).sum() / areas.sum())
    hats = hat_gradients(mesh.vertices_yx * scale, mesh.triangles)
    jacobians = np.einsum("fka,fkb->fab", uv[:, ::-1][mesh.triangles], hats)
    determinants = np.linalg.det(jacobians)
    shape = (jacobians**2).sum(axis=(1, 2)) / np.abs(determinants)
    return float((areas * (np.log(np.abs(determinants)) ** 2 + WEIGHT * shape)).sum() / areas.sum())


def test_inertia_pulls_towards_the_anchor() -> None:
    distances = [away(anchored(inertia).vertices_uv) for inertia in INERTIAS]
    assert distances == sorted(distances, reverse=True)
    assert distances[1] < 0.99 * distances[0]
    assert distances[-1] < 0.01 * distances[0]


def test_equal_areas_are_given_up_for_it() -> None:
    mesh, _ = start()
    energies = [own_energy(mesh, anchored(inertia).vertices_uv) for inertia in INERTIAS]
    # A map for more inertia is no better by the energy without it.
    assert all(b >= a - 1e-4 for a, b in pairwise(energies))
    assert energies[-1] > energies[0]


@pytest.mark.parametrize("kind", ["smooth", "spiky"])
def test_no_inertia_is_no_anchor(kind: str) -> None:
    mesh, uv = start(kind)
    np.testing.assert_array_equal(anchored(0.0, kind).vertices_uv, relax(mesh, uv, WEIGHT).vertices_uv)
    assert anchored(0.0, kind).steps == relax(mesh, uv, WEIGHT).steps


def test_inertia_without_an_anchor_does_nothing() -> None:
    mesh, uv = start()
    np.testing.assert_array_equal(
        relax(mesh, uv, WEIGHT, None, 5.0).vertices_uv, relax(mesh, uv, WEIGHT).vertices_uv
    )


@pytest.mark.parametrize("kind", ["smooth", "spiky"])
@pytest.mark.parametrize("inertia", [1.0, 1e3, 1e6])
def test_the_certificate_stays_valid(kind: str, inertia: float) -> None:
    mesh, uv = start(kind)
    relaxed = anchored(inertia, kind)
    assert relaxed.converged
    loop = np.arange(mesh.n_boundary)
    assert certify(mesh.vertices_yx, relaxed.vertices_uv, mesh.triangles, loop).valid
    np.testing.assert_array_equal(relaxed.vertices_uv[: mesh.n_boundary], uv[: mesh.n_boundary])


def test_an_anchor_that_flips_triangles_cannot_make_the_map_flip() -> None:
    mesh, uv = start()
    mirrored = uv * [1.0, -1.0]
    relaxed = relax(mesh, uv, WEIGHT, mirrored, 100.0)
    assert certify(mesh.vertices_yx, relaxed.vertices_uv, mesh.triangles, np.arange(mesh.n_boundary)).valid


def test_an_equiareal_anchor_is_where_it_stays() -> None:
    mesh, uv = start()
    rest = relax(mesh, uv, WEIGHT).vertices_uv
    found = relax(mesh, uv, WEIGHT, rest, 10.0).vertices_uv
    assert np.hypot(*(found - rest).T).max() < 0.02
    again = relax(mesh, rest, WEIGHT, rest, 10.0)
    assert again.steps == 0


def test_the_start_matters_little_when_the_anchor_holds() -> None:
    mesh, uv = start()
    one = relax(mesh, uv, WEIGHT, anchor(), 10.0).vertices_uv
    other = relax(mesh, relax(mesh, uv, WEIGHT).vertices_uv, WEIGHT, anchor(), 10.0).vertices_uv
    assert np.hypot(*(one - other).T).max() < 0.02
