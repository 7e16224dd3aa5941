import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cytodisk import map_to_disk, polar_windows, simulate
from cytodisk.windows.pixel_shares.raster import paint_windows
from cytodisk.windows.pixel_shares.shares import DIVIDED, Subpixels
from cytodisk.windows.pixel_shares.subpixels import subpixel_places
from cytodisk.windows.weights import windows_of_subpixels


def all_subpixels(subpixels: Subpixels) -> np.ndarray:
    """Windows of the 4×4 subpixels of all pixels, (P, 16)."""
    window = np.repeat(subpixels.whole[:, None], 16, axis=1)
    window[subpixels.whole == DIVIDED] = subpixels.window.reshape(-1, 16)
    return window


@given(
    kind=st.sampled_from(simulate.KINDS),
    seed=st.integers(0, 1000),
    layers=st.integers(1, 30),
    sectors=st.integers(1, 90),
    spacing=st.sampled_from(["area", "radius"]),
)
@settings(max_examples=25, deadline=None)
def test_every_subpixel_is_in_the_window_that_its_place_maps_into(
    kind: str, seed: int, layers: int, sectors: int, spacing: str
) -> None:
    disk = map_to_disk(simulate.random_mask(kind, seed))
    grid = polar_windows(layers, sectors, spacing)
    pixels = np.argwhere(disk.mask)
    one_by_one = windows_of_subpixels(grid, disk, pixels, 4)
    subpixels = paint_windows(grid, disk)
    found = all_subpixels(subpixels)
    divided = found[subpixels.whole == DIVIDED]
    assert (divided != divided[:, :1]).any(axis=1).all()
    apart = found != one_by_one
    # Rounding may decide for a subpixel that lies on the border between two windows, or at the centre.
    uv = disk.to_disk(subpixel_places(pixels, 4)[apart], outside="nearest")
    turned = [(1.0 + a) * uv @ np.array([[1.0, b], [-b, 1.0]]) for a in (-1e-9, 1e-9) for b in (-1e-9, 1e-9)]
    beside = (np.array([grid.window_of(near) for near in turned]) == found[apart]).any(axis=0)
    assert (beside | (np.hypot(*uv.T) < 1e-9)).all()
    assert apart.sum() <= 16 + 1e-3 * apart.size  # a symmetric pixel has many such subpixels


@pytest.mark.parametrize("mask", [np.ones((1, 1)), np.ones((2, 9)), np.eye(6)])
def test_cells_of_a_few_pixels_anywhere_in_an_image(mask: np.ndarray) -> None:
    disk = map_to_disk(np.pad(mask > 0, ((3, 0), (0, 5))))
    grid = polar_windows(3, 5)
    one_by_one = windows_of_subpixels(grid, disk, np.argwhere(disk.mask), 4)
    np.testing.assert_array_equal(all_subpixels(paint_windows(grid, disk)), one_by_one)
