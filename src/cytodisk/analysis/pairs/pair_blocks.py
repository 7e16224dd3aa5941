"""Correlations of all pairs of windows in blocks, and their distribution by distance."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from cytodisk.analysis.correlation.lagged import filled, variance_of
from cytodisk.analysis.correlation.prepared_series import standardised
from cytodisk.arrays import FloatArray, IntArray

_BLOCK = 256  # windows of `a` at a time
_STEPS = 400  # of a correlation from -1 to 1, for quartiles


def correlation_blocks(
    a: FloatArray, b: FloatArray, lag: int, min_pairs: int
) -> Iterator[tuple[slice, FloatArray]]:
    """Correlations of all series of `a` with all of `b` at one lag, some rows at a time.

    Parameters
    ----------
    a : ndarray of shape (T, W) and dtype float
    b : ndarray of shape (T, V) and dtype float
        NaN where there is no value; both standardised, so that sums do not cancel.
    lag : int
        `b` later by so many frames.
    min_pairs : int
        Fewer pairs give NaN.

    Yields
    ------
    rows : slice
        Of `a`.
    correlation : ndarray of shape (rows, V) and dtype float
        NaN also where one of both does not vary.
    """
    early, late = a[max(0, -lag) : len(a) - max(0, lag)], b[max(0, lag) : len(b) + min(0, lag)]
    present = np.isfinite(early), np.isfinite(late)
    whole = all((mask == mask[:, :1]).all() for mask in present)
    if whole:
        both = present[0][:, 0] & present[1][:, 0]
        early, late = unit_columns(early[both]), unit_columns(late[both])
        enough = both.sum() >= min_pairs
    for first in range(0, a.shape[1], _BLOCK):
        rows = slice(first, min(first + _BLOCK, a.shape[1]))
        if whole:
            yield (
                rows,
                early[:, rows].T @ late if enough else np.full((rows.stop - first, b.shape[1]), np.nan),
            )
        else:
            yield rows, _with_gaps(early[:, rows], late, min_pairs)


@dataclass(frozen=True, eq=False)
class DistanceBins:
    """Pairs of windows sorted by their distance.

    Attributes
    ----------
    number : ndarray of shape (W, V) and dtype int
        Bin of each pair: 0 for windows paired with themselves.
    edges : ndarray of shape (B,) and dtype float
        Edges of the bins above 0.
    """

    number: IntArray
    edges: FloatArray

    @classmethod
    def of(cls, distances: FloatArray, edges: FloatArray) -> DistanceBins:
        """Sort pairs into bins; those of distance 0 into the first."""
        number = np.clip(np.searchsorted(edges, distances, side="left"), 1, len(edges) - 1)
        return cls(np.where(distances == 0, 0, number).astype(np.int64), edges)

    @property
    def count(self) -> int:
        """How many bins there are, that at 0 counted."""
        return len(self.edges)


class Distribution:
    """Number, mean, spread and quartiles of correlations by bin, filled block by block."""

    def __init__(self, bins: DistanceBins):
        self._bins = bins
        self._counts = np.zeros((bins.count, _STEPS + 1))
        self._sum, self._square = np.zeros((2, bins.count))

    def add(self, rows: slice, correlation: FloatArray) -> None:
        """Count the correlations of some rows."""
        known = np.isfinite(correlation)
        number, values = self._bins.number[rows][known], correlation[known]
        step = np.rint((values + 1.0) * (0.5 * _STEPS)).astype(np.int64)
        place = number * (_STEPS + 1) + np.clip(step, 0, _STEPS)
        self._counts += np.bincount(place, minlength=self._counts.size).reshape(self._counts.shape)
        self._sum += np.bincount(number, values, self._bins.count)
        self._square += np.bincount(number, values**2, self._bins.count)

    def summary(self) -> dict[str, FloatArray]:
        """correlation, sd, lower_quartile, upper_quartile and n by bin; NaN for a bin without pairs."""
        n = self._counts.sum(axis=1)
        some = np.where(n > 0, n, np.nan)
        mean = self._sum / some
        spread = np.sqrt(np.maximum(self._square / some - mean**2, 0.0))
        share = np.cumsum(self._counts, axis=1) / some[:, None]
        low, high = ((share >= part).argmax(axis=1) * (2.0 / _STEPS) - 1.0 for part in (0.25, 0.75))
        empty = n == 0
        return {
            "correlation": mean,
            "sd": spread,
            "lower_quartile": np.where(empty, np.nan, low),
            "upper_quartile": np.where(empty, np.nan, high),
            "n": n,
        }


def distributions(
    a: FloatArray,
    b: FloatArray,
    lags: IntArray,
    min_pairs: int,
    bins: list[DistanceBins],
    step: Callable[[], None],
) -> dict[str, FloatArray]:
    """Distribution of the correlations of all pairs by distance and lag.

    Parameters
    ----------
    a, b : ndarray of shape (T, W) and dtype float
    lags : ndarray of shape (K,) and dtype int
    min_pairs : int
    bins : list of DistanceBins
        One a kind of distance.
    step : callable
        Called after each lag.

    Returns
    -------
    dict of str to ndarray of shape (kinds, bins, K)
        As `Distribution.summary`.
    """
    a, b = standardised(a), standardised(b)
    columns: list[list[dict[str, FloatArray]]] = []
    for lag in lags.tolist():
        found = [Distribution(kind) for kind in bins]
        for rows, correlation in correlation_blocks(a, b, lag, min_pairs):
            for distribution in found:
                distribution.add(rows, correlation)
        columns.append([distribution.summary() for distribution in found])
        step()
    names = columns[0][0]
    return {
        name: np.array([[kind[name] for kind in lag] for lag in columns]).transpose(1, 2, 0) for name in names
    }


def mean_by_bin(
    a: FloatArray,
    b: FloatArray,
    lags: IntArray,
    min_pairs: int,
    bins: list[DistanceBins],
    step: Callable[[], None],
) -> FloatArray:
    """Mean correlation by distance and lag alone, shape (kinds, bins, K): what surrogates need."""
    a, b = standardised(a), standardised(b)
    found = np.zeros((len(bins), bins[0].count, lags.size))
    for place, lag in enumerate(lags.tolist()):
        total, count = np.zeros((2, len(bins), bins[0].count))
        for rows, correlation in correlation_blocks(a, b, lag, min_pairs):
            known = np.isfinite(correlation)
            values = np.where(known, correlation, 0.0).ravel()
            for k, kind in enumerate(bins):
                number = kind.number[rows].ravel()
                total[k] += np.bincount(number, values, kind.count)
                count[k] += np.bincount(number, known.ravel(), kind.count)
        found[:, :, place] = total / np.where(count > 0, count, np.nan)
        step()
    return found


def unit_columns(series: FloatArray) -> FloatArray:
    """Columns with mean 0 and length 1, so that their products are correlations; NaN for a constant."""
    if not len(series):
        return series
    mean = series.mean(axis=0)
    variance = variance_of((series**2).mean(axis=0), mean)
    return np.asarray((series - mean) / np.sqrt(variance * len(series)))


def _with_gaps(early: FloatArray, late: FloatArray, min_pairs: int) -> FloatArray:
    """Correlations of columns whose gaps differ: every sum is over the pairs that are there."""
    a, in_a = filled(early)
    b, in_b = filled(late)
    count = in_a.T @ in_b
    both = np.maximum(count, 1.0)
    mean_a, mean_b = (a.T @ in_b) / both, (in_a.T @ b) / both
    found = (a.T @ b) / both - mean_a * mean_b
    found /= np.sqrt(variance_of((a.T**2 @ in_b) / both, mean_a))
    found /= np.sqrt(variance_of((in_a.T @ b**2) / both, mean_b))
    return np.where(count >= min_pairs, np.clip(found, -1.0, 1.0), np.nan)
