import numpy as np
import pytest

from cytodisk.geometry.polygon import centroid, edge_lengths, edges, signed_area, smooth_along, smooth_closed

L_SHAPE = np.array([(0, 0), (0, 3), (1, 3), (1, 1), (3, 1), (3, 0)], dtype=float)  # (y, x), from +x to +y


def test_area_and_centroid_of_an_l() -> None:
    assert signed_area(L_SHAPE) == 5.0
    assert signed_area(L_SHAPE[::-1]) == -5.0
    # 3 × 1 about (0.5, 1.5) and 1 × 2 about (2, 0.5)
    np.testing.assert_allclose(centroid(L_SHAPE), [(3 * 0.5 + 2 * 2.0) / 5, (3 * 1.5 + 2 * 0.5) / 5])


def test_centroid_moves_with_the_polygon_even_far_away() -> None:
    away = np.array([1e6, -2e6])
    np.testing.assert_allclose(centroid(L_SHAPE + away) - away, centroid(L_SHAPE), atol=1e-8)


def test_edge_lengths_close_the_polygon() -> None:
    np.testing.assert_array_equal(edge_lengths(L_SHAPE), [3, 1, 2, 2, 1, 3])


def test_edges_lead_around_the_polygon_and_have_their_lengths() -> None:
    steps = edges(L_SHAPE)
    np.testing.assert_array_equal(steps.sum(axis=0), 0.0)
    np.testing.assert_array_equal(L_SHAPE[0] + np.cumsum(steps, axis=0)[:-1], L_SHAPE[1:])
    np.testing.assert_array_equal(np.hypot(*steps.T), edge_lengths(L_SHAPE))


def test_values_along_a_polygon_are_smoothed_in_pixels_across_its_first_point() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    circle = 50.0 * np.column_stack([np.sin(angle), np.cos(angle)])
    peak = np.zeros(400)
    peak[0] = 1.0
    smoothed = smooth_along(peak, circle, 3.0)
    away = np.minimum(angle, 2.0 * np.pi - angle) * 50.0
    assert smoothed.sum() == pytest.approx(1.0)
    assert np.sqrt(smoothed @ away**2) == pytest.approx(3.0, rel=0.01)


def test_smoothing_keeps_a_circle_a_circle_and_shrinks_it_by_the_gaussian_factor() -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    circle = 50.0 * np.column_stack([np.sin(angle), np.cos(angle)])
    radius = np.hypot(*smooth_closed(circle, 3.0).T)
    # The first Fourier mode over a perimeter of 2π 50 px keeps exp(-σ² / (2 · 50²)).
    np.testing.assert_allclose(radius, 50.0 * np.exp(-9.0 / 5000.0), rtol=1e-5)


def test_smoothing_removes_the_stair_steps_of_a_diagonal() -> None:
    stairs = np.array([(k // 2, (k + 1) // 2) for k in range(120)], dtype=float)
    back = np.array([(60.0, 60.0 - k) for k in range(60)] + [(60.0 - k, 0.0) for k in range(60)])
    smoothed = smooth_closed(np.concatenate([stairs, back]), 2.0)[20:100]
    length = np.hypot(*np.diff(smoothed, axis=0).T).sum()
    straight = np.hypot(*(smoothed[-1] - smoothed[0]))
    assert length == pytest.approx(straight, rel=1e-3)
