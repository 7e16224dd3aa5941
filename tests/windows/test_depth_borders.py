import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.errors import WindowError
from cytodisk.geometry.edge_distance import EdgeDistance
from cytodisk.simulate import KINDS, random_mask
from cytodisk.windows.depth_borders import radii_at_depths

PIXEL_UM = 0.16


def round_cell(radius_um: float) -> tuple[cd.DiskMap, np.ndarray]:
    """A disk, and a cortex whose signal falls by e with each µm of depth."""
    mask = np.pad(cd.simulate.disk(radius_um / PIXEL_UM), 3)
    place = np.argwhere(np.ones_like(mask)) - (np.array(mask.shape) - 1) / 2
    depth = radius_um - PIXEL_UM * np.hypot(*place.T).reshape(mask.shape)
    return cd.map_to_disk(mask, pixel_size_um=PIXEL_UM), 100.0 * np.exp(-np.maximum(depth, 0.0))


def dumbbell() -> np.ndarray:
    """Its middle is the neck: less deep than the lobes around it."""
    return np.pad(cd.simulate.dumbbell(radius=20, neck_width=4), 2)


def test_one_cortex_reads_the_same_in_cells_of_all_sizes() -> None:
    by_depth, by_area = [], []
    for radius_um in (4.0, 8.0, 12.0, 20.0):
        disk, signal = round_cell(radius_um)
        for grid, found in (
            (cd.polar_windows(sectors=24, depth_um=(0.5, 1.0, 2.0)), by_depth),
            (cd.polar_windows(10, 24), by_area),
        ):
            found.append(float(cd.sample(grid.on(disk), signal)["mean"].mean("sector")[0]))
    assert max(by_depth) < 1.05 * min(by_depth)
    assert max(by_area) > 1.3 * min(by_area)


def test_borders_lie_at_their_depths_in_a_disk() -> None:
    disk, _ = round_cell(8.0)
    grid = cd.polar_windows(sectors=12, depth_um=(0.5, 2.0, 5.0)).on(disk).grid
    assert_allclose(8.0 * (1.0 - grid.radii[1:-1]), [0.5, 2.0, 5.0], atol=0.08)
    assert grid.layers == 4
    assert grid.present.all()


@settings(max_examples=25)
@given(kind=st.sampled_from(KINDS), seed=st.integers(1000, 9999), finest=st.floats(0.2, 3.0))
def test_layers_by_depth_share_out_any_cell(kind: str, seed: int, finest: float) -> None:
    disk = cd.map_to_disk(np.pad(random_mask(kind, seed), 1), pixel_size_um=1.0)
    windows = cd.polar_windows(sectors=9, depth_um=tuple(finest * 2.0**k for k in range(6))).on(disk)
    radii, present = windows.grid.radii, windows.grid.present
    assert (np.diff(radii)[present] < 0).all()
    assert_array_equal(windows.areas[~present], 0.0)
    assert (windows.areas[present] > 0).all()
    assert windows.areas.sum() == pytest.approx(disk.mask.sum(), rel=1e-9)
    assert_allclose(windows.weights.sum(axis=0), 1.0, rtol=1e-12)
    assert windows.n_empty == 0
    assert_array_equal(windows.completeness, np.where(present, 1.0, np.nan))
    assert_array_equal(np.isnan(windows.depths[..., 0]), np.repeat(~present[:, None], 9, axis=1))
    assert len(windows.geojson()["features"]) == 9 * present.sum()


def test_borders_decrease_where_the_depth_does_not_grow_inwards() -> None:
    disk = cd.map_to_disk(dumbbell())
    distance = EdgeDistance(disk.placed_mask, disk.outline_yx)
    depths = np.arange(0.5, 20.0, 0.5)
    radii = radii_at_depths(disk, distance, depths)
    reached = radii > 0
    assert (np.diff(radii[reached]) < 0).all()
    assert not reached[-1]
    assert_array_equal(reached, np.sort(reached)[::-1])
    angles = 2.0 * np.pi * (np.arange(180) + 0.5) / 180
    circles = radii[reached, None, None] * np.column_stack([np.cos(angles), np.sin(angles)])
    assert_allclose(np.median(distance.at(disk.to_cell(circles)), axis=1), depths[reached], atol=0.2)
    assert distance.at(disk.to_cell(np.zeros(2))) < depths[reached][-1]  # the neck


def test_a_layer_deeper_than_the_cell_is_nan() -> None:
    disk, signal = round_cell(4.0)
    data = cd.sample(cd.polar_windows(sectors=6, depth_um=(1.0, 5.0, 6.0)).on(disk), signal)
    assert np.isfinite(data["mean"][:2]).all()
    assert np.isnan(data["mean"][2:]).all()
    assert (data["n_pixels"][2:] == 0).all()
    assert_allclose(data["depth_p95"][1].max(), 3.5, atol=0.4)  # what is inside the last border it has


def test_a_cut_off_cell_has_its_borders_along_the_edge_that_is_seen() -> None:
    whole, _ = round_cell(8.0)
    half = cd.map_to_disk(whole.mask[whole.mask.shape[0] // 2 :], pixel_size_um=PIXEL_UM)
    windows = cd.polar_windows(sectors=16, depth_um=(1.0, 2.0)).on(half)
    along = windows.depths[0, :, 0] * PIXEL_UM
    assert np.median(along) == pytest.approx(0.5, abs=0.2)
    assert 0.5 < windows.grid.radii[1] < 1.0


def test_what_layers_by_depth_need() -> None:
    grid = cd.polar_windows(sectors=6, depth_um=1)
    assert (grid.layers, grid.depth_um) == (2, (1.0,))
    with pytest.raises(WindowError, match="pass pixel_size_um"):
        grid.on(cd.map_to_disk(cd.simulate.disk(9)))
    with pytest.raises(WindowError, match=r"grid\.on\(disk\)\.grid"):
        _ = grid.radii
    with pytest.raises(WindowError, match="border of the image cuts it all around"):
        grid.on(cd.map_to_disk(np.ones((9, 12), dtype=bool), pixel_size_um=1.0))


def test_a_grid_takes_the_radii_of_each_cell_that_it_is_laid_on() -> None:
    small, large = (round_cell(radius)[0] for radius in (4.0, 8.0))
    grid = cd.polar_windows(sectors=6, depth_um=(0.5, 1.0))
    of_small = grid.on(small).grid
    assert of_small.on(large).grid == grid.on(large).grid != of_small
    assert of_small.of_any_cell == grid


@pytest.mark.parametrize(("wrong", "words"), [("0.3,0.7", "list of numbers"), ((True, 2), "numbers")])
def test_depths_that_are_no_numbers(wrong: object, words: str) -> None:
    with pytest.raises(WindowError, match=words):
        cd.polar_windows(sectors=8, depth_um=wrong)  # type: ignore[arg-type]
