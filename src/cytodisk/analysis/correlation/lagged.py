"""Pearson correlation at many lags between series with gaps: sums over pairs, as matrix products."""

from __future__ import annotations

import numpy as np

from cytodisk.analysis.correlation.prepared_series import standardised
from cytodisk.arrays import BoolArray, FloatArray, IntArray

_CONSTANT = 1e-12  # share of the mean square that a variance must reach, else it is rounding


class LaggedSeries:
    """Series at every lag under each other, ready to be correlated with any others.

    Parameters
    ----------
    series : ndarray of shape (T, H) and dtype float
        NaN where there is no value.
    lags : ndarray of shape (K,) and dtype int
        In frames.
    """

    def __init__(self, series: FloatArray, lags: IntArray):
        self.shape = len(lags), series.shape[1]
        values, present = filled(standardised(series))
        if (present == present[:, :1]).all():
            present = present[:, :1]  # all have the same gaps: their pairs are counted once
        self._values = _shifted(values, lags)
        self._present = _shifted(present, lags)
        self._squares = self._values**2

    def correlate(self, others: FloatArray, min_pairs: int) -> tuple[FloatArray, FloatArray]:
        """Pearson correlation of each series, moved by each lag, with each of others.

        Parameters
        ----------
        others : ndarray of shape (T, R) and dtype float
            NaN where there is no value.
        min_pairs : int
            Fewer pairs give NaN.

        Returns
        -------
        correlation : ndarray of shape (K, H, R) and dtype float
            Of series[t] with others[t + lag]. NaN also where one of both does not vary over the pairs.
        pairs : ndarray of shape (K, H or 1, R or 1) and dtype float
            How many frames both have a value in; one for all where all have the same gaps.
        """
        values, present = filled(standardised(others))
        if (present == present[:, :1]).all():
            present = present[:, :1]
        count = self._product(self._present, present)
        both = np.maximum(count, 1.0)
        mean_a = self._product(self._values, present) / both
        mean_b = self._product(self._present, values) / both
        square_a = self._product(self._squares, present) / both
        square_b = self._product(self._present, values**2) / both
        variance_a = variance_of(square_a, mean_a)
        variance_b = variance_of(square_b, mean_b)
        found = self._product(self._values, values)
        enough = np.broadcast_to(count >= min_pairs, found.shape)
        parts = mean_a, mean_b, np.sqrt(variance_a), np.sqrt(variance_b), both
        for of_lag, known, *by_lag in zip(
            found, enough, *parts, strict=True
        ):  # of a lag all stays in the cache
            _pearson(of_lag, known, *by_lag)
        return found, count

    def _product(self, lagged: FloatArray, others: FloatArray) -> FloatArray:
        """Sums over time of a (T, K, H) with a (T, R), shape (K, H, R)."""
        frames, lags, series = lagged.shape
        return np.asarray(lagged.reshape(frames, -1).T @ others).reshape(lags, series, -1)


def _pearson(
    products: FloatArray,
    known: BoolArray,
    mean_a: FloatArray,
    mean_b: FloatArray,
    spread_a: FloatArray,
    spread_b: FloatArray,
    pairs: FloatArray,
) -> None:
    """Make sums of products (H, R) correlations, NaN where they are not known."""
    with np.errstate(invalid="ignore", divide="ignore"):
        products /= pairs
        products -= mean_a * mean_b
        products /= spread_a
        products /= spread_b
    np.clip(products, -1.0, 1.0, out=products)
    if not known.all():
        products[~known] = np.nan


def filled(series: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Series with 0 for NaN, and 1 where there was a value, 0 where not."""
    present = np.isfinite(series)
    return np.where(present, series, 0.0), present.astype(np.float64)


def _shifted(series: FloatArray, lags: IntArray) -> FloatArray:
    """Series at [time - lag] by time, lag and series, 0 outside."""
    frames = len(series)
    out = np.zeros((frames, len(lags), series.shape[1]))
    for place, lag in enumerate(lags):
        out[max(0, lag) : frames + min(0, lag), place] = series[max(0, -lag) : frames - max(0, lag)]
    return out


def variance_of(square: FloatArray, mean: FloatArray) -> FloatArray:
    """Mean square minus squared mean; NaN where that is nothing but rounding."""
    variance = square - mean**2
    return np.where(variance > _CONSTANT * square, variance, np.nan)
