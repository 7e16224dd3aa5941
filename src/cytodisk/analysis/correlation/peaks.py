"""The peak of a correlation over lags, and its significance."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.correlation.correlation_parameters import PeakParameters, Rule
from cytodisk.analysis.correlation.lag_tables import with_units
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import ParameterError
from cytodisk.taking import takes

_AT_PEAK = ("n", "n_effective", "low", "high")


@takes(PeakParameters)
def peak_correlation(correlations: xr.Dataset, **settings: Any) -> xr.Dataset:
    """Peak of the correlation of each window over lags, its lag and its significance.

    Parameters
    ----------
    correlations : Dataset
        Of `cross_correlate`, or its mean over sectors, of `correlation_by_layer`.
    **settings
        See `PeakParameters`.

    Returns
    -------
    Dataset with the dims of the windows
        correlation, lag (frames), lag_s when the interval is known; n, n_effective, low, high at the peak
        where `correlations` has them; the interval is that of a lag chosen beforehand, narrow for a peak.
        With surrogates also p, the share of surrogates that are at least as large at any lag, and q, its
        Benjamini-Hochberg adjustment over all windows. NaN where a window has no correlation.

    Raises
    ------
    ParameterError
        `correlations` has no lags, or the rule is unknown.

    See Also
    --------
    cross_correlate : Makes the correlations.
    correlation_by_layer : Means over sectors.

    Notes
    -----
    "nearest", the paper's: of the most positive and the most negative correlation the one at the smaller
    |lag|, of two as near the larger. With surrogates, only those count that reach the threshold, if any does:
    else what chance puts near lag 0 would hide what does not lie there.

    References
    ----------
    u-Unwrap, section 4.3, Fig. 5G; Westfall & Young (1993), maximum over lags; Benjamini & Hochberg (1995),
    doi:10.1111/j.2517-6161.1995.tb02031.x.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = [[True] * 4]
    >>> signal, velocity = cd.simulate.coupled_series("white", 0, 80, 1, 4, lag_frames=3, windows=windows)
    >>> correlations = cd.cross_correlate(signal, velocity, max_lag=5, surrogates=99)
    >>> peaks = cd.peak_correlation(correlations)
    >>> peaks["lag"].to_numpy(), peaks["q"].to_numpy()
    (array([[-3., -3., -3., -3.]]), array([[0.01, 0.01, 0.01, 0.01]]))
    """
    rule = PeakParameters.of(**settings).rule
    if not isinstance(correlations, xr.Dataset) or "lag" not in correlations.coords:
        raise ParameterError("correlations must be the Dataset that cross_correlate returns")
    curves = correlations["correlation"].transpose("lag", ...)
    lags = correlations["lag"].to_numpy()
    threshold = correlations["threshold"].to_numpy() if "threshold" in correlations else None
    place, found = find_peak(curves.to_numpy(), lags, rule, threshold)
    dims, nothing = curves.dims[1:], np.isnan(found)
    data: dict[str, Any] = {"correlation": (dims, found)}
    data["lag"] = (dims, np.where(nothing, np.nan, lags[place]), {"units": "frame"})
    if "lag_s" in correlations.coords:
        seconds = correlations["lag_s"].to_numpy()[place]
        data["lag_s"] = (dims, np.where(nothing, np.nan, seconds), {"units": "s"})
    for name in _AT_PEAK:
        if name in correlations:
            values = correlations[name].transpose("lag", ...).to_numpy()
            at_peak = np.take_along_axis(values, place[None], axis=0)[0]
            data[name] = (dims, np.where(nothing, np.nan, at_peak))
    if "null" in correlations:
        null = correlations["null"].transpose("surrogate", ...).to_numpy()
        p = p_value(found, null)
        data |= {"p": (dims, p), "q": (dims, false_discovery(p))}
    coords = {name: value for name, value in curves.coords.items() if "lag" not in value.dims}
    return with_units(xr.Dataset(data, coords, attrs=correlations.attrs | {"rule": rule}))


def find_peak(
    curves: FloatArray, lags: IntArray, rule: Rule, threshold: FloatArray | None = None
) -> tuple[IntArray, FloatArray]:
    """Where the peak of curves lies by a rule, and its value.

    Parameters
    ----------
    curves : ndarray of shape (K, …) and dtype float
        By lag.
    lags : ndarray of shape (K,) and dtype int
    rule : {"nearest", "largest"}
    threshold : ndarray of shape (…) and dtype float, optional
        For "nearest": peaks that reach it go before those that do not.

    Returns
    -------
    place : ndarray of shape (…) and dtype int
        Index of the lag.
    value : ndarray of shape (…) and dtype float
        NaN where the curve is.
    """
    away = np.abs(lags).reshape(-1, *[1] * (curves.ndim - 1))
    if rule == "largest":
        place = _first_best(np.abs(curves), away)
        return place, _at(curves, place)
    if threshold is not None:
        reached = np.abs(curves) >= threshold
        curves = np.where(reached | ~reached.any(axis=0), curves, np.nan)
    high, low = _first_best(curves, away), _first_best(-curves, away)
    top, bottom = _at(curves, high), _at(curves, low)
    nearer = np.abs(lags[low]) < np.abs(lags[high])
    as_near = np.abs(lags[low]) == np.abs(lags[high])
    negative = nearer | (as_near & (-bottom > top))
    negative &= bottom < 0  # a curve above 0 has no negative peak, however near its minimum
    negative |= ~(top > 0)
    return np.where(negative, low, high), np.where(negative, bottom, top)


def _first_best(score: FloatArray, away: IntArray) -> IntArray:
    """Index of the largest score along axis 0; of equal ones that at the smallest |lag|."""
    known = np.where(np.isnan(score), -np.inf, score)
    best = known == known.max(axis=0)
    return np.asarray(np.where(best, away, np.iinfo(np.int64).max).argmin(axis=0))


def _at(curves: FloatArray, place: IntArray) -> FloatArray:
    return np.asarray(np.take_along_axis(curves, place[None], axis=0)[0])


def p_value(found: FloatArray, null: FloatArray) -> FloatArray:
    """Share of the null, what was found counted in, that is at least as large in magnitude.

    Parameters
    ----------
    found : ndarray of shape (…) and dtype float
    null : ndarray of shape (R, …) and dtype float
        Largest magnitudes of surrogates over lags; NaN is left out.

    Returns
    -------
    ndarray of shape (…) and dtype float
        NaN where nothing was found.
    """
    known = np.isfinite(null)
    larger = (null >= np.abs(found)) & known
    share = (1.0 + larger.sum(axis=0)) / (1.0 + known.sum(axis=0))
    return np.asarray(np.where(np.isnan(found), np.nan, share))


def false_discovery(p: FloatArray) -> FloatArray:
    """Benjamini-Hochberg adjusted p-values; NaN is left out.

    Parameters
    ----------
    p : ndarray of any shape and dtype float

    Returns
    -------
    ndarray of the same shape and dtype float
        q: the smallest share of false discoveries at which the window is still called significant.
    """
    known = np.isfinite(p)
    values = p[known]
    order = np.argsort(values)
    ranked = values[order] * (values.size / np.arange(1, values.size + 1))  # so that no q is below its p
    adjusted = np.minimum.accumulate(ranked[::-1])[::-1]
    q = np.full(p.shape, np.nan)
    within = np.empty_like(values)
    within[order] = np.minimum(adjusted, 1.0)
    q[known] = within
    return q
