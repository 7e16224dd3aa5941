import pickle
from pathlib import Path

import numpy as np
import pytest
from scipy import sparse

from cytodisk import simulate
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.by_advection import advection_field as kernels
from cytodisk.disk.by_advection.advection import STEPS, advect
from cytodisk.disk.by_advection.poisson import TOLERANCE, PoissonSolver
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.distortion import distortion_of
from cytodisk.disk.harmonic import harmonic_map
from cytodisk.disk.loading import load_map
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.geometry.half_edges import half_edges
from cytodisk.geometry.mesh import triangle_areas
from cytodisk.motion.map_movie import map_movie
from cytodisk.windows.polar_windows import polar_windows


@pytest.fixture(scope="module")
def star() -> DiskMap:
    """A shape on which triangles turn over."""
    return map_to_disk(
        simulate.star(arms=4, body_radius=8.0, arm_length=14.0), method="advection", edge_length=1.5
    )


@pytest.mark.parametrize(
    "mask", [simulate.disk(25.0), simulate.ellipse((12.0, 30.0))], ids=["disk", "ellipse"]
)
def test_it_lowers_the_area_error_of_its_start(mask: np.ndarray) -> None:
    cell = mesh_cell(mask, MappingParameters(method="advection"))
    disk = map_to_disk(mask, method="advection")
    circle = disk.vertices_uv[disk.boundary]
    start, _ = harmonic_map(cell.mesh, circle)
    before = distortion_of(cell.mesh.vertices_yx, start, cell.mesh.triangles)
    assert disk.distortion.area < before.area
    assert (disk.steps, disk.start, disk.method) == (STEPS, "cotangent", "advection")


def test_on_an_ellipse_most_of_the_area_error_goes() -> None:
    mask = simulate.ellipse((12.0, 30.0))
    harmonic = map_to_disk(mask, method="harmonic")
    assert map_to_disk(mask, method="advection").distortion.area < 0.4 * harmonic.distortion.area


def test_the_boundary_stays_where_the_harmonic_map_has_it(star: DiskMap) -> None:
    harmonic = map_to_disk(star.mask, method="harmonic", edge_length=1.5)
    n = len(harmonic.boundary)
    np.testing.assert_array_equal(star.boundary, harmonic.boundary)
    np.testing.assert_array_equal(star.vertices_uv[:n], harmonic.vertices_uv[:n])


def test_the_certificate_names_exactly_the_turned_triangles(star: DiskMap) -> None:
    areas = triangle_areas(star.vertices_uv[:, ::-1], star.triangles)
    certificate = star.certificate
    assert certificate.flipped_in_disk == tuple(np.flatnonzero(areas <= 0))
    assert len(certificate.flipped_in_disk) > 0
    assert not certificate.valid
    assert certificate.faults == (
        f"{len(certificate.flipped_in_disk)} triangles are not positive in the disk",
    )


def test_on_a_disk_it_is_valid() -> None:
    assert map_to_disk(simulate.disk(15.0), method="advection").certificate.valid


@pytest.mark.parametrize("method", ["newton", "harmonic"])
def test_the_other_methods_stay_valid_where_it_is_not(star: DiskMap, method: str) -> None:
    assert map_to_disk(star.mask, method=method, edge_length=1.5).certificate.valid  # type: ignore[arg-type]


def test_the_flipped_mesh_is_a_triangulation_of_the_cell(star: DiskMap) -> None:
    before = mesh_cell(star.mask, MappingParameters(edge_length=1.5, method="advection")).mesh
    areas = triangle_areas(star.vertices_yx, star.triangles)
    assert not np.array_equal(star.triangles, before.triangles)
    assert areas.min() > 0
    np.testing.assert_allclose(areas.sum(), triangle_areas(before.vertices_yx, before.triangles).sum())
    assert half_edges(star.triangles, len(star.vertices_yx)).euler_characteristic == 1


def test_an_invalid_map_gives_finite_points_both_ways(star: DiskMap) -> None:
    inside = star.to_disk(np.argwhere(star.mask))
    assert np.isfinite(inside).all()
    assert np.hypot(*inside.T).max() <= 1.0 + 1e-12
    spread = np.sqrt(np.linspace(0.0, 1.0, 3000))[:, None]
    angle = np.linspace(0.0, 300.0, 3000)[:, None]
    back = star.to_cell(spread * np.hstack([np.cos(angle), np.sin(angle)]))
    assert np.isfinite(back).all()
    again = star.to_disk(back)  # whichever triangle held a point, it lies there
    np.testing.assert_allclose(again, spread * np.hstack([np.cos(angle), np.sin(angle)]), atol=1e-6)
    assert np.isfinite(star.distortion.area)
    assert np.isfinite(star.distortion.triangle_stretch).all()


@pytest.mark.parametrize("spacing", ["area", "radius"])
def test_windows_on_an_invalid_map_sum_to_the_cell(star: DiskMap, spacing: str) -> None:
    windows = polar_windows(20, 60, spacing).on(star)  # type: ignore[arg-type]
    np.testing.assert_allclose(windows.areas.sum(), star.mask.sum())
    assert (windows.areas > 0).all()
    assert all(np.isfinite(polygon).all() for polygon in windows.polygons())


def test_it_is_saved_and_loaded(star: DiskMap, tmp_path: Path) -> None:
    star.save(tmp_path / "a.npz")
    for copy in (load_map(tmp_path / "a.npz"), pickle.loads(pickle.dumps(star))):
        assert (copy.method, copy.steps) == ("advection", STEPS)
        assert copy.certificate == star.certificate
        np.testing.assert_array_equal(copy.vertices_uv, star.vertices_uv)


@pytest.mark.parametrize(
    "mask",
    [np.ones((1, 1)), np.ones((1, 12)), np.eye(6), np.ones((2, 2))],
    ids=["pixel", "line", "diagonal", "square"],
)
def test_the_smallest_cells(mask: np.ndarray) -> None:
    disk = map_to_disk(mask.astype(bool), method="advection")
    assert np.isfinite(disk.vertices_uv).all()
    assert np.isfinite(disk.distortion.area)
    assert np.isfinite(disk.to_disk(np.argwhere(disk.mask))).all()


def test_a_movie_takes_it() -> None:
    mask = simulate.disk(8.0)
    movie = map_movie(np.stack([mask, np.roll(mask, 1, axis=1)]), method="advection")
    assert [movie[t].method for t in (0, 1)] == ["advection", "advection"]
    assert all(movie[t].certificate.valid for t in (0, 1))


def tangled(seed: int) -> tuple[FloatArray, FloatArray, IntArray, int]:
    """A small mesh with some triangles turned over in the disk, one of them without area."""
    mesh = mesh_cell(simulate.disk(5.0), MappingParameters(edge_length=1.5, method="advection")).mesh
    angle = 2.0 * np.pi * np.arange(mesh.n_boundary) / mesh.n_boundary
    uv, _ = harmonic_map(mesh, np.column_stack([np.cos(angle), np.sin(angle)]))
    uv[mesh.n_boundary :] += 0.05 * np.random.default_rng(seed).standard_normal(uv[mesh.n_boundary :].shape)
    uv[mesh.triangles[-1]] = uv[mesh.triangles[-1, 0]]
    return mesh.vertices_yx, uv, mesh.triangles, mesh.n_boundary


def test_kernels_agree_with_their_plain_twins() -> None:
    _, uv, triangles, _ = tangled(0)
    n = len(uv)
    areas = kernels.signed_areas(uv, triangles)
    np.testing.assert_allclose(areas, triangle_areas(uv[:, ::-1], triangles), atol=1e-15)
    assert areas.min() < 0

    weights, sizes = kernels.edge_cotangents(uv, triangles, areas)
    corner = uv[triangles]
    squares = sum(np.square(corner[:, k] - corner[:, k - 1]).sum(axis=1) for k in range(3))
    plain_sizes = np.maximum(np.maximum(np.abs(areas), 0.01 * squares), 1e-300)
    np.testing.assert_allclose(sizes, plain_sizes)
    for k in range(3):
        opposite = corner[:, (k + 2) % 3]
        to_a, to_b = corner[:, k] - opposite, corner[:, (k + 1) % 3] - opposite
        np.testing.assert_allclose(weights[:, k], (to_a * to_b).sum(axis=1) / (4.0 * plain_sizes))

    field = np.random.default_rng(1).standard_normal(n)
    laplacian = np.zeros((n, n))
    for t in range(len(triangles)):
        for k in range(3):
            a, b = triangles[t, k], triangles[t, (k + 1) % 3]
            laplacian[[a, b], [b, a]] -= weights[t, k]
            laplacian[[a, b], [a, b]] += weights[t, k]
    np.testing.assert_allclose(
        kernels.laplacian_times(weights, triangles, field), laplacian @ field, atol=1e-9
    )
    assert np.linalg.eigvalsh(laplacian).min() > -1e-9

    factors, raised = kernels.area_factors(areas)
    mean = (factors * raised).sum() / raised.sum()
    sources = np.bincount(triangles.ravel(), np.repeat(raised * (mean - factors) / 3, 3), minlength=n)
    np.testing.assert_allclose(kernels.vertex_sources(factors, raised, triangles, n), sources, atol=1e-12)
    np.testing.assert_allclose(sources.sum(), 0.0, atol=1e-12)
    assert factors.max() <= kernels.LARGEST_FACTOR + 1e-9

    gradients = kernels.vertex_gradients(field, uv, triangles, areas, sizes)
    onto = sparse.csr_array(
        (np.ones(triangles.size), (triangles.ravel(), np.arange(len(triangles)).repeat(3))),
        (n, len(triangles)),
    )
    turned = np.where(areas > 0, 1.0, -1.0)
    rotated = np.stack([np.roll(corner, -1, 1) - np.roll(corner, -2, 1)], -1)[..., 0][..., ::-1] * [1.0, -1.0]
    per_face = 0.5 * turned[:, None] * (field[triangles][..., None] * rotated).sum(axis=1)
    np.testing.assert_allclose(gradients, (onto @ per_face) / (onto @ sizes)[:, None], atol=1e-9)


def test_the_gradient_of_a_linear_field_is_constant() -> None:
    mesh = mesh_cell(simulate.disk(5.0), MappingParameters(edge_length=1.5, method="advection")).mesh
    uv = np.ascontiguousarray(mesh.vertices_yx[:, ::-1])
    areas = kernels.signed_areas(uv, mesh.triangles)
    _, sizes = kernels.edge_cotangents(uv, mesh.triangles, areas)
    gradients = kernels.vertex_gradients(uv @ [2.0, -3.0], uv, mesh.triangles, areas, sizes)
    np.testing.assert_allclose(gradients, np.tile([2.0, -3.0], (len(uv), 1)), atol=1e-9)


def test_the_solver_solves_one_system_after_another() -> None:
    _, uv, triangles, _ = tangled(2)
    solver = PoissonSolver(len(uv))
    for seed in range(4):
        moved = uv + 0.02 * np.random.default_rng(seed).standard_normal(uv.shape)
        weights, _ = kernels.edge_cotangents(moved, triangles, kernels.signed_areas(moved, triangles))
        right = np.random.default_rng(seed).standard_normal(len(uv))
        right -= right.mean()
        field = solver.solve(weights, triangles, right)
        assert field[0] == 0.0
        off = kernels.laplacian_times(weights, triangles, field) - right
        assert np.linalg.norm(off) < 2.0 * TOLERANCE * np.linalg.norm(right)


def test_small_triangles_grow() -> None:
    _, _, triangles, n_boundary = tangled(0)
    mesh = mesh_cell(simulate.disk(5.0), MappingParameters(edge_length=1.5, method="advection")).mesh
    angle = 2.0 * np.pi * np.arange(n_boundary) / n_boundary
    uv, _ = harmonic_map(mesh, np.column_stack([np.cos(angle), np.sin(angle)]))
    squeezed = uv * (0.3 + 0.7 * np.hypot(*uv.T) ** 2)[:, None]  # small in the middle, the boundary as it is
    squeezed[:n_boundary] = uv[:n_boundary]
    before = kernels.signed_areas(squeezed, triangles)
    after = advect(mesh, squeezed, steps=5)
    smallest = np.argsort(before)[:5]
    still = (after.triangles[smallest] == triangles[smallest]).all(axis=1)
    assert still.any()
    grown = kernels.signed_areas(after.vertices_uv, after.triangles)[smallest][still]
    assert (grown > before[smallest][still]).all()


def test_flips_that_may_break_the_cell_mend_the_disk(star: DiskMap) -> None:
    cell = mesh_cell(star.mask, MappingParameters(edge_length=1.5, method="advection"))
    start, _ = harmonic_map(cell.mesh, star.vertices_uv[star.boundary])
    free = advect(cell.mesh, start, whole_cell=False)
    turned_in_disk = (triangle_areas(free.vertices_uv[:, ::-1], free.triangles) <= 0).sum()
    turned_in_cell = (triangle_areas(cell.mesh.vertices_yx, free.triangles) <= 0).sum()
    assert turned_in_disk < len(star.certificate.flipped_in_disk)
    assert turned_in_cell > 0
