"""Shapes whose features are known on paper."""

import numpy as np
import pandas as pd
import pytest
from drawn_shapes import ellipse, rectangle, star, turned

import cytodisk as cd
from cytodisk.analysis.shape.cell_shape import crop_shape, even_steps
from cytodisk.analysis.shape.curvature_features import turn_of_runs, turning
from cytodisk.analysis.shape.distortion_features import coarse_mesh, measure_distortion
from cytodisk.analysis.shape.skeleton import pruned, skeleton_of
from cytodisk.arrays import BoolArray
from cytodisk.geometry.mesh import mesh_inside


def features(mask: BoolArray) -> pd.Series:
    return cd.shape_features(mask).iloc[0]


def test_disk() -> None:
    found = features(ellipse(50, 50))
    expected = {
        "area": np.pi * 2500, "perimeter": 100 * np.pi, "convex_area": np.pi * 2500, "feret_max": 100,
        "feret_min": 100, "major_axis": 100, "minor_axis": 100, "inscribed_radius": 50, "mean_depth": 50 / 3,
        "circularity": 1, "solidity": 1, "convexity": 1, "aspect_ratio": 1, "extent": np.pi / 4,
        "roundness": 1, "roughness": 1, "moment_11": 1 / (2 * np.pi), "moment_22": 1 / (3 * np.pi**2),
        "hu_1": np.log10(1 / (2 * np.pi)), "curvature_size": 1, "depth_max": 1, "depth_mean": 1 / 3,
        "depth_p50": 1 - np.sqrt(0.5), "skeleton_width": 1, "harmonic_inner": 0.5,
    }  # fmt: skip
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=0.035), name
    for name in ("radius_variation", "outside_ellipse", "moment_20", "moment_30", "fourier_1", "fourier_3",
                 "fourier_fine", "concave_share", "concave_turn", "thin_40", "skeleton_length",
                 "harmonic_area_error", "harmonic_angle_error"):  # fmt: skip
        assert found[name] == pytest.approx(0, abs=0.015), name
    assert found[["tips", "bays", "skeleton_tips"]].tolist() == [0, 0, 0]


@pytest.mark.parametrize("angle", [0.0, 0.6])
def test_ellipse(angle: float) -> None:
    a, b = 80.0, 40.0
    found = features(ellipse(a, b, angle))
    expected = {
        "area": np.pi * a * b, "major_axis": 2 * a, "minor_axis": 2 * b, "feret_max": 2 * a,
        "feret_min": 2 * b, "rectangle_length": 2 * a, "rectangle_width": 2 * b, "inscribed_radius": b,
        "eccentricity": np.sqrt(0.75), "aspect_ratio": 2, "feret_aspect": 2, "solidity": 1,
        "extent": np.pi / 4, "roundness": 0.5, "radius_max": np.sqrt(2), "radius_min": np.sqrt(0.5),
        "moment_20": (a**2 - b**2) / (4 * np.pi * a * b), "moment_11": (a**2 + b**2) / (4 * np.pi * a * b),
        "curvature_max": (a / b) ** 1.5,
    }  # fmt: skip
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=0.06 if name == "curvature_max" else 0.025), name
    assert found["fourier_2"] < 0.005  # it looks the same after half a turn
    assert found[["bays", "skeleton_tips"]].tolist() == [0, 2]


def test_a_slim_ellipse_has_two_tips() -> None:
    assert features(ellipse(100, 20, 0.4))["tips"] == 2


@pytest.mark.parametrize("angle", [0.0, 0.5])
def test_rectangle(angle: float) -> None:
    a, b = 121.0, 61.0  # pixels from the first centre to the last, and half a one beyond on both sides
    found = features(rectangle(a - 1, b - 1, angle))
    expected = {
        "rectangle_length": a, "rectangle_width": b, "rectangle_aspect": a / b, "extent": 1, "solidity": 1,
        "major_axis": 4 * a / np.sqrt(12), "minor_axis": 4 * b / np.sqrt(12), "inscribed_radius": b / 2,
        "perimeter": 2 * (a + b), "feret_max": np.hypot(a, b), "circularity": np.pi * a * b / (a + b) ** 2,
        # The volume under a hip roof of slope 1 over its ground.
        "mean_depth": b * (3 * a - b) / (12 * a),
    }  # fmt: skip
    for name, value in expected.items():
        assert found[name] == pytest.approx(value, rel=0.04), name
    assert found["hu_3"] < -3  # symmetric, so no third moments
    assert found[["tips", "bays", "skeleton_tips"]].tolist() == [0, 0, 2]  # a right angle is no tip


@pytest.mark.parametrize("arms", [3, 5, 8])
def test_a_star_has_as_many_tips_bays_and_ends_as_arms(arms: int) -> None:
    found = features(star(arms, 90, 0.15 if arms == 3 else 0.3))
    assert found[["tips", "bays", "skeleton_tips"]].tolist() == [arms] * 3
    harmonics = found[[f"fourier_{k}" for k in range(2, 10)]].to_numpy(float)
    assert 2 + harmonics.argmax() in (arms - 1, arms + 1)


def test_a_spiky_cell_is_thin_and_a_filopodium_counts_by_its_area() -> None:
    mask = np.zeros((120, 300), dtype=bool)
    mask[10:110, 10:110] = True
    mask[55:61, 110:290] = True
    found = features(mask)
    assert found["thin_10"] == pytest.approx(180 * 6 / (180 * 6 + 100 * 100), abs=0.01)
    assert found["tips"] == 1


def test_even_steps_go_once_around() -> None:
    square = np.array([[0.0, 0.0], [0.0, 4.0], [4.0, 4.0], [4.0, 0.0]])
    np.testing.assert_allclose(
        even_steps(square, 8), [[0, 0], [0, 2], [0, 4], [2, 4], [4, 4], [4, 2], [4, 0], [2, 0]]
    )


def test_a_closed_curve_makes_one_turn() -> None:
    around = np.linspace(0.0, 2.0 * np.pi, 100, endpoint=False)
    curve = turned(np.column_stack([30 * np.sin(around), 9 * np.cos(around) + 5 * np.cos(2 * around)]), 0.3)
    assert turning(curve).sum() == pytest.approx(2 * np.pi)


def test_a_run_over_the_first_point_is_one_run() -> None:
    turn = np.arange(1.0, 7.0)
    inside = np.array([True, False, True, True, False, True])
    np.testing.assert_allclose(np.sort(turn_of_runs(turn, inside)), [7.0, 7.0])
    assert turn_of_runs(turn, np.zeros(6, dtype=bool)).tolist() == []
    assert turn_of_runs(turn, np.ones(6, dtype=bool)).tolist() == [21.0]


def test_pruning_leaves_arms_and_takes_spurs() -> None:
    cross = np.zeros((101, 101), dtype=bool)
    cross[47:54, 5:96] = cross[5:96, 47:54] = True
    skeleton = skeleton_of(crop_shape(cross))
    kept = pruned(skeleton, 5.0)
    assert (kept.tips.sum(), kept.length) == (4, pytest.approx(2 * 91 - 7, abs=6))
    assert pruned(skeleton, 1000.0).tips.sum() <= 2  # what is left without any branch is one line


def test_the_coarse_mesh_tells_the_area_error_of_the_fine_one() -> None:
    shape = crop_shape(star(5, 70))
    coarse, fine = coarse_mesh(shape), mesh_inside(shape.traced, shape.mask, edge_length=0.9)
    assert 2 * len(coarse.vertices_yx) < len(fine.vertices_yx)
    disk = cd.map_to_disk(shape.mask, method="harmonic")
    found = measure_distortion(shape)
    assert found["harmonic_area_error"] == pytest.approx(disk.distortion.area, rel=0.05)
    assert found["harmonic_angle_error"] == pytest.approx(disk.distortion.angle - 1, rel=0.06)
