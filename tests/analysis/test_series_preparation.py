import warnings
from typing import Any

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st
from statsmodels.tsa import stattools

from cytodisk.analysis.correlation.cross_correlation import cross_correlate
from cytodisk.analysis.correlation.prepared_series import (
    KPSS_LIMIT,
    drifting_share,
    interpolated,
    kpss,
    prepare_series,
    standardised,
)
from cytodisk.analysis.pairs.pair_correlation import correlate_pairs
from cytodisk.errors import ParameterError

NAN = np.nan


def noise(seed: int, *shape: int, missing: float = 0.0) -> Any:
    random = np.random.default_rng(seed)
    values = random.normal(size=shape)
    values[random.random(shape) < missing] = NAN
    return values


def test_nothing_is_done_unless_asked_for() -> None:
    values = noise(0, 12, 2, 3, missing=0.2)
    kept = values.copy()
    np.testing.assert_array_equal(prepare_series(values), kept)
    prepare_series(values, detrend="linear", difference=True, zscore=True)
    np.testing.assert_array_equal(values, kept)


@pytest.mark.parametrize("missing", [0.0, 0.3])
def test_linear_is_the_line_of_polyfit(missing: float) -> None:
    values = noise(1, 30, 2, 3, missing=missing) + 0.3 * np.arange(30.0)[:, None, None] + 50.0
    found = prepare_series(values, detrend="linear")
    time = np.arange(30.0)
    for place in np.ndindex(2, 3):
        series = values[(slice(None), *place)]
        there = np.isfinite(series)
        line = np.polyval(np.polyfit(time[there], series[there], 1), time)
        np.testing.assert_allclose(found[(slice(None), *place)], series - line, atol=1e-10)


@pytest.mark.parametrize("frames", [3, 7, 100])
@pytest.mark.parametrize("missing", [0.0, 0.3])
def test_median_is_that_of_frames_around(frames: int, missing: float) -> None:
    series = noise(2, 25, missing=missing) + 3.0
    half = frames // 2
    around = [series[max(0, t - half) : t + half + 1] for t in range(25)]
    expected = [series[t] - np.nanmedian(around[t]) if np.isfinite(series[t]) else NAN for t in range(25)]
    found = prepare_series(series, detrend="median", detrend_frames=frames if frames != 100 else 101)
    np.testing.assert_allclose(found, expected, atol=1e-14)


def test_median_without_frames_takes_them_all() -> None:
    series = pd.Series(noise(3, 21))
    expected = series - series.rolling(21, center=True, min_periods=1).median()
    np.testing.assert_array_equal(prepare_series(series, detrend="median"), expected)


def test_differences_stand_at_the_later_frame() -> None:
    found = prepare_series([1.0, 4.0, NAN, 5.0, 5.5], difference=True)
    np.testing.assert_array_equal(found, [NAN, 3.0, NAN, NAN, 0.5])


@given(st.integers(0, 1000), st.sampled_from([0.0, 0.4]))
def test_zscore_is_that_of_numpy(seed: int, missing: float) -> None:
    values = 7.0 + 3.0 * noise(seed, 15, 3, missing=missing)
    values[:2] = [[1.0, 2.0, 3.0], [4.0, 5.0, 9.0]]
    expected = (values - np.nanmean(values, axis=0)) / np.nanstd(values, axis=0)
    np.testing.assert_allclose(prepare_series(values, zscore=True), expected, rtol=1e-12)


def test_order_is_trend_difference_zscore() -> None:
    values = noise(4, 30, 2).cumsum(axis=0)
    step = prepare_series(values, detrend="median", detrend_frames=9)
    step = np.vstack([np.full((1, 2), NAN), np.diff(step, axis=0)])
    step = (step - np.nanmean(step, axis=0)) / np.nanstd(step, axis=0)
    found = prepare_series(values, detrend="median", detrend_frames=9, difference=True, zscore=True)
    np.testing.assert_allclose(found, step, rtol=1e-12)


def test_constants_and_empty_series() -> None:
    values = np.column_stack([np.full(12, 0.1), np.full(12, NAN), noise(5, 12)])
    found = prepare_series(values, zscore=True)
    np.testing.assert_array_equal(found[:, 0], 0.0)
    assert np.isnan(found[:, 1]).all()
    assert np.isfinite(found[:, 2]).all()
    assert np.isnan(prepare_series(values, detrend="linear", difference=True)[:, 1]).all()


@pytest.mark.parametrize("level", [0.0, 0.1, 5.0, -1e6])
@pytest.mark.parametrize("options", [{"detrend": "linear"}, {"difference": True}])
def test_what_rounding_leaves_of_a_line_is_constant(level: float, options: Any) -> None:
    line = level + 0.1 * np.arange(50.0)
    found = prepare_series(line, **options)
    assert np.nanmax(found) == np.nanmin(found)
    np.testing.assert_array_equal(standardised(found[:, None])[np.isfinite(found)], 0.0)


def test_a_constant_up_to_rounding_becomes_0() -> None:
    values = 100.0 * (1.0 + 1e-15 * noise(6, 40, 2))
    assert np.ptp(values, axis=0).min() > 0.0
    np.testing.assert_array_equal(standardised(values), 0.0)
    assert np.isnan(kpss(values)).all()


def test_a_small_signal_on_a_large_offset_is_none_of_rounding() -> None:
    wave = 1e-3 * np.sin(np.arange(40.0))
    found = standardised((1e6 + wave)[:, None])[:, 0]
    np.testing.assert_allclose(found, (wave - wave.mean()) / wave.std(), atol=1e-6)


def test_interpolated_is_linear_and_keeps_the_ends() -> None:
    columns = np.array([[NAN, NAN], [2.0, NAN], [NAN, NAN], [4.0, NAN], [NAN, NAN]])
    np.testing.assert_array_equal(interpolated(columns)[:, 0], [2.0, 2.0, 3.0, 4.0, 4.0])
    assert np.isnan(interpolated(columns)[:, 1]).all()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"detrend": "quadratic"}, "detrend must be one of none, linear, median, got 'quadratic'"),
        (
            {"detrend": "median", "detrend_frames": 2},
            "detrend_frames must be a whole number from 3 to 1000000, got 2",
        ),
        ({"detrend": "median", "detrend_frames": 0}, "detrend_frames .* got 0"),
        ({"detrend": "median", "detrend_frames": 4.5}, "detrend_frames .* got 4.5"),
        ({"detrend": "median", "detrend_frames": "5"}, "detrend_frames .* got '5'"),
    ],
)
def test_options_that_make_no_sense(options: Any, message: str) -> None:
    with pytest.raises(ParameterError, match=message):
        prepare_series(noise(0, 20), **options)
    with pytest.raises(ParameterError, match=message):
        cross_correlate(noise(0, 20), noise(1, 20), 2, **options)
    with pytest.raises(ParameterError, match=message):
        correlate_pairs(noise(0, 20, 1, 2), noise(1, 20, 1, 2), 2, **options)


@pytest.mark.parametrize("values", [3.0, np.zeros((0, 3)), np.zeros((4, 0))])
def test_no_series(values: Any) -> None:
    with pytest.raises(ParameterError, match=r"values.*time first"):
        prepare_series(values)


def statsmodels_kpss(series: Any) -> float:
    """Statistic with as many lags as `kpss` takes."""
    lags = min(int(np.ceil(12.0 * (len(series) / 100.0) ** 0.25)), len(series) - 1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # about its p-value, and what it will return one day
        return float(stattools.kpss(series, regression="c", nlags=lags)[0])


@pytest.mark.parametrize("frames", [10, 11, 50, 100, 333])
def test_kpss_is_that_of_statsmodels(frames: int) -> None:
    values = 5.0 + np.column_stack([noise(frames, frames), noise(frames, frames).cumsum()])
    expected = [statsmodels_kpss(series) for series in values.T]
    np.testing.assert_allclose(kpss(values), expected, rtol=1e-10)
    gaps = np.insert(values, [0, 3, frames], NAN, axis=0)
    np.testing.assert_allclose(kpss(gaps), expected, rtol=1e-10)


def test_kpss_says_nothing_of_constants_and_short_series() -> None:
    values = np.full((20, 2, 3), 4.0)
    values[:9, 1, 2] = noise(0, 9)
    values[9:, 1, 2] = NAN
    assert kpss(values).shape == (2, 3)
    assert np.isnan(kpss(values)).all()
    assert kpss(xr.DataArray(noise(0, 20), dims="time")).shape == ()


def test_kpss_holds_its_level_for_noise() -> None:
    share = (kpss(noise(7, 400, 2000)) > KPSS_LIMIT).mean()
    assert 0.025 < share < 0.065  # 0.05; at this length lags of the long-run variance take some of it


def test_the_share_of_drifting_series_is_of_those_of_which_it_is_known() -> None:
    line = np.linspace(0.0, 6.0, 80)[:, None] + noise(3, 80, 1, missing=0.1)
    still, constant = noise(4, 80, 1), np.ones((80, 2))
    assert drifting_share(np.concatenate([line, still, constant], axis=1)) == 0.5
    assert drifting_share(constant) == 0.0
