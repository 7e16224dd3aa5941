import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.collections import LineCollection

import cytodisk as cd


@pytest.fixture(scope="module")
def disk() -> cd.DiskMap:
    mask = cd.simulate.disk(15)
    mask[20:24, 18:23] = False
    return cd.map_to_disk(mask, holes="exclude")


def test_a_cell_has_the_borders_of_its_holes(disk: cd.DiskMap) -> None:
    _, ax = plt.subplots()
    cd.plot.draw_cell(ax, np.ones(disk.mask.shape), disk)
    (sides,) = [drawn for drawn in ax.collections if isinstance(drawn, LineCollection)]
    points = np.concatenate(sides.get_segments())
    assert len(sides.get_segments()) == 2 * (4 + 5)
    np.testing.assert_array_equal(points.min(axis=0), [17.5, 19.5])
    np.testing.assert_array_equal(points.max(axis=0), [22.5, 23.5])


def test_holes_cover_windows_but_nothing_else(disk: cd.DiskMap) -> None:
    windows = cd.polar_windows(2, 6).on(disk)
    _, ax = plt.subplots()
    cd.plot.draw_window_means(ax, windows, np.ones((2, 6)))
    (cover,) = ax.images
    opaque = np.asarray(cover.get_array())[..., 3] == 1.0
    np.testing.assert_array_equal(opaque, disk.holes.box)
    left, right, bottom, top = cover.get_extent()
    row, column = disk.placed_mask.corner
    assert (left, top) == (column - 0.5, row - 0.5)
    assert (right - left, bottom - top) == opaque.shape[::-1]


def test_colours_go_by_what_is_no_hole(disk: cd.DiskMap) -> None:
    signal = np.where(disk.mask_without_holes, 1.0, 1e6)
    signal[disk.mask_without_holes] = np.linspace(0.0, 1.0, disk.mask_without_holes.sum())
    _, ax = plt.subplots()
    for drawn in (cd.plot.draw_cell(ax, signal, disk), cd.plot.draw_disk_image(ax, disk, signal, size=32)):
        assert drawn.get_clim()[1] <= 1.0
