import numpy as np
import pytest

from cytodisk.disk.distortion import distortion_of
from cytodisk.geometry.mesh import hat_gradients

SQUARE = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.5, 0.5]])
TRIANGLES = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


def test_a_similarity_has_no_distortion() -> None:
    distortion = distortion_of(SQUARE, 3.0 * SQUARE[:, ::-1] + 5.0, TRIANGLES)
    assert distortion.area == pytest.approx(0.0, abs=1e-12)
    assert distortion.angle == pytest.approx(1.0)
    np.testing.assert_allclose(distortion.area_share, 0.25)


def test_a_stretch_keeps_area_shares_and_has_its_ratio_as_k() -> None:
    distortion = distortion_of(SQUARE, SQUARE[:, ::-1] * [4.0, 1.0], TRIANGLES)
    np.testing.assert_allclose(distortion.triangle_area_ratio, 1.0)
    np.testing.assert_allclose(distortion.triangle_stretch, 4.0)


def test_a_moved_middle_changes_areas_by_known_shares() -> None:
    moved = SQUARE[:, ::-1].copy()
    moved[4] = [0.5, 0.25]  # (u, v): half the area of the first triangle, one and a half of the third
    distortion = distortion_of(SQUARE, moved, TRIANGLES)
    np.testing.assert_allclose(distortion.triangle_area_ratio, [0.5, 1.0, 1.5, 1.0])
    assert distortion.area == pytest.approx((np.log(2.0) + np.log(1.5)) / 4.0)
    assert distortion.area_percentiles[1] == pytest.approx(0.5)
    assert distortion.area_percentiles[99] == pytest.approx(1.5)


def test_stretches_are_those_of_the_jacobians_singular_values() -> None:
    rng = np.random.default_rng(0)
    uv = rng.normal(size=SQUARE.shape)
    hats = hat_gradients(SQUARE, TRIANGLES)
    singular = np.linalg.svd(np.einsum("tki,tkj->tij", uv[TRIANGLES], hats), compute_uv=False)
    stretch = distortion_of(SQUARE, uv, TRIANGLES).triangle_stretch
    np.testing.assert_allclose(stretch, singular[:, 0] / singular[:, 1], rtol=1e-12)
