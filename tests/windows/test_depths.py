from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.pixel_shares.subpixels import depths_and_angles, subpixel_places

SHARES = (0.5, 0.05, 0.95)
RADIUS = 40


def oracle(windows: WindowsOnCell) -> np.ndarray:
    """Percentiles of the exact depths of all subpixels, window by window."""
    pixels = np.argwhere(windows.mask)
    angles = np.linspace(0.0, 2.0 * np.pi, len(windows.outline_yx), endpoint=False)
    depths, _ = depths_and_angles(subpixel_places(pixels, 4), windows.outline_yx, angles)
    numbers = windows.subpixel_windows
    found = np.full((windows.layers * windows.sectors, 3), np.nan)
    for number in range(len(found)):
        held = depths[numbers == number]
        if held.size:
            found[number] = np.quantile(held, SHARES, method="inverted_cdf")
    return found.reshape(windows.layers, windows.sectors, 3)


@pytest.fixture(scope="module")
def disk() -> cd.DiskMap:
    return cd.map_to_disk(np.pad(cd.simulate.disk(RADIUS), 2))


@pytest.mark.parametrize("spacing", ["area", "radius"])
def test_depth_in_a_disk_is_the_radius_less_the_distance_from_the_centre(
    disk: cd.DiskMap, spacing: Any
) -> None:
    grid = cd.polar_windows(5, 8, spacing)
    outer, inner = RADIUS * grid.radii[:-1], RADIUS * grid.radii[1:]
    found = grid.on(disk).depths.mean(axis=1)
    for column, share in enumerate(SHARES):
        expected = RADIUS - np.sqrt(outer**2 + share * (inner**2 - outer**2))
        assert_allclose(found[:, column], expected, atol=0.45)  # a pixel outline is no circle


@pytest.mark.parametrize(
    "windows",
    [
        cd.polar_windows(4, 12).on(cd.map_to_disk(cd.simulate.migrating(seed=3, size=0.4))),
        cd.edge_windows(cd.simulate.migrating(seed=3, size=0.4), 4, 12),
        cd.ring_windows(cd.simulate.migrating(seed=3, size=0.4), 4, 12),
    ],
    ids=["polar", "edge", "rings"],
)
def test_depths_are_percentiles_over_the_subpixels_of_a_window(windows: WindowsOnCell) -> None:
    expected = oracle(windows)
    assert_array_equal(np.isnan(windows.depths), np.isnan(expected))
    off = np.abs(windows.depths - expected)
    assert np.nanmean(off) < 0.05
    assert np.nanmax(off) < 0.5
    median, low, high = np.moveaxis(windows.depths, -1, 0)
    held = windows.areas > 0
    assert ((low <= median) & (median <= high))[held].all()


def test_every_window_of_a_fine_grid_has_a_depth() -> None:
    windows = cd.polar_windows(60, 90).on(cd.map_to_disk(np.pad(cd.simulate.disk(9), 2)))
    assert (windows.areas < 1).any()
    assert np.isfinite(windows.depths).all()
    assert_allclose(windows.depths[..., 0].mean(axis=1), 9 * (1 - windows.grid.radii[:-1]), atol=0.8)


def test_depth_does_not_know_the_border_of_the_image() -> None:
    whole = np.pad(cd.simulate.disk(20), 3)
    cut = cd.map_to_disk(whole[whole.shape[0] // 2 :])
    windows = cd.polar_windows(1, 8).on(cut)
    middle = 20 - np.hypot(*(windows.centroids_yx[0] - (0.0, (whole.shape[1] - 1) / 2)).T)
    assert windows.depths[0, :, 0].max() > 8  # next to the image's border, far from the arc
    assert_allclose(windows.depths[0, :, 0], middle, atol=1.5)


def test_no_edge_in_the_image_is_no_depth() -> None:
    windows = cd.polar_windows(2, 4).on(cd.map_to_disk(np.ones((9, 12), dtype=bool)))
    assert np.isnan(windows.depths).all()


def test_samples_say_depth_in_the_unit_of_length() -> None:
    mask = np.pad(cd.simulate.disk(20), 2)
    signal = mask * 1.0
    grid = cd.polar_windows(2, 6)
    plain = cd.sample(grid.on(cd.map_to_disk(mask)), signal)
    scaled = cd.sample(grid.on(cd.map_to_disk(mask, pixel_size_um=0.1)), signal)
    assert (plain["depth"].attrs["units"], scaled["depth"].attrs["units"]) == ("px", "µm")
    for name in ("depth", "depth_p5", "depth_p95"):
        assert_allclose(scaled[name], 0.1 * plain[name])


def test_activity_holds_the_depths_of_each_frame() -> None:
    truth = cd.simulate.movie("growing", frames=3, radius_px=15.0)
    movie = cd.map_movie(truth.masks, pixel_size_um=0.5)
    activity = cd.sample_movie(movie, cd.polar_windows(2, 6), truth.signal)
    assert activity["depth"].dims == ("time", "layer", "sector")
    assert activity["depth_p95"].attrs["units"] == "µm"
    by_layer = activity["depth"].mean("sector")
    assert (by_layer.diff("layer") > 0).all()
    radius = np.sqrt(np.array([movie[frame].mask.sum() for frame in range(3)]) / np.pi)
    assert_allclose(by_layer[:, 0], 0.5 * radius * (1 - np.sqrt(0.75)), atol=0.1)
