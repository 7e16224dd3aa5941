"""Series in time made ready for correlation: detrended, differenced, standardised, checked for stationarity.

All functions work along axis 0 and pass over NaN.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pandas as pd
from scipy.stats import kendalltau

from cytodisk.analysis.correlation.correlation_parameters import DetrendParameters, PrepareParameters
from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError
from cytodisk.taking import takes

_ROUNDING = 64.0 * np.finfo(np.float64).eps
"""Share of the largest magnitude below which a spread is nothing but rounding."""

KPSS_LIMIT = 0.463
"""Critical value of the KPSS statistic at 5 %."""

DRIFTING_SHARE = 0.25
"""Share of series that drift above which to say so; steady but slow ones of few frames seem to, too."""

_FEWEST_FOR_KPSS = 50  # values; in 30 a straight line has 0.44
_ONE_WAY = 0.5  # Kendall's τ of a series that goes one way rather than up and down


@takes(PrepareParameters)
def prepare_series(
    values: Any,
    **settings: Any,
) -> FloatArray:
    """Take slow changes out of series, in the order of the arguments.

    Parameters
    ----------
    values : array_like of shape (T, …)
        One series a column; NaN stays NaN.
    **settings
        See `PrepareParameters`.

    Returns
    -------
    ndarray of shape (T, …) and dtype float

    Raises
    ------
    ParameterError
        `detrend` is unknown, the frames of the median are too few, or there are no values by time.

    See Also
    --------
    cross_correlate : Prepares both series in the same way.

    Notes
    -----
    What rounding leaves of a straight line, or of its differences, is made one constant: it would correlate.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> bleaching = np.array([4.0, 3.0, 2.0, 1.0])
    >>> cd.prepare_series(bleaching, detrend="linear").round(6) + 0.0
    array([0., 0., 0., 0.])
    >>> cd.prepare_series(bleaching, difference=True)
    array([nan, -1., -1., -1.])
    """
    how = PrepareParameters.of(**settings)
    series = np.array(values, dtype=np.float64)
    if not series.ndim or not series.size:
        raise ParameterError(f"values must have time first and not be empty, got shape {series.shape}")
    columns = series.reshape(len(series), -1)
    if how.detrend == "linear":
        columns = columns - _lines(columns)
    elif how.detrend == "median":
        columns = columns - _moving_median(columns, how.detrend_frames or len(columns))
    if how.difference:
        columns = np.diff(columns, axis=0, prepend=np.nan)
    if how.difference or how.detrend != "none":
        columns = _without_rounding(columns, series.reshape(columns.shape))
    if how.zscore:
        columns = standardised(columns)
    return np.asarray(columns.reshape(series.shape))


def default_frames(how: DetrendParameters, max_lag: int) -> int | None:
    """Frames of the moving median: those asked for, else 4 max_lag + 1, which keeps what the lags compare."""
    missing = how.detrend_frames is None and how.detrend == "median" and max_lag
    return 4 * max_lag + 1 if missing else how.detrend_frames


def standardised(columns: FloatArray) -> FloatArray:
    """Each column minus its mean, divided by its standard deviation; a constant up to rounding becomes 0."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a column of all NaN stays so
        centred = columns - np.nanmean(columns, axis=0)
        spread = np.nanstd(columns, axis=0)
        extent = np.nanmax(columns, axis=0) - np.nanmin(columns, axis=0)
        constant = extent <= _ROUNDING * np.nanmax(np.abs(columns), axis=0)
    return np.asarray(np.where(constant, centred * 0.0, centred / np.where(spread > 0, spread, 1.0)))


def interpolated(columns: FloatArray) -> FloatArray:
    """Columns with NaN filled in linearly in time, at the ends by the nearest value.

    Parameters
    ----------
    columns : ndarray of shape (T, W) and dtype float

    Returns
    -------
    ndarray of shape (T, W) and dtype float
        A column of all NaN stays so.
    """
    frame = pd.DataFrame(columns)
    return np.asarray(frame.interpolate(limit_direction="both").to_numpy(dtype=np.float64))


def kpss(values: Any) -> FloatArray:
    """KPSS statistic of each series: large where its level drifts.

    Parameters
    ----------
    values : array_like of shape (T, …)
        NaN is left out.

    Returns
    -------
    ndarray of shape (…) and dtype float
        Above `KPSS_LIMIT` a stationary series comes in 5 % of cases. NaN for a constant, or fewer than 10
        values.

    Notes
    -----
    The long-run variance takes in 12 (n / 100)^(1/4) lags, rounded up, with Bartlett weights.

    References
    ----------
    Kwiatkowski, Phillips, Schmidt & Shin (1992), doi:10.1016/0304-4076(92)90104-Y.
    """
    return _of_each(_kpss, values)


def drifts(values: Any) -> BoolArray:
    """Which series drift: do not stay about one level.

    Parameters
    ----------
    values : array_like of shape (T, …)
        NaN is left out.

    Returns
    -------
    ndarray of shape (…) and dtype bool
        Whether the KPSS statistic is above its limit. In fewer than 50 values it does not rise above it even
        on a straight line: there, whether Kendall's τ with time is beyond 0.5.
    """
    return _of_each(_drifts, values).astype(bool)


def drifting_share(values: Any) -> float:
    """Share of the series that drift, of those of which it is known; 0 where it is known of none.

    Parameters
    ----------
    values : array_like of shape (T, …)
        NaN is left out.
    """
    known = np.isfinite(kpss(values))
    return float(drifts(values)[known].mean()) if known.any() else 0.0


def _of_each(measure: Callable[[FloatArray], float], values: Any) -> FloatArray:
    """A measure of each series without its NaN."""
    series = np.asarray(values, dtype=np.float64)
    columns = series.reshape(len(series), -1)
    found = [measure(column[np.isfinite(column)]) for column in columns.T]
    return np.array(found, dtype=np.float64).reshape(series.shape[1:])


def _drifts(series: FloatArray) -> bool:
    if series.size >= _FEWEST_FOR_KPSS:
        return _kpss(series) > KPSS_LIMIT
    if series.size < 3 or np.ptp(series) == 0:
        return False
    return bool(abs(kendalltau(np.arange(series.size), series).statistic) > _ONE_WAY)


def _kpss(series: FloatArray) -> float:
    count = series.size
    if count < 10 or np.ptp(series) <= _ROUNDING * np.abs(series).max():
        return np.nan
    residual = series - series.mean()
    lags = int(np.ceil(12.0 * (count / 100.0) ** 0.25))
    variance = residual @ residual
    for lag in range(1, min(lags, count - 1) + 1):
        variance += 2.0 * (1.0 - lag / (lags + 1.0)) * (residual[lag:] @ residual[:-lag])
    walk = np.cumsum(residual)
    return float((walk @ walk) / count / variance)


def _without_rounding(columns: FloatArray, before: FloatArray) -> FloatArray:
    """Columns, made constant where they vary by no more than rounding of what they were before."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # a column of all NaN stays so
        extent = np.nanmax(columns, axis=0) - np.nanmin(columns, axis=0)
        rounding = extent <= _ROUNDING * np.nanmax(np.abs(before), axis=0)
        return np.asarray(np.where(rounding, columns * 0.0 + np.nanmean(columns, axis=0), columns))


def _lines(columns: FloatArray) -> FloatArray:
    """Straight lines of least squares through columns with gaps."""
    present = np.isfinite(columns)
    count = np.maximum(present.sum(axis=0), 1)
    time = np.broadcast_to(np.arange(len(columns), dtype=np.float64)[:, None], columns.shape)
    middle = np.where(present, time, 0.0).sum(axis=0) / count
    level = np.where(present, columns, 0.0).sum(axis=0) / count
    away = np.where(present, time - middle, 0.0)
    square = (away**2).sum(axis=0)
    slope = (away * np.where(present, columns - level, 0.0)).sum(axis=0) / np.where(square > 0, square, 1.0)
    return np.asarray(level + slope * (time - middle))


def _moving_median(columns: FloatArray, frames: int) -> FloatArray:
    rolling = pd.DataFrame(columns).rolling(frames, center=True, min_periods=1)
    return np.asarray(rolling.median().to_numpy(dtype=np.float64))
