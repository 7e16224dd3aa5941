from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lfilter

from cytodisk.analysis.correlation.prepared_series import prepare_series
from cytodisk.analysis.correlation.surrogates import circularly_shifted, phase_randomised, surrogates
from cytodisk.errors import ParameterError

NAN = np.nan


def slow(seed: int, frames: int) -> Any:
    """Autoregressive noise with 0.8 from a frame to the next."""
    return lfilter([1.0], [1.0, -0.8], np.random.default_rng(seed).normal(size=frames + 100))[100:]


def turned(angle: Any, frames: int) -> Any:
    """The same turns for each component, or one for each, as one surrogate takes them."""
    return np.exp(1j * np.broadcast_to(angle, frames + 1))[:, None]


def mirrored_autocorrelation(series: Any) -> Any:
    """Mean product of a centred series and its mirror image with itself, at each distance in the ring."""
    ring = np.concatenate([series, series[::-1]]) - series.mean()
    return np.array([(ring * np.roll(ring, -k)).mean() for k in range(len(ring))])


@given(st.integers(0, 1000), st.integers(2, 30))
def test_turns_that_are_known_on_paper(seed: int, frames: int) -> None:
    series = 5.0 + slow(seed, frames)
    centred = series - series.mean()
    ring = np.concatenate([centred, centred[::-1]])
    still = phase_randomised(series, turned(0.0, frames))[:, 0]
    np.testing.assert_allclose(still, centred, atol=1e-12)
    opposite = phase_randomised(series, turned(np.pi, frames))[:, 0]
    np.testing.assert_allclose(opposite, -centred, atol=1e-12)
    step = -np.pi * np.arange(frames + 1) / frames  # of each component, one frame later in the ring of 2 T
    moved = phase_randomised(series, turned(3 * step, frames))[:, 0]
    np.testing.assert_allclose(moved, np.roll(ring, 3)[:frames], atol=1e-12)


@pytest.mark.parametrize("frames", [16, 17])
def test_spectrum_is_that_of_the_mirrored_series(frames: int) -> None:
    series = slow(1, frames)
    angle = np.random.default_rng(2).uniform(0.0, 2.0 * np.pi, frames + 1)
    first = phase_randomised(series, turned(angle, frames))[:, 0]
    later = angle - np.pi * np.arange(frames + 1)  # the same surrogate T frames on: the rest of the ring
    rest = phase_randomised(series, turned(later, frames))[:, 0]
    power = np.abs(np.fft.rfft(np.concatenate([first, rest])))
    expected = np.abs(np.fft.rfft(np.concatenate([series, series[::-1]]) - series.mean()))
    np.testing.assert_allclose(power, expected, atol=1e-10)
    assert not np.allclose(first, series - series.mean(), atol=0.1)


def without_line(series: Any) -> Any:
    return prepare_series(series, detrend="linear")


def test_autocorrelation_is_kept_in_the_mean() -> None:
    series = slow(3, 40)
    found = surrogates("phase", 40, 40_000, 0).alone(series)
    expected = mirrored_autocorrelation(series)
    for lag in (0, 1, 5):
        mean = (found[lag:] * found[: 40 - lag]).mean()
        assert mean == pytest.approx(expected[lag], abs=0.05 * expected[0])


def test_what_series_have_in_common_stays_at_every_lag_and_with_its_sign() -> None:
    """Covariances over lags are those of the series, divided by the frames: one follows the other."""
    first = without_line(slow(4, 60))
    second = without_line(np.roll(first, 5) + 0.5 * slow(6, 60))
    make = surrogates("phase", 60, 20_000, 1).together
    one, two = make(first), make(second)
    x, y = first - first.mean(), second - second.mean()
    for lag in (-5, -1, 0, 1, 5):
        early, late = slice(max(0, -lag), 60 - max(0, lag)), slice(max(0, lag), 60 + min(0, lag))
        found = np.mean((one[early] * two[late]).mean(axis=0))
        assert found == pytest.approx((x[early] * y[late]).sum() / 60, abs=0.03 * x.std() * y.std())
    np.testing.assert_allclose(make(3.0 * first - 7.0), 3.0 * one, atol=1e-10)
    other = surrogates("phase", 60, 20_000, 2).together(second)
    assert abs(np.mean((one[:-5] * other[5:]).mean(axis=0))) < 0.03 * x.std() * y.std()


def test_straight_lines_stay_with_one_sign_for_all_series() -> None:
    time = np.linspace(-1.0, 1.0, 50)
    make = surrogates("phase", 50, 500, 1).together
    up, down = make(3.0 + 2.0 * time), make(-time)
    np.testing.assert_allclose(up, -2.0 * down, atol=1e-9)
    np.testing.assert_allclose(np.abs(up), 2.0 * np.abs(time)[:, None].repeat(500, axis=1), atol=1e-9)
    assert 0.4 < (up[-1] > 0).mean() < 0.6


def test_a_series_that_starts_late_stays_like_its_neighbour() -> None:
    first = slow(4, 60)
    late = first.copy()
    late[:12] = NAN
    make = surrogates("phase", 60, 4000, 1).together
    one, two = make(first)[12:], make(late)[12:]
    alike = [np.corrcoef(a, b)[0, 1] for a, b in zip(one.T, two.T, strict=True)]
    assert np.mean(alike) > 0.8


@given(st.integers(0, 4), st.integers(0, 60), st.integers(0, 99))
def test_shifts_share_no_lag(max_lag: int, more: int, seed: int) -> None:
    """Else what is true at lag 0 would come back at another one, or the same count twice."""
    frames = 4 * max_lag + 2 + more
    make = surrogates("shift", frames, 200, seed, max_lag)
    moved = make.alone(np.arange(float(frames)))[0]
    shifts = np.sort((frames - moved) % frames)
    assert make.count == len(shifts) >= 1
    around = np.concatenate([[0.0], shifts, [frames]])
    assert (np.diff(around) > 2 * max_lag).all()
    with pytest.raises(ParameterError, match=f"{4 * max_lag + 2} frames.*max_lag {max_lag}"):
        surrogates("shift", 4 * max_lag + 1, 5, 0, max_lag)


def test_gaps_stay_gaps() -> None:
    series = slow(7, 30)
    series[[0, 1, 9, 10, 29]] = NAN
    found = surrogates("phase", 30, 5, 0).alone(series)
    np.testing.assert_array_equal(np.isnan(found), np.repeat(np.isnan(series)[:, None], 5, axis=1))
    line = series.copy()
    line[[9, 10]] = np.interp([9, 10], [8, 11], series[[8, 11]])  # filled in, hence no matter for the rest
    same = surrogates("phase", 30, 5, 0).alone(line)
    there = np.isfinite(series)
    np.testing.assert_allclose(found[there], same[there], atol=1e-12)


def test_empty_and_constant_series() -> None:
    make = surrogates("phase", 12, 3, 0).alone
    assert np.isnan(make(np.full(12, NAN))).all()
    np.testing.assert_allclose(make(np.full(12, 4.0)), 0.0, atol=1e-14)
    one = np.full(12, NAN)
    one[4] = 2.0
    assert np.isfinite(make(one)).sum() == 3


@given(st.integers(0, 1000), st.integers(2, 25))
def test_a_shift_is_a_permutation(seed: int, frames: int) -> None:
    series = slow(seed, frames)
    make = surrogates("shift", frames, 7, seed)
    found = make.alone(series)
    assert make.count == min(7, frames - 1)
    expected = np.repeat(np.sort(series)[:, None], make.count, axis=1)
    np.testing.assert_array_equal(np.sort(found, axis=0), expected)
    assert (found != series[:, None]).any(axis=0).all()  # no shift by nothing


def test_shifts_of_known_size() -> None:
    found = circularly_shifted(np.array([1.0, 2.0, NAN, 4.0]), np.array([1, 3]))
    np.testing.assert_array_equal(found, [[4.0, 2.0], [1.0, NAN], [2.0, 4.0], [NAN, 1.0]])


@pytest.mark.parametrize("null", ["phase", "shift"])
def test_the_seed_decides(null: Any) -> None:
    series = slow(8, 50)
    first, again, other = (surrogates(null, 50, 6, seed).together(series) for seed in (3, 3, 4))
    np.testing.assert_array_equal(first, again)
    assert not np.array_equal(first, other)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("noise", 20, 5, 0), "null must be one of phase, shift, got 'noise'"),
        (("phase", 20, 0, 0), "surrogates must be a whole number of at least 1, got 0"),
        (("phase", 20, 2.5, 0), "surrogates .* got 2.5"),
        (("phase", 20, 5, -1), "seed must be a whole number from 0 to [0-9]+, got -1"),
        (("phase", 20, 5, None), "seed .* got None"),
        (("shift", 1, 5, 0), "null 'shift' needs at least 2 frames at max_lag 0, got 1"),
    ],
)
def test_arguments_that_make_no_sense(arguments: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        surrogates(*arguments)
