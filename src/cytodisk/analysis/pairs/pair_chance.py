"""What chance gives for the mean correlation of pairs of windows: the same mean of many surrogates."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from cytodisk.analysis.correlation.prepared_series import standardised
from cytodisk.analysis.correlation.surrogates import Surrogates
from cytodisk.analysis.pairs.pair_blocks import DistanceBins, mean_by_bin, unit_columns
from cytodisk.arrays import FloatArray, IntArray

_AT_ONCE = 32  # surrogates in memory
_FEWEST = 0.5  # pairs in a bin over the number of windows, for the threshold: fewer are noise


@dataclass(frozen=True, eq=False)
class PairChance:
    """Mean correlations of surrogates.

    Attributes
    ----------
    low, high : ndarray of shape (kinds, bins, K) and dtype float
        Between which 95 % of the surrogates lie.
    threshold : ndarray of shape (kinds,) and dtype float
        Magnitude that 5 % of them exceed at some lag, in some bin with at least half as many pairs as there
        are windows.
    """

    low: FloatArray
    high: FloatArray
    threshold: FloatArray


def chance_of_pairs(
    a: FloatArray,
    b: FloatArray,
    surrogates: Surrogates,
    lags: IntArray,
    min_pairs: int,
    bins: list[DistanceBins],
    alpha: float,
    step: Callable[[], None],
) -> PairChance:
    """Mean correlations by distance and lag of `a` with surrogates of `b`.

    Parameters
    ----------
    a, b : ndarray of shape (T, W) and dtype float
    surrogates : Surrogates
        Of `b`; all its series are changed together.
    lags : ndarray of shape (K,) and dtype int
    min_pairs : int
    bins : list of DistanceBins
        One a kind of distance.
    alpha : float
    step : callable
        Called once a surrogate and lag.

    Returns
    -------
    PairChance

    Notes
    -----
    The mean of correlations over pairs is linear in the surrogate: sums of `a` over what is in each bin from
    a window are made once a lag, and multiplied with all surrogates. Where windows have gaps of their own,
    each surrogate's correlations are computed one by one instead.
    """
    count = surrogates.count
    means = np.empty((count, len(bins), bins[0].count, lags.size))
    a = standardised(a)
    for first in range(0, count, _AT_ONCE):
        some = slice(first, min(first + _AT_ONCE, count))
        series = np.stack([surrogates.together(column, some) for column in b.T], axis=1)  # (T, V, R)
        if same_gaps(a) and same_gaps(series.reshape(len(series), -1)):
            means[some] = _means(a, series, lags, min_pairs, bins, step)
        else:
            for k, one in enumerate(np.moveaxis(series, -1, 0), first):
                means[k] = mean_by_bin(a, one, lags, min_pairs, bins, step)
    held = np.array([[(kind.number == n).sum() for n in range(kind.count)] for kind in bins])
    counted = held >= _FEWEST * a.shape[1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # bins without pairs have no mean
        low, high = np.nanquantile(means, [0.5 * alpha, 1.0 - 0.5 * alpha], axis=0)
        largest = np.nanmax(np.where(counted[..., None], np.abs(means), np.nan), axis=(2, 3))
        threshold = np.nanquantile(largest, 1.0 - alpha, axis=0, method="higher")
    return PairChance(low, high, threshold)


def _means(
    a: FloatArray,
    series: FloatArray,
    lags: IntArray,
    min_pairs: int,
    bins: list[DistanceBins],
    step: Callable[[], None],
) -> FloatArray:
    """Means of all surrogates, shape (R, kinds, bins, K), where no window has gaps of its own."""
    frames, windows, count = series.shape
    flat = series.reshape(frames, -1)
    sums = [_sum_over(kind) for kind in bins]
    means = np.full((count, len(bins), bins[0].count, lags.size), np.nan)
    for place, lag in enumerate(lags.tolist()):
        early, late = a[max(0, -lag) : frames - max(0, lag)], flat[max(0, lag) : frames + min(0, lag)]
        both = np.isfinite(early[:, 0]) & np.isfinite(late[:, 0])
        if both.sum() >= min_pairs:
            early, late = unit_columns(early[both]), unit_columns(late[both])
            a_known = np.isfinite(early[0]).astype(np.float64)
            b_known = np.isfinite(late[0]).reshape(windows, count).astype(np.float64)
            early, late = np.nan_to_num(early), np.nan_to_num(late)  # constants take no part
            late = late.reshape(-1, windows, count).swapaxes(0, 1).reshape(-1, count)
            for k, kind in enumerate(bins):
                total = (sums[k] @ early.T).reshape(kind.count, -1) @ late
                pairs = (sums[k] @ a_known).reshape(kind.count, windows) @ b_known
                means[:, k, :, place] = (total / np.where(pairs > 0, pairs, np.nan)).T
        for _ in range(count):
            step()
    return means


def _sum_over(kind: DistanceBins) -> csr_array:
    """Matrix that sums over the windows of `a` in each bin from each window of `b`: (bins × V) by W."""
    here, there = np.indices(kind.number.shape)
    row = kind.number * kind.number.shape[1] + there
    shape = (kind.count * kind.number.shape[1], kind.number.shape[0])
    return csr_array((np.ones(row.size), (row.ravel(), here.ravel())), shape=shape)


def same_gaps(series: FloatArray) -> bool:
    """Whether all series miss the same frames."""
    present = np.isfinite(series)
    return bool((present == present[:, :1]).all())
