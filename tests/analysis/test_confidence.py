import warnings
from typing import Any

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import pearsonr
from statsmodels.tsa import stattools

from cytodisk.analysis.correlation.confidence import autocorrelation, effective_share, fisher_interval
from cytodisk.analysis.correlation.lagged import LaggedSeries

NAN = np.nan


def ar1(seed: int, frames: int, count: int, feedback: float) -> Any:
    noise = np.random.default_rng(seed).normal(size=(frames + 200, count))
    return lfilter([1.0], [1.0, -feedback], noise, axis=0)[200:]


def acf(series: Any, lags: int, **options: Any) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # what it will return one day
        return np.asarray(stattools.acf(series, nlags=lags, fft=False, **options))


def test_autocorrelation_is_the_adjusted_one_of_statsmodels() -> None:
    values = 5.0 + ar1(0, 50, 4, 0.7).reshape(50, 2, 2)
    found = autocorrelation(values, np.arange(15))
    assert found.shape == (15, 2, 2)
    for place in np.ndindex(2, 2):
        expected = acf(values[(slice(None), *place)], 14, adjusted=True)
        np.testing.assert_allclose(found[(slice(None), *place)], expected, atol=1e-12)
    biased = acf(values[:, 0, 0], 14)  # the default divides by all frames: it shrinks with the lag
    np.testing.assert_allclose(found[:, 0, 0] * (1.0 - np.arange(15) / 50.0), biased, atol=1e-12)


def test_autocorrelation_with_gaps_is_that_of_statsmodels() -> None:
    series = ar1(1, 60, 1, 0.7)
    series[np.random.default_rng(0).random((60, 1)) < 0.25] = NAN
    expected = acf(series[:, 0], 10, adjusted=True, missing="conservative")
    np.testing.assert_allclose(autocorrelation(series, np.arange(11))[:, 0], expected, atol=1e-12)


def test_correlation_by_lag_is_not_the_ccf_of_statsmodels() -> None:
    # ccf takes mean and deviation from the whole series, pearsonr from the frames that overlap
    a, b = ar1(2, 40, 1, 0.7), ar1(3, 40, 1, 0.7)
    found, _ = LaggedSeries(a, np.array([0, 6])).correlate(b, 3)
    ccf = stattools.ccf(b[:, 0], a[:, 0], adjusted=True, fft=False)[[0, 6]]
    assert found[0, 0, 0] == pytest.approx(ccf[0], abs=1e-12)
    assert found[1, 0, 0] == pytest.approx(pearsonr(a[:-6, 0], b[6:, 0])[0], abs=1e-12)
    early, late = a[:-6, 0], b[6:, 0]
    share = (a.std() * b.std()) / (early.std() * late.std())
    offset = (early.mean() - a.mean()) * (late.mean() - b.mean()) / (early.std() * late.std())
    assert found[1, 0, 0] == pytest.approx(ccf[1] * share - offset, abs=1e-12)


def test_autocorrelation_of_nothing() -> None:
    values = np.column_stack([np.full(12, 0.1), np.full(12, NAN)])
    assert np.isnan(autocorrelation(values, np.arange(3))).all()
    alone = np.array([1.0, NAN, 2.0, NAN, 4.0])[:, None]
    assert autocorrelation(alone, np.array([1]))[0, 0] == 0.0


def test_effective_share_written_out() -> None:
    a, b = ar1(4, 40, 3, 0.8).reshape(40, 3, 1), ar1(5, 40, 2, 0.5).reshape(40, 1, 2)
    found = effective_share(a, b)
    assert found.shape == (3, 2)
    for i, k in np.ndindex(3, 2):
        rho_a, rho_b = (acf(x, 8, adjusted=True) for x in (a[:, i, 0], b[:, 0, k]))
        total = sum((1.0 - lag / 40.0) * rho_a[lag] * rho_b[lag] for lag in range(1, 9))
        assert found[i, k] == pytest.approx(1.0 / max(1.0 + 2.0 * total, 1.0), rel=1e-12)


def test_effective_share_of_long_series_is_bartletts() -> None:
    # with feedback c both have rho = c^k: 1 + 2 sum c^2k = (1 + c^2) / (1 - c^2)
    slow = effective_share(ar1(6, 20_000, 1, 0.8), ar1(7, 20_000, 1, 0.8))[0]
    assert slow == pytest.approx((1.0 - 0.64) / (1.0 + 0.64), rel=0.15)
    noise = np.random.default_rng(0).normal(size=(2, 20_000, 1))
    assert effective_share(*noise)[0] == pytest.approx(1.0, abs=0.05)


def test_effective_share_is_a_share() -> None:
    oscillating = np.sin(0.7 * np.arange(60.0))[:, None]
    opposite = np.where(np.arange(60) % 2, 1.0, -1.0)[:, None]
    for a in (oscillating, opposite, ar1(8, 60, 50, 0.9)):
        share = effective_share(a, ar1(9, 60, 1, 0.9))
        assert ((share > 0.0) & (share <= 1.0)).all()
    assert np.isnan(effective_share(np.full((60, 1), 3.0), opposite)).all()


@pytest.mark.parametrize("n", [4, 10, 200])
@pytest.mark.parametrize("r", [-0.99, -0.3, 0.0, 0.8])
def test_interval_is_that_of_scipy(r: float, n: int) -> None:
    x, y = np.random.default_rng(n).normal(size=(2, n))
    y -= np.polyval(np.polyfit(x, y, 1), x)
    x = (x - x.mean()) / x.std()
    y = r * x + np.sqrt(1.0 - r**2) * y / y.std()
    expected = pearsonr(x, y).confidence_interval(0.95)
    low, high = fisher_interval(np.array(r), np.array(float(n)), 0.95)
    assert (float(low), float(high)) == pytest.approx((expected.low, expected.high), abs=1e-9)


def test_interval_that_says_nothing() -> None:
    r = np.array([0.5, -1.0, 1.0, NAN, 0.2])
    low, high = fisher_interval(r, np.array([3.0, 1.0, 50.0, 50.0, NAN]), 0.95)
    np.testing.assert_array_equal(low[:2], -1.0)
    np.testing.assert_array_equal(high[:2], 1.0)
    assert low[2] == pytest.approx(1.0)
    assert high[2] == pytest.approx(1.0)
    assert np.isnan([low[3], high[3], low[4], high[4]]).all()


def test_interval_covers_the_truth_as_often_as_it_says() -> None:
    frames, count, strength = 300, 1500, 0.4
    a, noise = ar1(10, frames, count, 0.7), ar1(11, frames, count, 0.7)
    b = strength * a + np.sqrt(1.0 - strength**2) * noise
    r = np.array([np.corrcoef(x, y)[0, 1] for x, y in zip(a.T, b.T, strict=True)])
    low, high = fisher_interval(r, frames * effective_share(a, b), 0.95)
    covered = ((low <= strength) & (strength <= high)).mean()
    plain = fisher_interval(r, np.full(count, float(frames)), 0.95)
    assert 0.91 < covered < 0.98
    assert ((plain[0] <= strength) & (strength <= plain[1])).mean() < 0.85  # what autocorrelation does else
