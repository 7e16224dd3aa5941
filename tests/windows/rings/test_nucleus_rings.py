"""Rings by the share of the way from the edge to the nucleus."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.arrays import BoolArray
from cytodisk.errors import WindowError


def disk_in(shape: tuple[int, int], centre: tuple[float, float], radius: float) -> BoolArray:
    y, x = np.indices(shape)
    return np.asarray((y - centre[0]) ** 2 + (x - centre[1]) ** 2 <= radius**2)


CELL = disk_in((101, 101), (50, 50), 45.49)  # its outline is half a pixel beyond the pixel centre at 45


def test_rings_of_concentric_disks_are_those_on_paper() -> None:
    """d_membrane + d_nucleus is 30 px, so rings are 6 px wide; along rows and columns ways are exact."""
    windows = cd.nucleus_ring_windows(CELL, disk_in(CELL.shape, (50, 50), 15.49), 5, 1, 3)
    right = windows.labels[50, 50:96]
    assert_array_equal(right[16:], np.repeat([4, 3, 2, 1, 0], 6))
    assert_array_equal(right[:5], 7)
    assert_array_equal(right[11:16], 5)
    for line in (windows.labels[50, 50::-1], windows.labels[50:, 50], windows.labels[50::-1, 50]):
        assert_array_equal(line[:46], right)
    expected = np.diff(np.array([15.5, 21.5, 27.5, 33.5, 39.5, 45.5]) ** 2)[::-1] / 45.5**2
    assert_allclose(windows.areas[:5, 0] / CELL.sum(), expected, atol=0.035)  # ways are up to 8 % too long


def test_rings_of_an_eccentric_nucleus_are_narrow_where_it_is_near_the_edge() -> None:
    windows = cd.nucleus_ring_windows(CELL, disk_in(CELL.shape, (50, 70), 15.49), 5, 1, 1)
    row = windows.labels[50]
    assert_array_equal(row[86:96], np.repeat([4, 3, 2, 1, 0], 2))  # 45 − 20 − 15 px
    assert_array_equal(row[5:55], np.repeat([0, 1, 2, 3, 4], 10))  # 45 + 20 − 15 px


def test_wedges_are_angles_around_the_nucleus() -> None:
    nucleus = disk_in(CELL.shape, (50, 70), 8)
    windows = cd.nucleus_ring_windows(CELL, nucleus, 2, 4, 1)
    sector = windows.labels % 4
    assert (sector[51:, 71:][CELL[51:, 71:]] == 0).all()
    assert (sector[51:, :70][CELL[51:, :70]] == 1).all()
    assert (sector[:50, :70][CELL[:50, :70]] == 2).all()
    assert (sector[:50, 71:][CELL[:50, 71:]] == 3).all()


def test_compartments_are_kept_apart_to_the_pixel() -> None:
    nucleus = disk_in(CELL.shape, (60, 41), 13)
    windows = cd.nucleus_ring_windows(CELL, nucleus, 4, 12, 3)
    areas = windows.areas.sum(axis=1)
    assert areas[:4].sum() == CELL.sum() - nucleus.sum()
    assert areas[4:].sum() == nucleus.sum()
    assert windows.coverage == 1.0


def test_ways_from_the_nucleus_go_through_the_cell() -> None:
    """A U with the nucleus at the top of its left arm: the top of the right arm is far, not near."""
    cell = np.zeros((60, 44), dtype=bool)
    cell[2:58, 2:14] = cell[46:58, 2:42] = cell[2:58, 30:42] = True
    nucleus = np.zeros_like(cell)
    nucleus[5:13, 4:12] = True
    windows = cd.nucleus_ring_windows(cell, nucleus, 4, 1, 1)
    way = windows.edges.ways_from_nucleus(np.array([[8, 36], [40, 8]]))
    assert_allclose(way[1].mean(), 27.5, atol=0.6)  # straight down
    assert way[0].min() > 80.0
    assert (windows.labels[4:40, 31:41] == 0).all()


@pytest.mark.parametrize("name", ["layers", "sectors", "nucleus_layers"])
def test_a_count_that_is_none_is_refused(name: str) -> None:
    with pytest.raises(WindowError, match=rf"{name}.*from 1 to 100000, got 0"):
        cd.nucleus_ring_windows(CELL, disk_in(CELL.shape, (50, 50), 9), **{name: 0})
