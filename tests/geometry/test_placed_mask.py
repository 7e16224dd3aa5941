"""A mask as its box in an image: the same pixels as the whole mask, and no memory for the image."""

import tracemalloc

import numpy as np
from numpy.testing import assert_array_equal

import cytodisk as cd
from cytodisk.disk.cell_mesh import mesh_cell
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.simulate import disk as round_cell


def shifted(rows: int, columns: int) -> np.ndarray:
    whole = np.zeros((90, 80), dtype=bool)
    mask = round_cell(9)
    whole[rows : rows + mask.shape[0], columns : columns + mask.shape[1]] = mask
    return whole


ONE, OTHER = shifted(3, 20), shifted(12, 16)


def test_the_box_holds_the_mask_and_nothing_else():
    placed = PlacedMask.of(ONE)
    assert_array_equal(placed.whole, ONE)
    assert_array_equal(placed.pixels_yx, np.argwhere(ONE))
    assert_array_equal(placed.cut_out_of(ONE), placed.box)
    assert all(side.any() for side in (placed.box[0], placed.box[-1], placed.box[:, 0], placed.box[:, -1]))


def test_two_masks_are_compared_without_their_images():
    one, other = PlacedMask.of(ONE), PlacedMask.of(OTHER)
    assert_array_equal(one.outside(other), np.argwhere(ONE & ~OTHER))
    assert one.touches(other)
    assert not one.touches(PlacedMask.of(shifted(50, 40)))


def test_a_mask_keeps_its_pixels_in_the_image_it_was_cut_out_of():
    crop = PlacedMask.of(ONE[2:, 10:])
    assert_array_equal(crop.within((2, 10), ONE.shape).whole, ONE)
    assert_array_equal(PlacedMask.of(ONE[2:, 10:], (2, 10), ONE.shape).whole, ONE)


def test_a_mesh_is_the_same_from_the_box_as_from_the_whole_image():
    whole = mesh_cell(ONE, MappingParameters())
    cut = mesh_cell(PlacedMask(ONE[2:60, 15:65], (2, 15), ONE.shape), MappingParameters())
    assert_array_equal(whole.mesh.vertices_yx + whole.corner, cut.mesh.vertices_yx + cut.corner)
    assert_array_equal(whole.placed_mask.whole, cut.placed_mask.whole)
    assert whole.report == cut.report


def test_a_map_in_a_large_image_takes_the_memory_of_its_cell(tmp_path):
    disk = cd.map_to_disk(round_cell(9))
    tracemalloc.start()
    try:
        placed = disk.placed((4000, 5000), (10_000, 10_000))
        placed.save(tmp_path / "cell.npz")
        again = cd.load_map(tmp_path / "cell.npz")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 10_000**2 / 20  # bytes
    assert again.placed_mask.image_shape == (10_000, 10_000)
    assert_array_equal(again.placed_mask.box, placed.placed_mask.box)


def test_points_are_held_by_the_pixel_that_they_lie_in() -> None:
    placed = PlacedMask(np.array([[True, False], [True, True]]), (2, 3), (6, 8))
    points = np.array(
        [[2.0, 3.0], [2.4, 3.4], [2.0, 4.0], [3.49, 4.49], [3.51, 4.0], [0.0, 0.0], [np.nan, 3.0], [9.0, 9.0]]
    )
    assert placed.holds(points).tolist() == [True, True, False, True, False, False, False, False]


def test_another_mask_in_the_same_box() -> None:
    placed = PlacedMask(np.ones((2, 3), dtype=bool), (4, 5), (10, 12))
    other = np.zeros((10, 12), dtype=bool)
    other[5, 6] = other[0, 0] = True
    assert placed.beside(other).box.tolist() == [[False] * 3, [False, True, False]]
    cut = placed.beside(other[3:, 4:], (3, 4))
    assert cut.box.tolist() == placed.beside(other).box.tolist()
    assert (cut.corner, cut.image_shape) == ((4, 5), (10, 12))
