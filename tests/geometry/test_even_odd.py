import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_array_equal

from cytodisk.geometry.even_odd import pixels_inside

WINDOW = slice(0, 40), slice(0, 50)


def whole(*rings: list[tuple[float, float]]) -> np.ndarray:
    return pixels_inside([np.array(ring, dtype=float) for ring in rings], *WINDOW)


def star(seed: int, points: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, points))
    radius = rng.uniform(4, 18, points)
    return np.column_stack([19.3 + radius * np.sin(angle), 24.6 + radius * np.cos(angle)])


def test_a_rectangle_between_pixels_holds_the_pixels_within() -> None:
    inside = whole([(4.5, 9.5), (4.5, 19.5), (14.5, 19.5), (14.5, 9.5)])
    expected = np.zeros((40, 50), dtype=bool)
    expected[5:15, 10:20] = True
    assert_array_equal(inside, expected)


def test_a_hole_is_empty_whichever_way_it_runs() -> None:
    outer = [(4.5, 9.5), (4.5, 29.5), (24.5, 29.5), (24.5, 9.5)]
    hole = [(9.5, 14.5), (9.5, 19.5), (14.5, 19.5), (14.5, 14.5)]
    for ring in (hole, hole[::-1]):
        assert whole(outer, ring).sum() == 20 * 20 - 5 * 5


def test_a_repeated_last_point_changes_nothing() -> None:
    ring = star(0, 9)
    assert_array_equal(
        pixels_inside([ring], *WINDOW), pixels_inside([np.concatenate([ring, ring[:1]])], *WINDOW)
    )


def test_a_ring_that_crosses_itself_is_both_of_its_loops() -> None:
    eight = [(5.2, 5.2), (30.2, 40.2), (30.2, 5.2), (5.2, 40.2)]
    area = shapely.make_valid(shapely.Polygon(eight)).area
    assert whole(eight).sum() == pytest.approx(area, rel=0.03)


@given(st.integers(0, 10**6), st.integers(3, 20))
def test_pixels_are_those_whose_centres_lie_inside(seed: int, points: int) -> None:
    ring = star(seed, points)
    polygon = shapely.make_valid(shapely.Polygon(ring))
    y, x = np.mgrid[:40, :50]
    assert_array_equal(pixels_inside([ring], *WINDOW), shapely.contains_xy(polygon, y, x))


@given(st.integers(0, 10**6), st.integers(3, 20), st.integers(0, 30), st.integers(0, 40))
def test_a_window_shows_its_part_of_the_whole(seed: int, points: int, row: int, column: int) -> None:
    ring = star(seed, points)
    rows, columns = slice(row, row + 10), slice(column, column + 10)
    assert_array_equal(pixels_inside([ring], rows, columns), pixels_inside([ring], *WINDOW)[rows, columns])


def test_polygons_that_share_sides_through_pixel_centres_share_no_pixel() -> None:
    corners = np.array([(0, 0), (0, 20), (20, 20), (20, 0)], dtype=float) + 5
    centre = np.array([13.0, 17.0])
    parts = [pixels_inside([np.array([corners[i], corners[(i + 1) % 4], centre])], *WINDOW) for i in range(4)]
    assert_array_equal(np.sum(parts, axis=0), pixels_inside([corners], *WINDOW).astype(int))
    assert np.sum(parts) == 20 * 20


def test_a_large_window_is_drawn_strip_after_strip(monkeypatch: pytest.MonkeyPatch) -> None:
    ring = star(3, 12)
    whole_window = pixels_inside([ring], *WINDOW)
    monkeypatch.setattr("cytodisk.geometry.even_odd._PIXELS_AT_ONCE", 130)
    assert_array_equal(pixels_inside([ring], *WINDOW), whole_window)
