import numpy as np
import shapely
from curves import CENTRE, circle, exact, lobed, smooth_curves
from hypothesis import given
from hypothesis import strategies as st

from cytodisk import simulate
from cytodisk.geometry.outline import trace_outline
from cytodisk.motion.contour import Contour

places = st.lists(st.floats(-1000.0, 1000.0), min_size=1, max_size=20).map(np.array)


@given(smooth_curves(), places)
def test_points_are_where_a_library_puts_them(points: np.ndarray, s: np.ndarray) -> None:
    contour = exact(points)
    ring = shapely.LinearRing(points)
    assert np.isclose(contour.length, ring.length, rtol=1e-12)
    expected = shapely.get_coordinates(shapely.line_interpolate_point(ring, np.mod(s, ring.length)))
    np.testing.assert_allclose(contour.at(s), expected, atol=1e-8)


@given(smooth_curves(), places, st.integers(-5, 5))
def test_everything_repeats_after_a_turn(points: np.ndarray, s: np.ndarray, turns: int) -> None:
    contour = exact(points)
    again = s + turns * contour.length
    for read in (contour.at, contour.outline_at, contour.normals):
        np.testing.assert_allclose(read(again), read(s), atol=1e-7)


def test_the_arc_starts_at_0_and_ends_at_the_length() -> None:
    contour = exact(np.array([[0.0, 0.0], [0.0, 3.0], [4.0, 3.0]]))
    np.testing.assert_array_equal(contour.arc, [0.0, 3.0, 7.0, 12.0])
    assert contour.length == 12.0
    np.testing.assert_allclose(contour.at(np.array([1.0, 5.0, 12.0])), [[0, 1], [2, 3], [0, 0]], atol=1e-12)


def test_normals_of_a_circle_point_away_from_its_centre() -> None:
    contour = exact(circle(30.0))
    s = np.linspace(0.0, contour.length, 777)
    radial = contour.at(s) - CENTRE
    radial /= np.linalg.norm(radial, axis=1, keepdims=True)
    np.testing.assert_allclose(contour.normals(s), radial, atol=1e-4)


@given(smooth_curves(), places)
def test_normals_are_of_length_1_and_lead_out(points: np.ndarray, s: np.ndarray) -> None:
    contour = exact(points)
    normals = contour.normals(s)
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-12)
    inside = shapely.Polygon(points)
    assert not shapely.contains_xy(inside, contour.at(s) + 0.5 * normals).any()
    assert shapely.contains_xy(inside, contour.at(s) - 0.5 * normals).all()


def test_the_outline_is_read_point_by_point_beside_its_smoothed_copy() -> None:
    outline = trace_outline(simulate.random_smooth(2, radius=25.0))
    contour = Contour.of_outline(outline)
    assert not np.allclose(contour.points_yx, outline, atol=0.05)
    np.testing.assert_allclose(contour.outline_at(contour.arc[:-1]), outline, atol=1e-9)
    middle = 0.5 * (contour.arc[:-1] + contour.arc[1:])
    expected = 0.5 * (outline + np.roll(outline, -1, axis=0))
    np.testing.assert_allclose(contour.outline_at(middle), expected, atol=1e-9)


def test_smoothing_leaves_straight_edges_and_takes_the_stairs_away() -> None:
    square = trace_outline(np.ones((60, 60), dtype=bool))
    far = np.abs(square - 29.5).min(axis=1) < 15.0
    np.testing.assert_allclose(Contour.of_outline(square).points_yx[far], square[far], atol=1e-3)
    stairs = trace_outline(simulate.disk(40.0))
    assert exact(stairs).length > 1.04 * 2.0 * np.pi * 40.0
    assert abs(Contour.of_outline(stairs).length / (2.0 * np.pi * 40.0) - 1.0) < 0.01


def test_more_smoothing_gives_a_shorter_curve() -> None:
    lengths = [Contour.of_outline(lobed(), sigma).length for sigma in (1.0, 4.0, 16.0)]
    assert lengths == sorted(lengths, reverse=True)
    assert lengths[0] > lengths[2] + 1.0
