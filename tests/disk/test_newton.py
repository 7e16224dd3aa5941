"""What the relaxation with areas by vertex is for: maps that come out the same."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cytodisk import polar_windows, simulate
from cytodisk.arrays import FloatArray
from cytodisk.disk import newton
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.circle import angles_of_lengths
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.loading import load_map
from cytodisk.disk.mapping import map_mesh, map_to_disk
from cytodisk.disk.mapping_parameters import MapToDiskParameters
from cytodisk.disk.newton import relax
from cytodisk.disk.newton_triangles import relax_triangles
from cytodisk.errors import MapError
from cytodisk.geometry import mesh as mesh_module
from cytodisk.geometry import triangulation
from cytodisk.geometry.mesh import Mesh
from cytodisk.geometry.polygon import edge_lengths, smooth_closed

GRID = polar_windows(10, 60)


def five_arms() -> np.ndarray:
    """r = 35 (1 + 0.45 cos 5φ)."""
    y, x = np.mgrid[-55:56, -55:56]
    return np.hypot(x, y) <= 35.0 * (1.0 + 0.45 * np.cos(5.0 * np.arctan2(y, x)))


def same_when_mirrored(mask: np.ndarray, **options: str) -> float:
    """Share of the pixels that come into the same window when the cell is mirrored."""
    pixels = np.argwhere(mask).astype(float)
    here = GRID.window_of(map_to_disk(mask, **options).to_disk(pixels))
    pixels[:, 1] = mask.shape[1] - 1 - pixels[:, 1]
    there = map_to_disk(mask[:, ::-1], **options).to_disk(pixels) * [-1.0, 1.0]
    return float((here == GRID.window_of(there)).mean())


def test_a_mirrored_star_comes_into_the_same_windows() -> None:
    # Symmetric about its rows, so that the columns' mirror is another star: one arm points right.
    assert same_when_mirrored(five_arms()) >= 0.95


@pytest.mark.parametrize(
    ("mask", "most"),
    [
        (simulate.random_smooth(2, radius=30.0), 0.04),
        (simulate.migrating(2), 0.03),
        (simulate.star(arms=3, body_radius=16.0, arm_length=30.0), 0.09),
    ],
)
def test_windows_have_nearly_equal_areas(mask: np.ndarray, most: float) -> None:
    disk = map_to_disk(mask)
    assert disk.converged
    assert disk.certificate.valid
    assert GRID.on(disk).area_error < most
    assert GRID.on(map_to_disk(mask, method="harmonic")).area_error > 4.0 * most


# Steps, mean |ln λ| and the place of one pixel in the disk, as the version before areas by vertex had them.
BY_TRIANGLE = {
    ("smooth", 3): (2, 0.012736677732, (0.78093576, -0.36458011)),
    ("spiky", 3): (9, 0.344955261103, (-0.54664931, -0.74609357)),
}


@pytest.mark.parametrize(("kind", "seed"), BY_TRIANGLE)
def test_areas_by_triangle_give_the_maps_of_before(
    kind: str, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    # That version left the mesh as the triangulation gave it.
    monkeypatch.setattr(triangulation, "join_circles", lambda points, triangles, *_: triangles)
    monkeypatch.setattr(mesh_module, "even_out", lambda points, triangles, n_boundary: points)
    monkeypatch.setattr(triangulation, "distances", lambda points, n_boundary: np.zeros(len(points)))
    monkeypatch.setitem(mesh_module.mesh_inside.__kwdefaults__, "growth", 0.5)
    parameters = MapToDiskParameters.of(method="newton-triangles", shape_weight=0.005, edge_length=0.9)
    cell = mesh_cell(simulate.random_mask(kind, seed), parameters)
    # And it measured length on a copy of the outline smoothed over a pixel.
    lengths = np.maximum(edge_lengths(smooth_closed(cell.outline, 1.0)), 0.1 * edge_lengths(cell.outline))
    disk = map_mesh(cell, angles_of_lengths(cell.outline, lengths), parameters)
    steps, error, place = BY_TRIANGLE[kind, seed]
    assert (disk.method, disk.steps) == ("newton-triangles", steps)
    assert disk.distortion.area == pytest.approx(error, rel=1e-6)
    pixel = np.argwhere(disk.mask)[len(np.argwhere(disk.mask)) // 3]
    np.testing.assert_allclose(disk.to_disk(pixel.astype(float)), place, atol=1e-5)


@pytest.fixture(scope="module")
def disk() -> DiskMap:
    return map_to_disk(simulate.random_mask("spiky", 8))


def test_from_its_own_result_no_step_is_left(disk: DiskMap) -> None:
    mesh = Mesh(disk.vertices_yx, disk.triangles, len(disk.boundary))
    assert relax(mesh, disk.vertices_uv, disk.shape_weight).steps == 0
    assert relax_triangles(mesh, disk.vertices_uv, disk.shape_weight).steps > 0


def test_a_start_with_a_flipped_triangle_is_refused(disk: DiskMap) -> None:
    mesh = Mesh(disk.vertices_yx, disk.triangles, len(disk.boundary))
    flipped = disk.vertices_uv.copy()
    flipped[-1] += 3.0
    with pytest.raises(MapError, match="without flipped triangles"):
        relax(mesh, flipped, 0.005)


def test_a_map_that_an_earlier_version_wrote_says_how_it_was_made(disk: DiskMap, tmp_path: Path) -> None:
    disk.save(tmp_path / "new.npz")
    assert load_map(tmp_path / "new.npz").method == "newton"
    with np.load(tmp_path / "new.npz") as file:
        arrays = dict(file)
    header = json.loads(str(arrays["header"])) | {"format": 2}
    for name, meant in (("newton", "newton-triangles"), ("harmonic", "harmonic")):
        arrays["header"] = np.array(json.dumps(header | {"method": name}))
        np.savez(tmp_path / "old.npz", **arrays)
        assert load_map(tmp_path / "old.npz").method == meant


def test_a_step_that_would_climb_for_lost_digits_is_taken_with_a_raised_diagonal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """On this spiral, a matrix whose diagonal spans eleven powers of ten once gave a step uphill."""
    mask = simulate.random_mask("spiral_thick", 5014)
    assert map_to_disk(mask).converged
    found = newton._Problem.gauss_newton_direction
    tried = []

    def climbing(problem: Any, uv: FloatArray, damping: float = 0.0) -> tuple[FloatArray, float]:
        tried.append(damping)
        direction, decrement = found(problem, uv, damping)
        return (direction, decrement) if damping else (-direction, -max(decrement, 1.0))

    monkeypatch.setattr(newton._Problem, "gauss_newton_direction", climbing)
    assert map_to_disk(simulate.disk(12.0)).converged
    assert tried[:2] == list(newton._DAMPINGS[:2])


@pytest.mark.parametrize(
    ("mask", "least"),
    [
        (simulate.random_smooth(2, radius=30.0), 0.98),
        (simulate.star(arms=3, body_radius=16.0, arm_length=30.0), 0.9),
        (simulate.random_spiky(2, radius=20.0, spike_length=25.0), 0.85),
    ],
)
def test_what_steps_after_the_end_would_move(
    mask: np.ndarray, least: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended = map_to_disk(mask)
    monkeypatch.setattr(newton, "DECREMENT", 1e-7)
    exact = map_to_disk(mask)
    assert exact.converged
    assert exact.steps > ended.steps
    pixels = np.argwhere(mask).astype(float)
    windows = [GRID.window_of(disk.to_disk(pixels)) for disk in (ended, exact)]
    assert (windows[0] == windows[1]).mean() > least
    assert abs(GRID.on(ended).area_error - GRID.on(exact).area_error) < 0.01


@pytest.mark.parametrize("promised", [-1e-4, -1.0, np.nan])
def test_without_a_step_downhill_a_map_is_valid_but_not_converged(
    monkeypatch: pytest.MonkeyPatch, promised: float
) -> None:
    found = newton._Problem.gauss_newton_direction
    steps = []

    def lost(problem: Any, uv: FloatArray, damping: float = 0.0) -> tuple[FloatArray, float]:
        steps.append(uv)
        direction, decrement = found(problem, uv, damping)
        return (direction, decrement) if len(steps) == 1 else (-direction, promised)

    monkeypatch.setattr(newton._Problem, "gauss_newton_direction", lost)
    disk = map_to_disk(simulate.star(arms=3, body_radius=8.0, arm_length=12.0))
    assert disk.certificate.valid
    assert not disk.converged
    assert len({place.tobytes() for place in steps}) == 2  # the start, and where its one good step led


@pytest.mark.parametrize("kind", simulate.KINDS)
def test_a_converged_map_has_converged_at_the_given_shape_weight(kind: str) -> None:
    disk = map_to_disk(simulate.random_mask(kind, 21), shape_weight=0.01)
    again = relax(Mesh(disk.vertices_yx, disk.triangles, len(disk.boundary)), disk.vertices_uv, 0.01)
    assert disk.converged
    assert (again.steps, again.converged) == (0, True)
