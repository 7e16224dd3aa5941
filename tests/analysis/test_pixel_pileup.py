"""Pixels at the ends of a signal's range, against images whose history is known."""

import numpy as np
import pytest
import xarray as xr

from cytodisk.analysis.pixel_pileup import clipped_note, clipped_share, pileup, saturated_share

N = 3000


def drawn(seed: int = 1000) -> np.random.Generator:
    return np.random.default_rng(seed)


@pytest.mark.parametrize("scale", [1, 5])
@pytest.mark.parametrize("mean", [0.35, 0.6, 1.0])
def test_dim_images_are_not_clipped(mean: float, scale: int) -> None:
    """Many pixels got no photon, whatever a photon counts."""
    values = scale * drawn().poisson(mean, N)
    assert np.mean(values == 0) > 0.3
    assert clipped_share(values) == 0.0
    assert saturated_share(values) == 0.0


@pytest.mark.parametrize("seed", range(1000, 1020))
def test_dim_and_uneven_images_are_not_clipped(seed: int) -> None:
    """Many zeros: an edge that is bright, and an inside that is dark."""
    bright = 3.0 * np.exp(-np.linspace(0.0, 5.0, N))
    assert clipped_share(drawn(seed).poisson(bright)) == 0.0
    assert clipped_share(drawn(seed).poisson(drawn(seed).gamma(0.5, 1.0, N))) == 0.0


@pytest.mark.parametrize("seed", range(1000, 1010))
def test_where_most_is_zero_dim_and_cut_off_look_the_same(seed: int) -> None:
    noise = drawn(seed).normal(size=N)
    cut = np.maximum(noise - np.quantile(noise, 0.9), 0.0).round()
    dim = drawn(seed).poisson(0.05, N)
    for values in (cut, dim):
        assert clipped_share(values) == np.mean(values == 0) > 0.9
        assert clipped_note(values).startswith("most of the cell is 0: dim or cut off")
    grey = np.maximum(100.0 * (noise - np.quantile(noise, 0.8)), 0.0).round()
    assert clipped_share(grey) == pytest.approx(0.8, abs=0.01)
    assert clipped_note(grey) == ""  # enough levels are left to be sure
    assert clipped_note(noise) == ""


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])
def test_an_image_of_two_values_is_a_mask(share: float) -> None:
    values = (drawn().random(N) > share).astype(float)
    assert clipped_share(values) == 0.0
    assert clipped_note(values) == ""


@pytest.mark.parametrize("share", [0.12, 0.4, 0.75])
@pytest.mark.parametrize("spread", [20.0, 60.0, 300.0])
def test_background_taken_off_too_far(share: float, spread: float) -> None:
    raw = drawn().normal(0.0, spread, N)
    values = np.maximum(raw - np.quantile(raw, share), 0.0)
    assert clipped_share(values) == pytest.approx(share, abs=0.01)
    assert clipped_share(values.round()) == pytest.approx(share, abs=0.02)


def test_few_levels_and_most_of_them_cut_off() -> None:
    assert clipped_share(np.maximum(drawn().normal(-2.7, 4.0, N).round(), 0.0)) > 0.7


def test_below_a_threshold_set_to_zero() -> None:
    raw = drawn().normal(100.0, 30.0, N).round()
    assert clipped_share(np.where(raw < 90, 0, raw)) == pytest.approx(0.37, abs=0.03)


def test_a_black_frame_is_clipped_and_an_even_one_is_not() -> None:
    assert clipped_share(np.zeros(N)) == 1.0
    assert clipped_share(np.full(N, 7)) == 0.0
    assert saturated_share(np.full(N, 7)) == 0.0
    assert saturated_share(np.full(N, 255)) == 1.0
    assert clipped_share(np.array([])) == saturated_share(np.array([])) == 0.0


@pytest.mark.parametrize("most", [255.0, 4095.0, 65535.0, 777.0])
@pytest.mark.parametrize("share", [0.02, 0.2])
def test_saturated(most: float, share: float) -> None:
    raw = drawn().normal(0.7 * most, 0.15 * most, N)
    values = np.minimum(raw + most - np.quantile(raw, 1 - share), most).round()
    assert saturated_share(values) == pytest.approx(share, abs=0.01)


@pytest.mark.parametrize("seed", range(1000, 1020))
def test_ordinary_images_have_no_pile(seed: int) -> None:
    random = drawn(seed)
    for values in (
        random.normal(size=N),
        random.normal(100, 10, N).astype(np.uint8),
        random.gamma(2.0, 50.0, N).round(),
        random.integers(0, 256, N),
        random.normal(3.0, 1.0, N).round(),
        random.poisson(np.linspace(2, 40, N)),
    ):
        assert clipped_share(values) == saturated_share(values) == 0.0


def test_the_worst_channel_is_named() -> None:
    raw = drawn().normal(100.0, 20.0, (3, 40, 40)).round()
    raw[1] = np.maximum(raw[1] - 100.0, 0.0)
    raw[2] = np.minimum(raw[2], 110.0)
    image = xr.DataArray(raw, {"channel": ["VASP", "actin", "Rac1"]}, ("channel", "y", "x"))
    inside = np.zeros((40, 40), dtype=bool)
    inside[5:35, 5:35] = True
    raw[:, 6, 6] = np.nan  # is no number, and no end of a range
    found = pileup(image["channel"].to_numpy().tolist(), image.to_numpy()[:, inside])
    assert (found.clipped_channel, found.saturated_channel) == ("actin", "Rac1")
    assert found.clipped == pytest.approx(0.5, abs=0.05)
    assert found.clipped_note == ""
    assert found.saturated == pytest.approx(0.31, abs=0.05)
