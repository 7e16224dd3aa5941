from collections.abc import Callable
from functools import cache

import numpy as np
import pytest

from cytodisk import simulate
from cytodisk.disk.cell_mesh import CellMesh, mesh_cell
from cytodisk.disk.certificate import certify
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.mapping import map_mesh
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.untangle import untangled
from cytodisk.geometry.mesh import Mesh, triangle_areas


@cache
def valid_map(kind: str = "smooth") -> tuple[CellMesh, np.ndarray]:
    cell = mesh_cell(simulate.random_mask(kind, 3), MappingParameters(edge_length=1.5))
    angles = boundary_angles(cell.outline)
    return cell, map_mesh(cell, angles, MappingParameters()).vertices_uv


def flipped(mesh: Mesh, uv: np.ndarray) -> np.ndarray:
    return np.flatnonzero(triangle_areas(uv[:, ::-1], mesh.triangles) <= 0.0)


def deep_inside(mesh: Mesh, uv: np.ndarray, count: int, seed: int) -> np.ndarray:
    inner = np.flatnonzero(np.hypot(*uv.T) < 0.8)
    chosen: np.ndarray = np.random.default_rng(seed).choice(inner[inner >= mesh.n_boundary], count, False)
    return chosen


def share(mesh: Mesh) -> np.ndarray:
    """Of the disk, that each triangle has in the cell."""
    areas = triangle_areas(mesh.vertices_yx, mesh.triangles)
    return np.pi * areas / areas.sum()


def pushed_over_a_neighbour(mesh: Mesh, uv: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """The map with some vertices a little beyond one of those that they share an edge with."""
    spoilt = uv.copy()
    for vertex in vertices:
        around = np.unique(mesh.triangles[(mesh.triangles == vertex).any(axis=1)])
        other = around[around != vertex][0]
        spoilt[vertex] += 1.3 * (uv[other] - uv[vertex])
    return spoilt


def within(mesh: Mesh, vertices: np.ndarray, rings: int) -> np.ndarray:
    """Whether each vertex is reached from some vertices by that many edges."""
    reached = np.zeros(len(mesh.vertices_yx), dtype=bool)
    reached[vertices] = True
    for _ in range(rings):
        reached[mesh.triangles[reached[mesh.triangles].any(axis=1)]] = True
    return reached


@pytest.mark.parametrize("kind", ["smooth", "spiky"])
def test_a_valid_map_comes_back_as_it_is(kind: str) -> None:
    cell, uv = valid_map(kind)
    found = untangled(cell.mesh, uv)
    assert found is not None
    np.testing.assert_array_equal(found, uv)


@pytest.mark.parametrize("count", [1, 5, 20])
def test_pushed_vertices_are_mended_and_the_rest_stays(count: int) -> None:
    cell, uv = valid_map()
    pushed = deep_inside(cell.mesh, uv, count, seed=count)
    spoilt = pushed_over_a_neighbour(cell.mesh, uv, pushed)
    assert len(flipped(cell.mesh, spoilt)) >= count
    before = spoilt.copy()
    found = untangled(cell.mesh, spoilt)
    assert found is not None
    assert len(flipped(cell.mesh, found)) == 0
    n = cell.mesh.n_boundary
    assert certify(cell.mesh.vertices_yx, found, cell.mesh.triangles, np.arange(n)).valid
    np.testing.assert_array_equal(found[:n], uv[:n])
    np.testing.assert_array_equal(spoilt, before)
    moved = (found != spoilt).any(axis=1)
    reached = within(cell.mesh, pushed, 6)
    assert moved[pushed].any()
    assert not moved[~reached].any()


def test_mended_triangles_have_a_tenth_of_their_share_or_half_of_what_they_had() -> None:
    cell, uv = valid_map()
    spoilt = pushed_over_a_neighbour(cell.mesh, uv, deep_inside(cell.mesh, uv, 3, seed=4))
    found = untangled(cell.mesh, spoilt)
    assert found is not None
    before, after = (triangle_areas(a[:, ::-1], cell.mesh.triangles) for a in (spoilt, found))
    tenth = 0.1 * share(cell.mesh)
    assert (after >= np.where(before > 0.0, np.minimum(tenth, 0.5 * before), tenth) * (1.0 - 1e-9)).all()


def test_a_vertex_without_a_place_is_hopeless() -> None:
    cell, uv = valid_map()
    spoilt = uv.copy()
    spoilt[deep_inside(cell.mesh, uv, 3, seed=1)] = np.nan
    assert untangled(cell.mesh, spoilt) is None


def test_a_boundary_that_runs_backwards_is_hopeless() -> None:
    cell, uv = valid_map()
    mirrored = uv * [1.0, -1.0]
    assert len(flipped(cell.mesh, mirrored)) == len(cell.mesh.triangles)
    assert untangled(cell.mesh, mirrored) is None


@pytest.mark.parametrize("spoil", [lambda uv: -uv, lambda uv: np.full_like(uv, 5.0), lambda uv: uv[::-1]])
def test_a_map_starts_from_any_anchor(spoil: Callable[[np.ndarray], np.ndarray]) -> None:
    cell, uv = valid_map()
    disk = map_mesh(
        cell, boundary_angles(cell.outline), MappingParameters(), anchor_uv=spoil(uv), inertia=1.0
    )
    assert disk.converged
    assert disk.certificate.valid


def test_an_anchor_that_cannot_be_mended_is_no_start(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("cytodisk.disk.mapping.untangled", lambda mesh, uv: None)
    cell, uv = valid_map()
    disk = map_mesh(cell, boundary_angles(cell.outline), MappingParameters(), anchor_uv=uv, inertia=1.0)
    assert disk.start in ("cotangent", "uniform")
    assert disk.certificate.valid
