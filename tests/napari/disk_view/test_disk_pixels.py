"""The picture of the disk as numbers: windows of pixels, and colours."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.napari.disk_view.disk_pixels import DiskFrame, DiskPixels, colour_table, colours_of

FRAME = DiskFrame(80, 30.0, (32.0, 36.0))


def test_places_and_points_belong_together() -> None:
    for row, column in ((40, 40), (12, 50), (65, 33)):
        u, v = FRAME.places_uv[row, column]
        assert FRAME.point(u, v) == pytest.approx((column + 0.5, row + 0.5))
        assert FRAME.place(column + 0.5, row + 0.5) == pytest.approx((u, v))


def test_the_ring_belongs_to_the_rim() -> None:
    assert FRAME.place(40.0 + 34.0, 40.0) == pytest.approx((1.0, 0.0))
    assert FRAME.place(40.0 + 38.0, 40.0) is None
    assert DiskFrame(80, 30.0).place(40.0 + 34.0, 40.0) is None


def test_each_pixel_has_the_window_of_its_place_and_the_ring_the_sector() -> None:
    grid = cd.polar_windows(layers=3, sectors=8)
    numbers = DiskPixels(grid, FRAME).numbers
    places = FRAME.places_uv.reshape(-1, 2)
    away = np.hypot(*places.T) * FRAME.radius
    inside, ring = away <= 30.0, (away >= 32.0) & (away <= 36.0)
    assert_array_equal(numbers.ravel()[inside], grid.window_of(places[inside]))
    assert_array_equal(numbers.ravel()[ring], grid.n_windows + grid.sector_of(places[ring]))
    assert (numbers.ravel()[~inside & ~ring] == grid.n_windows + grid.sectors).all()


def test_painted_pixels_have_the_colours_of_their_windows_and_are_clear_elsewhere() -> None:
    grid = cd.polar_windows(layers=3, sectors=8)
    pixels = DiskPixels(grid, FRAME)
    colours = np.arange(1, grid.n_windows + 1, dtype=np.uint32)
    painted = pixels.painted(colours)
    inside = pixels.numbers < grid.n_windows
    assert_array_equal(painted[inside], pixels.numbers[inside] + 1)
    assert (painted[~inside] == 0).all()


def test_hatches_lie_in_the_chosen_windows_alone() -> None:
    grid = cd.polar_windows(layers=2, sectors=4)
    pixels = DiskPixels(grid, FRAME)
    chosen = np.zeros((2, 4), dtype=bool)
    chosen[0, 1] = True
    plain = pixels.painted(np.full(grid.n_windows, 7, dtype=np.uint32))
    changed = pixels.hatched(plain.copy(), chosen) != plain
    assert set(np.unique(pixels.numbers[changed])) == {1}


def test_colours_end_at_the_limits_and_missing_is_grey() -> None:
    table = colour_table("viridis")
    colours = colours_of([-1.0, 0.0, 5.0, 10.0, 99.0, np.nan], (0.0, 10.0), "viridis")
    assert_array_equal(colours, table[[0, 0, 128, 255, 255, 256]])
    assert_allclose([(table[256] >> shift) & 255 for shift in (24, 16, 8, 0)], [255, 217, 217, 217])
