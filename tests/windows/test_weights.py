import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cytodisk as cd
from cytodisk.simulate import KINDS, random_mask

SPACINGS = ("area", "radius")


@settings(max_examples=60)
@given(
    kind=st.sampled_from(KINDS),
    seed=st.integers(0, 10_000),
    layers=st.integers(1, 100),
    sectors=st.integers(1, 200),
    spacing=st.sampled_from(SPACINGS),
)
def test_windows_share_out_the_cell(kind: str, seed: int, layers: int, sectors: int, spacing: str) -> None:
    disk = cd.map_to_disk(random_mask(kind, seed))
    windows = cd.polar_windows(layers, sectors, spacing).on(disk)
    area = disk.mask.sum()

    np.testing.assert_allclose(windows.weights.sum(axis=0), 1.0, rtol=1e-12)
    assert windows.areas.sum() == pytest.approx(area, rel=1e-9)
    np.testing.assert_array_equal(windows.completeness, np.ones(layers))
    assert windows.areas.min() > 0

    signal = np.random.default_rng(seed).uniform(1.0, 1000.0, disk.mask.shape)
    data = cd.sample(windows, signal)
    total = float((data["mean"] * data["n_pixels"]).sum())
    assert total == pytest.approx(signal[disk.mask].sum(), rel=1e-9)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize("side", [1, 2, 3])
def test_no_window_of_a_tiny_mask_is_empty(side: int, spacing: str) -> None:
    windows = cd.polar_windows(100, 200, spacing).on(cd.map_to_disk(np.ones((side, side), dtype=bool)))
    assert windows.areas.min() > 0
    assert windows.areas.sum() == pytest.approx(side**2, rel=1e-9)


@pytest.mark.parametrize("spacing", SPACINGS)
@pytest.mark.parametrize(
    "mask",
    [
        cd.simulate.disk(13),
        cd.simulate.dumbbell(14, neck_width=1),
        cd.simulate.star(body_radius=10, arm_length=30, arm_width=2),
        cd.simulate.branching(seed=1),
        cd.simulate.random_spiky(seed=1, radius=12),
    ],
    ids=["disk", "dumbbell", "star", "branching", "spiky"],
)
def test_no_window_of_the_finest_grid_is_empty(mask: np.ndarray, spacing: str) -> None:
    assert mask.sum() >= 500
    windows = cd.polar_windows(100, 200, spacing).on(cd.map_to_disk(mask))
    np.testing.assert_array_equal(windows.completeness, np.ones(100))
    assert windows.areas.sum() == pytest.approx(windows.mask.sum(), rel=1e-9)


def test_equal_area_windows_of_a_disk_have_equal_areas() -> None:
    """A window's area is counted in subpixels of 1/16 px², whole on one side or the other of its outline.

    A window of 40 px² has an outline of about 25 px, so some hundred subpixels of its 600 are cut by it, half
    of which fall on the wrong side: a standard deviation of √100/2 = 5 subpixels, 0.8 %.
    The map itself is off by 0.7 % on a disk (mean |log λ|), mostly in the steps of the pixel outline.
    Together that is below 2 %.
    """
    disk = cd.map_to_disk(cd.simulate.disk(60))
    areas = cd.polar_windows(10, 28).on(disk).areas
    assert areas.std() / areas.mean() < 0.02


def test_equal_radius_windows_of_a_disk_grow_with_their_radius() -> None:
    """Ring k of L has the share (2 (L − k) − 1) / L² of a disk, to 0.5 % by the subpixels."""
    disk = cd.map_to_disk(cd.simulate.disk(60))
    rings = cd.polar_windows(5, 6, "radius").on(disk).areas.sum(axis=1)
    np.testing.assert_allclose(rings / rings.sum(), np.array([9, 7, 5, 3, 1]) / 25, rtol=0.005)


def test_one_window_is_the_whole_cell(cell: cd.DiskMap) -> None:
    windows = cd.polar_windows(1, 1).on(cell)
    np.testing.assert_array_equal(windows.weights.toarray(), np.ones((1, cell.mask.sum())))


def test_sectors_of_a_disk_lie_where_their_angles_say() -> None:
    mask = cd.simulate.disk(30)
    centre = (np.array(mask.shape) - 1) / 2
    y, x = (cd.polar_windows(1, 4).on(cd.map_to_disk(mask)).centroids_yx[0] - centre).T
    assert (np.sign(y).tolist(), np.sign(x).tolist()) == ([1, 1, -1, -1], [1, -1, -1, 1])
