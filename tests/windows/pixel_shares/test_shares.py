import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

import cytodisk as cd
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.windows.pixel_shares.shares import DIVIDED, NOWHERE, Subpixels, gather_shares, with_starts
from cytodisk.windows.weights import windows_of_subpixels

WINDOWS = 7


def random_subpixels(rng: np.random.Generator, n_pixels: int) -> Subpixels:
    """Whole and divided pixels, some of them in 16×16 and with more squares, some parts in no window."""
    whole = rng.integers(NOWHERE, WINDOWS, n_pixels).astype(np.int32)
    divided = rng.choice(n_pixels, n_pixels // 2, replace=False)
    plain = with_starts(whole, np.empty(0, dtype=np.int32))
    sizes = rng.choice([16, 17, 256, 259], len(divided))
    return plain.with_divided(
        {
            int(pixel): rng.integers(NOWHERE, WINDOWS, size).astype(np.int32)
            for pixel, size in zip(divided, sizes, strict=True)
        }
    )


def squares_of(size: int) -> list[tuple[float, float, float]]:
    """Middle and side of each part of a pixel that has so many."""
    per_side = 16 if size >= 256 else 4
    steps = (np.arange(per_side) + 0.5) / per_side - 0.5
    lattice = [(y, x, 1.0 / per_side) for y in steps for x in steps]
    return lattice + [(0.0, 0.0, 1.0)] * (size - len(lattice))


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 10_000), shape=st.tuples(st.integers(1, 9), st.integers(1, 9)))
def test_weights_and_moments_have_a_plain_twin(seed: int, shape: tuple[int, int]) -> None:
    rng = np.random.default_rng(seed)
    mask = rng.random(shape) < 0.7
    mask[0, 0] = True
    placed = PlacedMask(mask, (3, 5), (20, 20))
    subpixels = random_subpixels(rng, int(mask.sum()))
    found = gather_shares(placed, WINDOWS, subpixels)
    weights, moments = np.zeros((WINDOWS, mask.sum())), np.zeros((WINDOWS, 5))
    for pixel, place in enumerate(np.argwhere(mask)):
        own = subpixels.of_pixel(pixel)
        for window, (down, right, side) in zip(own, squares_of(len(own)), strict=True):
            if window == NOWHERE:
                continue
            y, x = place[0] + down, place[1] + right
            weights[window, pixel] += 1.0 / len(own)
            more = side**2 / 12
            moments[window] += np.array([y, x, y * y + more, x * x + more, x * y]) / len(own)
    assert_allclose(found.weights.toarray(), weights, rtol=1e-12)
    assert_allclose(found.moments, moments, rtol=1e-12, atol=1e-12)
    assert found.weights.has_canonical_format
    assert found.origin_yx.tolist() == [3, 5]


def test_other_subpixels_of_some_pixels_leave_the_others() -> None:
    rng = np.random.default_rng(0)
    before = random_subpixels(rng, 40)
    other = {3: np.full(256, 2, dtype=np.int32), 8: np.arange(16, dtype=np.int32) % WINDOWS}
    after = before.with_divided(other)
    assert (after.whole[3], after.whole[8]) == (2, DIVIDED)
    assert_array_equal(after.of_pixel(8), other[8])
    for pixel in set(range(40)) - set(other):
        assert_array_equal(after.of_pixel(pixel), before.of_pixel(pixel))
    assert after.start[-1] == len(after.window)


@settings(max_examples=15, deadline=None)
@given(
    kind=st.sampled_from(cd.simulate.KINDS),
    seed=st.integers(0, 1000),
    layers=st.integers(1, 12),
    sectors=st.integers(1, 40),
)
def test_areas_are_those_of_subpixels_that_are_mapped_one_by_one(
    kind: str, seed: int, layers: int, sectors: int
) -> None:
    disk = cd.map_to_disk(cd.simulate.random_mask(kind, seed))
    grid = cd.polar_windows(layers, sectors)
    windows = windows_of_subpixels(grid, disk, disk.placed_mask.pixels_yx, 4)
    plain = np.bincount(windows.ravel(), minlength=grid.n_windows) / 16
    if plain.min() == 0:
        return  # pixels are divided further
    found = grid.on(disk).areas.ravel()
    assert np.abs(found - plain).sum() <= (16 + 1e-3 * windows.size) / 8  # parts on a border may be in either
    assert found.sum() == pytest.approx(disk.placed_mask.box.sum(), rel=1e-12)
