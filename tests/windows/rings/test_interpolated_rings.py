"""Rings interpolated between two outlines: what is known on paper, and folds that are known."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import WindowError
from cytodisk.windows.rings.paint_triangles import paint_triangles
from cytodisk.windows.rings.ring_points import outline_points, ring_triangles, turned_over, twice_areas


def disk_in(shape: tuple[int, int], centre: tuple[float, float], radius: float) -> BoolArray:
    y, x = np.indices(shape)
    return np.asarray((y - centre[0]) ** 2 + (x - centre[1]) ** 2 <= radius**2)


def circle(radius: float, count: int, centre: tuple[float, float] = (0.0, 0.0)) -> FloatArray:
    turn = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    return np.column_stack([centre[0] + radius * np.sin(turn), centre[1] + radius * np.cos(turn)])


CELL = disk_in((101, 101), (50, 50), 45)


def test_rings_of_concentric_disks_are_those_on_paper() -> None:
    windows = cd.interpolated_ring_windows(CELL, disk_in(CELL.shape, (50, 50), 15), 5, 12, 3)
    radii = np.array([45, 39, 33, 27, 21, 15, 10, 5, 0])
    assert_allclose(windows.areas.sum(axis=1) / CELL.sum(), -np.diff(radii**2) / 45**2, atol=0.004)
    assert_allclose(windows.areas.sum(axis=0) / CELL.sum(), 1 / 12, atol=0.002)
    assert (windows.n_turned_over, windows.outside, windows.overlap, windows.n_empty) == (0, 0.0, 0.0, 0)
    assert windows.coverage == pytest.approx(1.0, abs=0.005)  # chords cut a little off


def test_no_ring_folds_in_an_eccentric_disk() -> None:
    """Lines from circle to circle at one angle do not cross: rings are circles, one within the other."""
    windows = cd.interpolated_ring_windows(CELL, disk_in(CELL.shape, (50, 75), 12), 6, 12, 2)
    assert (windows.n_turned_over, windows.overlap) == (0, 0.0)


def test_a_horseshoe_with_its_nucleus_in_one_arm_folds_and_is_left() -> None:
    cell = np.zeros((70, 64), dtype=bool)
    cell[2:68, 2:20] = cell[50:68, 2:62] = cell[2:68, 44:62] = True
    nucleus = disk_in(cell.shape, (12, 11), 6)
    windows = cd.interpolated_ring_windows(cell, nucleus, 6, 24, 1)
    assert windows.n_turned_over > 0
    assert windows.outside > 0.2
    assert windows.overlap > 0.05
    assert windows.n_empty > 0
    assert windows.coverage > 0.99  # rings sweep every place on their way to the centre, some more than once
    assert (windows.shares.weights.sum(axis=0) <= 1.0 + 1e-12).all()


def test_exchanged_points_are_triangles_that_turn_over() -> None:
    """Eight points on two circles, of which two neighbours of the inner one change places."""
    outer, inner = circle(4.0, 8), circle(2.0, 8)
    centre = np.zeros_like(inner)
    assert not turned_over(np.stack([outer, inner, centre])).any()
    inner[[2, 3]] = inner[[3, 2]]
    found = turned_over(np.stack([outer, inner, centre]))
    assert_array_equal(np.argwhere(found), [[0, 2, 1], [1, 2, 0]])


def test_areas_of_triangles_are_that_of_the_ring() -> None:
    points = np.stack([circle(4.0, 30), circle(2.0, 30), np.zeros((30, 2))])
    polygon = 15 * np.sin(2 * np.pi / 30)
    areas = 0.5 * twice_areas(ring_triangles(points)).sum(axis=(1, 2))
    assert_allclose(areas, [polygon * (16 - 4), polygon * 4])


def test_points_begin_at_x_and_are_equally_far_apart() -> None:
    square = np.array([[-2.0, -2.0], [-2.0, 2.0], [2.0, 2.0], [2.0, -2.0]])
    found = outline_points(square, np.array([1.0, 0.0]), 16)
    assert_allclose(found[:3], [[1, 2], [2, 2], [2, 1]])
    assert_allclose(np.abs(np.diff(found, axis=0)).sum(axis=1), 1.0)


def test_the_furthest_point_at_x_is_the_first() -> None:
    """A comb whose teeth the +x direction crosses five times."""
    comb = np.array([[-1.0, -1], [-1, 6], [1, 6], [1, 5], [-0.5, 5], [-0.5, 3], [1, 3], [1, -1]])
    assert_allclose(outline_points(comb, np.zeros(2), 7)[0], [0, 6])


def test_one_harmonic_is_a_circle_and_many_are_the_outline() -> None:
    waved = (
        circle(10.0, 400) * (1.0 + 0.1 * np.cos(5 * np.linspace(0, 2 * np.pi, 400, endpoint=False)))[:, None]
    )
    smooth = outline_points(waved, np.zeros(2), 64, harmonics=1)
    assert np.ptp(np.linalg.norm(smooth, axis=1)) < 0.02
    plain = outline_points(waved, np.zeros(2), 64)
    assert_allclose(outline_points(waved, np.zeros(2), 64, harmonics=40), plain)


def naive_paint(triangles: FloatArray, points: FloatArray) -> BoolArray:
    """Which triangles hold each point strictly, (T, P): plain NumPy."""
    start, end = triangles[:, :, None], np.roll(triangles, -1, axis=1)[:, :, None]
    along, away = end - start, points - start
    side = along[..., 1] * away[..., 0] - along[..., 0] * away[..., 1]
    return np.asarray((side > 0).all(axis=1) | (side < 0).all(axis=1))


def test_painting_is_that_of_plain_numpy() -> None:
    generator = np.random.default_rng(3)
    triangles = generator.uniform(-3.0, 14.0, (25, 3, 2))
    windows = generator.integers(0, 8, 25)
    window, overlap = paint_triangles(triangles, windows, (12, 11))
    holds = naive_paint(triangles, np.argwhere(np.ones((12, 11))).astype(float))
    for place, (row, column) in enumerate(np.argwhere(np.ones((12, 11)))):
        over = windows[holds[:, place]]
        assert window[row, column] == (over[0] if len(over) else -1)
        assert overlap[row, column] == (len(set(over)) > 1)


def test_neighbours_share_no_point_of_their_common_side() -> None:
    """A square of two triangles on the points of a grid, and the same turned over."""
    square = np.array([[[0.0, 0], [0, 4], [4, 4]], [[0, 0], [4, 4], [4, 0]]])
    for triangles in (square, square[:, ::-1], np.stack([square[0], square[1, ::-1]])):
        window, overlap = paint_triangles(triangles, np.array([0, 1]), (6, 6))
        assert not overlap.any()
        assert (window >= 0).sum() == 16


def test_sectors_have_equally_many_points() -> None:
    grid = cd.InterpolatedRingGrid(4, 7, 1, points=100)
    assert grid.n_points == 105
    windows = cd.interpolated_ring_windows(CELL, disk_in(CELL.shape, (50, 50), 15), 3, 7, 1, 100)
    assert windows.points_yx.shape == (5, 105, 2)


def test_a_grid_counts_all_layers() -> None:
    with pytest.raises(WindowError, match=r"layers must be more than nucleus_layers.*got 3 and 3"):
        cd.InterpolatedRingGrid(3, 8)


@pytest.mark.parametrize(("name", "least"), [("layers", 1), ("points", 3), ("harmonics", 1)])
def test_a_count_that_is_too_small_is_refused(name: str, least: int) -> None:
    with pytest.raises(WindowError, match=rf"{name}.*{least}.*got 0"):
        cd.interpolated_ring_windows(CELL, disk_in(CELL.shape, (50, 50), 9), **{name: 0})
