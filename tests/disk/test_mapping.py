from pathlib import Path

import numpy as np
import pytest
import tifffile

from cytodisk import polar_windows, simulate
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.errors import MaskError, ParameterError

GRID = polar_windows(10, 60)
TARGETS = {  # largest area error of windows
    "example": 0.04,
    "disk60": 0.007,
    "ellipse5to1": 0.03,
    "star5": 0.09,
    "dumbbell3px": 0.13,
    "neuron": 0.40,
}


def assert_sound(disk: DiskMap) -> None:
    certificate = disk.certificate
    assert certificate.valid, certificate.faults
    assert certificate.flipped_in_cell == certificate.flipped_in_disk == ()
    pixels = np.argwhere(disk.mask).astype(float)
    uv = disk.to_disk(pixels)
    assert np.isfinite(uv).all()
    np.testing.assert_allclose(disk.to_cell(uv), pixels, atol=1e-9)


@pytest.mark.parametrize("name", TARGETS)
def test_reference_masks_meet_their_targets(data_dir: Path, name: str) -> None:
    disk = map_to_disk(tifffile.imread(data_dir / "reference_masks" / f"{name}.tif"))
    assert_sound(disk)
    assert disk.converged
    assert GRID.on(disk).area_error <= TARGETS[name]


def test_a_disk_maps_nearly_to_itself() -> None:
    mask = simulate.disk(60.0)
    disk = map_to_disk(mask)
    pixels = np.argwhere(mask).astype(float)
    expected = (pixels - 68.0)[:, ::-1] / np.sqrt(mask.sum() / np.pi)
    away = np.hypot(*(disk.to_disk(pixels) - expected).T)
    # The pixel outline is off the circle by up to 0.7 px of 60 (0.012), and a stair step's arc
    # length puts its boundary point off by about as much along the circle.
    assert away.max() < 0.024
    assert np.median(away) < 0.006


@pytest.mark.parametrize("axes", [(30.0, 60.0), (20.0, 100.0)])
def test_the_equiareal_map_of_an_ellipse_keeps_area(axes: tuple[float, float]) -> None:
    disk = map_to_disk(simulate.ellipse(axes))
    assert GRID.on(disk).area_error < 0.035
    assert disk.distortion.area_percentiles[1] > 0.7
    assert disk.distortion.area_percentiles[99] < 1.3
    by_triangle = map_to_disk(simulate.ellipse(axes), method="newton-triangles").distortion
    assert by_triangle.area < 0.035
    assert by_triangle.area_percentiles[1] > 0.85
    assert by_triangle.area_percentiles[99] < 1.15


def test_relaxing_only_moves_the_interior_and_lowers_the_area_error() -> None:
    mask = simulate.migrating(2)
    before, after = map_to_disk(mask, method="harmonic"), map_to_disk(mask)
    n = len(before.boundary)
    np.testing.assert_array_equal(before.vertices_uv[:n], after.vertices_uv[:n])
    assert GRID.on(after).area_error < 0.1 * GRID.on(before).area_error
    assert after.distortion.area < 0.2 * before.distortion.area
    assert (before.steps, after.converged) == (0, True)


def test_shape_weight_trades_area_for_angle() -> None:
    mask = simulate.star(arms=3, body_radius=15.0, arm_length=20.0)
    maps = [map_to_disk(mask, shape_weight=weight) for weight in (0.002, 0.05, 1.0)]
    areas = [GRID.on(disk).area_error for disk in maps]
    angles = [disk.distortion.angle for disk in maps]
    assert areas == sorted(areas)
    assert angles == sorted(angles, reverse=True)


def test_two_runs_are_equal_bit_by_bit() -> None:
    mask = simulate.random_mask("spiky", 11)
    one, two = map_to_disk(mask), map_to_disk(mask)
    np.testing.assert_array_equal(one.vertices_uv, two.vertices_uv)
    np.testing.assert_array_equal(one.triangles, two.triangles)


def test_a_shift_by_whole_pixels_changes_nothing_but_the_place() -> None:
    mask = np.pad(simulate.random_smooth(3, radius=20.0), 10)
    here = map_to_disk(mask)
    there = map_to_disk(np.roll(mask, (7, -9), axis=(0, 1)))
    np.testing.assert_array_equal(there.vertices_uv, here.vertices_uv)
    np.testing.assert_allclose(there.vertices_yx, here.vertices_yx + np.array([7, -9]), atol=1e-12)
    tail = np.argwhere(mask)[0]
    align = float(tail[0]), float(tail[1])
    moved = align[0] + 7, align[1] - 9
    np.testing.assert_array_equal(
        map_to_disk(mask, align=align).vertices_uv,
        map_to_disk(np.roll(mask, (7, -9), axis=(0, 1)), align=moved).vertices_uv,
    )


@pytest.mark.parametrize("seed", range(3))
def test_a_quarter_turn_of_the_mask_turns_the_disk(seed: int) -> None:
    mask = simulate.random_smooth(seed, radius=40.0)
    here, turned = map_to_disk(mask), map_to_disk(np.rot90(mask))
    pixels = np.argwhere(mask).astype(float)
    # np.rot90 takes (row, column) to (last column - column, row), which is (u, v) → (v, -u).
    after = turned.to_disk(np.column_stack([mask.shape[1] - 1 - pixels[:, 1], pixels[:, 0]]))
    before = here.to_disk(pixels)
    away = np.hypot(*(after - np.column_stack([before[:, 1], -before[:, 0]])).T)
    # The boundary turns exactly; the mesh's lattice does not. Many maps keep area, and the small shape weight
    # chooses among them only weakly, so that another mesh inside moves points by some hundredths.
    assert away.max() < 0.15
    assert np.median(away) < 0.03
    np.testing.assert_allclose(
        sorted(np.exp(1j * turned.boundary_angles) * 1j, key=np.angle),
        sorted(np.exp(1j * here.boundary_angles), key=np.angle),
        atol=1e-9,
    )


def test_the_disk_is_not_mirrored() -> None:
    mask = simulate.migrating(0)
    disk = map_to_disk(mask)
    centre = np.argwhere(mask).mean(axis=0)
    right, below = disk.to_disk(centre + np.array([[0.0, 30.0], [30.0, 0.0]]))
    assert right[0] > abs(right[1])
    assert below[1] > abs(below[0])


def test_angle_alignment_turns_the_whole_map() -> None:
    mask = simulate.random_mask("smooth", 4)
    upright, turned = map_to_disk(mask), map_to_disk(mask, align=90.0)
    expected = np.column_stack([-upright.vertices_uv[:, 1], upright.vertices_uv[:, 0]])
    np.testing.assert_allclose(turned.vertices_uv, expected, atol=1e-6)


def test_the_report_of_cleaning_comes_with_the_map() -> None:
    mask = simulate.disk(10.0)
    mask[18, 18] = False
    mask[0, 0] = True
    disk = map_to_disk(mask)
    assert (disk.report.holes, disk.report.components) == (1, 2)
    assert disk.mask[18, 18]
    assert not disk.mask[0, 0]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"method": "magic"}, "method must be .*, got 'magic'"),
        (
            {"shape_weight": 0.0},
            "shape_weight must be a number above 0 and at most 1000000, got 0.0: 0.003 is the default",
        ),
        ({"shape_weight": np.nan}, "shape_weight must be a number above 0 and at most 1000000, got nan"),
        ({"edge_length": 0.1}, "edge_length must be a number from 0.25 to 10, got 0.1"),
        ({"align": "left"}, "align must be 'upright', 'nucleus', a point .* got 'left'"),
    ],
)
def test_bad_parameters_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        map_to_disk(np.ones((5, 5), dtype=bool), **change)


def test_a_stack_is_refused() -> None:
    with pytest.raises(MaskError, match="mask must be 2D"):
        map_to_disk(np.ones((2, 5, 5)))


def test_a_text_is_no_angle() -> None:
    with pytest.raises(ParameterError, match=r"align.*got '2'"):
        map_to_disk(np.ones((9, 9), dtype=bool), align="2")
