from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.stats import pearsonr

from cytodisk.analysis.correlation.lagged import LaggedSeries

NAN = np.nan
LAGS = np.arange(-5, 6)


def noise(seed: int, *shape: int, missing: float = 0.0) -> Any:
    random = np.random.default_rng(seed)
    values = random.normal(size=shape)
    values[random.random(shape) < missing] = NAN
    return values


def overlap(a: Any, b: Any, lag: int) -> tuple[Any, Any]:
    """Values of a[t] and b[t + lag] where both are there, written out."""
    pairs = [(a[t], b[t + lag]) for t in range(len(a)) if 0 <= t + lag < len(b)]
    both = np.array([pair for pair in pairs if np.isfinite(pair).all()]).reshape(-1, 2)
    return both[:, 0], both[:, 1]


def by_hand(a: Any, b: Any, lags: Any, least: int) -> tuple[Any, Any]:
    """Correlations and pairs, shape (K, H, R), one at a time."""
    shape = len(lags), a.shape[1], b.shape[1]
    correlation, count = np.full((2, *shape), NAN)
    for k, h, r in np.ndindex(shape):
        x, y = overlap(a[:, h], b[:, r], lags[k])
        count[k, h, r] = len(x)
        if len(x) >= least and np.ptp(x) > 0.0 and np.ptp(y) > 0.0:
            correlation[k, h, r] = pearsonr(x, y)[0]
            centred = x - x.mean(), y - y.mean()
            formula = centred[0] @ centred[1] / np.linalg.norm(centred[0]) / np.linalg.norm(centred[1])
            assert correlation[k, h, r] == pytest.approx(formula, abs=1e-12)
    return correlation, count


@pytest.mark.parametrize(("in_a", "in_b"), [(0.0, 0.0), (0.3, 0.0), (0.0, 0.3), (0.3, 0.3)])
@pytest.mark.parametrize(
    ("offset", "scale"), [(0.0, 1.0), (1e6, 1.0), (0.0, 1e-12), (-1e6, 1e3), (1e-9, 1e-9)]
)
def test_every_lag_is_scipys_correlation(in_a: float, in_b: float, offset: float, scale: float) -> None:
    a = offset + scale * noise(1, 24, 3, missing=in_a)
    b = offset + scale * noise(2, 24, 2, missing=in_b)
    expected, count = by_hand(a, b, LAGS, 4)
    found, pairs = LaggedSeries(a, LAGS).correlate(b, 4)
    np.testing.assert_allclose(found, expected, atol=1e-12, rtol=0.0)
    np.testing.assert_array_equal(np.broadcast_to(pairs, found.shape), count)
    assert np.isfinite(found).any()


@given(st.integers(0, 10_000), st.floats(0.0, 0.8), st.integers(3, 8))
def test_any_gaps(seed: int, missing: float, least: int) -> None:
    a, b = noise(seed, 14, 2, missing=missing), noise(seed + 1, 14, 2, missing=missing)
    expected, _ = by_hand(a, b, LAGS, least)
    found, _ = LaggedSeries(a, LAGS).correlate(b, least)
    np.testing.assert_allclose(found, expected, atol=1e-10, rtol=0.0)


@given(st.integers(0, 1000), st.floats(1e-3, 1e3), st.floats(-1e3, 1e3))
def test_no_change_of_scale_or_offset_matters(seed: int, scale: float, offset: float) -> None:
    a, b = noise(seed, 20, 1, missing=0.1), noise(seed + 1, 20, 1, missing=0.1)
    first, _ = LaggedSeries(a, LAGS).correlate(b, 4)
    again, _ = LaggedSeries(offset - scale * a, LAGS).correlate(scale * b + offset, 4)
    np.testing.assert_allclose(again, -first, atol=1e-8)


def test_swapped_series_have_the_mirrored_curve() -> None:
    a, b = noise(3, 30, 1, missing=0.2), noise(4, 30, 1, missing=0.2)
    forwards, _ = LaggedSeries(a, LAGS).correlate(b, 4)
    backwards, _ = LaggedSeries(b, LAGS).correlate(a, 4)
    np.testing.assert_allclose(forwards, backwards[::-1], atol=1e-12)


@pytest.mark.parametrize("lag", [-4, 0, 3])
def test_positive_lag_when_the_other_follows(lag: int) -> None:
    long = noise(5, 60)
    a, b = long[10:50], long[10 - lag : 50 - lag]  # b[t + lag] = a[t]
    found, _ = LaggedSeries(a[:, None], LAGS).correlate(b[:, None], 10)
    assert LAGS[np.abs(found[:, 0, 0]).argmax()] == lag
    assert found[:, 0, 0].max() == pytest.approx(1.0, abs=1e-12)
    assert found.max() <= 1.0


@pytest.mark.parametrize("value", [0.0, 0.1, 1e6 / 3.0, NAN])
def test_a_series_that_does_not_vary_has_no_correlation(value: float) -> None:
    still, moving = np.full((20, 1), value), noise(6, 20, 1)
    for a, b in ((still, moving), (moving, still), (still, still)):
        found, _ = LaggedSeries(a, LAGS).correlate(b, 3)
        assert np.isnan(found).all()


def test_a_series_that_does_not_vary_over_the_pairs_of_a_lag() -> None:
    a = np.full((20, 1), 0.1)
    a[:5, 0] = noise(7, 5)  # at lags of -5 and below only the constant part has a partner
    found, count = LaggedSeries(a, LAGS).correlate(noise(8, 20, 1), 3)
    assert np.isnan(found[0])
    assert np.isfinite(found[1:]).all()
    np.testing.assert_array_equal(count[:, 0, 0], 20 - np.abs(LAGS))


def test_too_few_pairs() -> None:
    a = noise(9, 12, 1)
    a[6:] = NAN
    found, count = LaggedSeries(a, LAGS).correlate(noise(10, 12, 1), 6)
    np.testing.assert_array_equal(count[:, 0, 0] >= 6, np.isfinite(found[:, 0, 0]))
    assert np.isnan(found[0])
    assert np.isfinite(found[5])


def test_same_gaps_are_counted_once() -> None:
    a, b = noise(11, 20, 3), noise(12, 20, 4)
    a[7], b[19] = NAN, NAN
    found, count = LaggedSeries(a, LAGS).correlate(b, 3)
    assert found.shape == (11, 3, 4)
    assert count.shape == (11, 1, 1)
    np.testing.assert_allclose(found, by_hand(a, b, LAGS, 3)[0], atol=1e-12)
