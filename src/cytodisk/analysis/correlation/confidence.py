"""How much a correlation of autocorrelated series can be trusted: effective sample size and confidence."""

from __future__ import annotations

import numpy as np
from scipy.special import ndtri

from cytodisk.analysis.correlation.lagged import filled
from cytodisk.analysis.correlation.prepared_series import standardised
from cytodisk.arrays import FloatArray, IntArray

_SHARE_OF_FRAMES = 0.2  # lags of the autocorrelations that are summed, as Pyper & Peterman advise


def effective_share(a: FloatArray, b: FloatArray) -> FloatArray:
    """Effective over actual number of pairs of two autocorrelated series.

    Parameters
    ----------
    a, b : ndarray of shape (T, …) and dtype float
        Shapes broadcast; NaN is left out.

    Returns
    -------
    ndarray of shape (…) and dtype float
        From above 0 to 1; 1 in fewer than 5 frames, whose autocorrelation is not known.

    Notes
    -----
    1 / (1 + 2 Σ_k (1 - k / T) ρ_a(k) ρ_b(k)) over the lags k up to T / 5.

    References
    ----------
    Bartlett (1946), doi:10.2307/2983611; Pyper & Peterman (1998), doi:10.1139/f98-104.
    """
    frames = len(a)
    lags: IntArray = np.arange(1, int(_SHARE_OF_FRAMES * frames) + 1, dtype=np.int64)
    product = np.zeros(np.broadcast_shapes(a.shape[1:], b.shape[1:]))
    for lag, rho_a, rho_b in zip(lags, autocorrelation(a, lags), autocorrelation(b, lags), strict=True):
        product = product + (1.0 - lag / frames) * rho_a * rho_b
    return np.asarray(1.0 / np.maximum(1.0 + 2.0 * product, 1.0))


def autocorrelation(series: FloatArray, lags: IntArray) -> FloatArray:
    """Autocorrelation of series with gaps.

    Parameters
    ----------
    series : ndarray of shape (T, …) and dtype float
    lags : ndarray of shape (K,) and dtype int
        From 0 to T - 1.

    Returns
    -------
    ndarray of shape (K, …) and dtype float
        NaN for a constant; 0 where no pair of frames is that far apart.
    """
    values, present = filled(standardised(series.reshape(len(series), -1)))
    found = np.zeros((len(lags), values.shape[1]))
    for place, lag in enumerate(lags):
        count = (present[lag:] * present[: len(present) - lag]).sum(axis=0)
        total = (values[lag:] * values[: len(values) - lag]).sum(axis=0)
        found[place] = total / np.maximum(count, 1.0)
    found[:, ~values.any(axis=0)] = np.nan
    return found.reshape(len(lags), *series.shape[1:])


def fisher_interval(
    correlation: FloatArray, n_effective: FloatArray, confidence: float
) -> tuple[FloatArray, FloatArray]:
    """Confidence interval of correlations by Fisher's transformation.

    Parameters
    ----------
    correlation, n_effective : ndarray of the same shape and dtype float
    confidence : float
        Such as 0.95.

    Returns
    -------
    low, high : ndarray
        -1 and 1 with three effective pairs or fewer, which say nothing.

    References
    ----------
    Fisher (1921), with the effective number of pairs in place of their number.
    """
    reach = ndtri(0.5 + 0.5 * confidence) / np.sqrt(np.maximum(n_effective - 3.0, 0.0) + 1e-300)
    inside = np.clip(correlation, -1.0 + 1e-15, 1.0 - 1e-15)
    centre = np.arctanh(inside)
    return np.tanh(centre - reach), np.tanh(centre + reach)
