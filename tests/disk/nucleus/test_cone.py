"""The nucleus' polygon and the round disk are one to one, ray by ray."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.testing import assert_allclose

from cytodisk.arrays import FloatArray
from cytodisk.disk.nucleus.cone import TURN, rounded, to_polygon

gaps = st.integers(3, 40).flatmap(lambda n: arrays(np.float64, n, elements=st.floats(0.6, 1.0)))


def corners_of(gaps: FloatArray, start: float) -> FloatArray:
    """Angles that go around once, in steps of less than half a turn."""
    return np.asarray(start + TURN * np.append(0.0, np.cumsum(gaps)[:-1]) / gaps.sum())


@given(gaps, st.floats(-10.0, 10.0), st.integers(0, 2**32 - 1))
def test_to_polygon_is_the_inverse_of_rounded(gaps: FloatArray, start: float, seed: int) -> None:
    angles, random = corners_of(gaps, start), np.random.default_rng(seed)
    radii, turns = np.sqrt(random.random(50)), random.uniform(-TURN, TURN, 50)
    turns[: min(len(angles), 25)] = angles[:25]  # rays through corners
    polygon = to_polygon(radii, turns, angles)
    there = np.column_stack([radii * np.cos(turns), radii * np.sin(turns)])
    assert_allclose(rounded(polygon, angles), there, atol=1e-12)


@given(gaps, st.floats(-10.0, 10.0))
def test_sides_go_to_the_circle_with_angles_linear_along_them(gaps: FloatArray, start: float) -> None:
    angles = corners_of(gaps, start)
    ends = np.append(angles, angles[0] + TURN)
    circle = np.column_stack([np.cos(ends), np.sin(ends)])
    for fraction in (0.0, 0.2, 0.5, 0.9):
        side = circle[:-1] + fraction * np.diff(circle, axis=0)
        angle = ends[:-1] + fraction * np.diff(ends)
        assert_allclose(rounded(side, angles), np.column_stack([np.cos(angle), np.sin(angle)]), atol=1e-12)


def test_centre_and_places_that_are_not_known_stay() -> None:
    angles = corners_of(np.ones(5), 0.3)
    found = rounded(np.array([[0.0, 0.0], [np.nan, 0.1], [0.1, np.nan]]), angles)
    assert_allclose(found, [[0.0, 0.0], [np.nan, np.nan], [np.nan, np.nan]])
    assert_allclose(to_polygon(np.zeros(1), np.array([2.0]), angles), [[0.0, 0.0]])
