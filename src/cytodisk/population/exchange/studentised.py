"""Studentised differences of many windows at once, for many ways to exchange labels.

The standard error of a window is averaged with that of all windows,

    t = difference / √((se² + se₀²) / 2),

where se₀² follows from the median over the windows of the variance without regard to labels: it is the same
for every exchange, so the test stays exact, and with few units a window whose values agree by chance no
longer stands out (the idea of Smyth 2004, doi:10.2202/1544-6115.1027, and of Tusher et al. 2001,
doi:10.1073/pnas.091062498).
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.population.exchange.column_moments import ROWS, column_moments
from cytodisk.population.ratios import ratio

_SURE = 1e6  # score of a difference between values that do not vary
_ROUNDING = 1e-13  # of the squares of values: what is left of a variance of 0


class Statistic(Protocol):
    """Scores of windows for exchanged labels."""

    @property
    def degrees(self) -> float:
        """Degrees of freedom of the scores."""

    @property
    def testable(self) -> BoolArray:
        """Windows that are tested together, chosen without regard to labels: (windows,)."""

    @property
    def scored(self) -> BoolArray:
        """Those of them that have a score with the labels as they were: (windows,)."""

    def scores(self, labels: NDArray[np.generic]) -> FloatArray:
        """Scores (ways, windows) for labels (ways, units); 0 where there is none."""


class GroupDifference:
    """Treated minus control over its standard error (Welch's), in each window.

    Windows are testable where three quarters of the units have a value, whatever their labels: a choice by
    the observed labels would not be made again for the exchanged ones, and the level would not be exact.

    Parameters
    ----------
    values : ndarray of shape (units, windows) and dtype float64
        NaN where a unit has no value.
    treated : ndarray of shape (units,) and dtype bool
    families : ndarray of shape (windows,) and dtype int64, optional
        Windows with one number share their standard error; without it each has its own.
    """

    def __init__(self, values: FloatArray, treated: BoolArray, families: IntArray | None = None) -> None:
        self.sizes = int((~treated).sum()), int(treated.sum())
        self._values = values
        moments = column_moments(values)
        self._mean, self._squares, self._count = moments.mean, moments.squares, moments.count
        self._complete = bool((self._count == len(values)).all())
        self._least = _ROUNDING * moments.raw_squares
        self.testable = self._count >= 0.75 * len(values)
        self.scored = self.testable.copy()
        if not self._complete:
            for group, size in zip((~treated, treated), self.sizes, strict=True):
                self.scored &= np.isfinite(values[group]).sum(axis=0) >= min(2, size)
        per_unit = 1.0 / max(self.sizes[0], 1) + 1.0 / max(self.sizes[1], 1)
        self._shared = None
        if families is not None:
            shared = shared_medians(moments.variance * per_unit, self.testable, families)
            self._shared = np.where(shared > self._least, shared, 0.0)

    @property
    def degrees(self) -> float:
        """Degrees of freedom, twice those of a window alone where its error is shared."""
        own = max(sum(self.sizes) - 2, 1)
        return float(own if self._shared is None else 2 * own)

    def scores(self, labels: NDArray[np.generic]) -> FloatArray:
        """Scores (ways, windows) for which units are treated (ways, units)."""
        total, squares, count = self._sums(labels)
        other, n_other = -total, self._count - count  # of values about the mean of all
        enough = (count >= min(2, self.sizes[1])) & (n_other >= min(2, self.sizes[0])) & self.testable
        with np.errstate(invalid="ignore", divide="ignore"):
            difference = total / count - other / n_other
            within = squares - total**2 / count
            within_other = (self._squares - squares) - other**2 / n_other
            if min(self.sizes) < 2:  # a group of one has no variance of its own
                pooled = (within + within_other) / np.maximum(count + n_other - 2, 1)
                error = pooled * (1 / count + 1 / n_other)
            else:
                error = within / (count * (count - 1)) + within_other / (n_other * (n_other - 1))
        error = np.where(error > self._least, error, 0.0)
        if self._shared is not None:
            error = 0.5 * (error + self._shared)
        if sum(self.sizes) < 3:
            error = np.ones_like(error)
        return sure_scores(np.where(enough, difference, 0.0), error, np.sqrt(self._least))

    def _sums(self, labels: NDArray[np.generic]) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Sum and sum of squares, about the mean of all, and number of the treated units' values."""
        shape = len(labels), self._values.shape[1]
        total, squares = np.zeros(shape), np.zeros(shape)
        count = np.full((1, 1), float(self.sizes[1])) if self._complete else np.zeros(shape)
        for start in range(0, len(self._values), ROWS):
            rows = slice(start, start + ROWS)
            chosen, values = labels[:, rows].astype(np.float64), self._values[rows] - self._mean
            if not self._complete:
                finite = np.isfinite(values)
                values = np.where(finite, values, 0.0)
                count += chosen @ finite.astype(np.float64)
            total += chosen @ values
            squares += chosen @ values**2
        return total, squares, count


class PairDifference:
    """Mean over pairs of their differences, over its standard error, in each window.

    Parameters
    ----------
    differences : ndarray of shape (pairs, windows) and dtype float64
        NaN where one of the pair has no value.
    families : ndarray of shape (windows,) and dtype int64, optional
        As for `GroupDifference`.
    """

    def __init__(self, differences: FloatArray, families: IntArray | None = None) -> None:
        finite = np.isfinite(differences)
        self._values = np.where(finite, differences, 0.0)
        self._count = finite.sum(axis=0).astype(np.float64)
        self._squares = (self._values**2).sum(axis=0)
        self.testable = np.asarray((self._count >= 0.75 * len(finite)) & (self._count >= min(2, len(finite))))
        self.scored = self.testable
        mean_square = ratio(self._squares, self._count**2, self._count > 0)
        self._shared = None if families is None else shared_medians(mean_square, self.testable, families)
        self._own = max(len(finite) - 1, 1)

    @property
    def degrees(self) -> float:
        """Degrees of freedom, twice those of a window alone where its error is shared."""
        return float(self._own if self._shared is None else 2 * self._own)

    def scores(self, labels: NDArray[np.generic]) -> FloatArray:
        """Scores (ways, windows) for signs of pairs (ways, pairs)."""
        n = np.maximum(self._count, 1.0)
        mean = (labels.astype(np.float64) @ self._values) / n
        within = np.where(n > 1, self._squares / n - mean**2, 0.0)
        within = np.where(within > _ROUNDING * self._squares, within, 0.0)
        error = within / np.maximum(n - 1, 1.0)
        if self._shared is not None:
            error = 0.5 * (error + self._shared)
        if len(labels[0]) < 2:
            error = np.ones_like(error)
        return sure_scores(np.where(self.testable, mean, 0.0), error, np.sqrt(_ROUNDING * self._squares))


def sure_scores(difference: FloatArray, error: FloatArray, rounding: FloatArray) -> FloatArray:
    """Differences over the roots of their squared errors; a difference without any error is sure.

    Parameters
    ----------
    difference, error : ndarray of shape (ways, windows) and dtype float64
    rounding : ndarray of shape (windows,) and dtype float64
        Differences up to this one are 0.

    Returns
    -------
    ndarray of shape (ways, windows) and dtype float64
    """
    sure = np.where(np.abs(difference) > rounding, np.sign(difference) * _SURE, 0.0)
    return np.where(error > 0, ratio(difference, np.sqrt(error), error > 0, 0.0), sure)


def shared_medians(errors: FloatArray, testable: BoolArray, families: IntArray) -> FloatArray:
    """Median of the squared errors of the windows of each family, for every window.

    Parameters
    ----------
    errors : ndarray of shape (windows,) and dtype float64
    testable : ndarray of shape (windows,) and dtype bool
    families : ndarray of shape (windows,) and dtype int64

    Returns
    -------
    ndarray of shape (windows,) and dtype float64
    """
    found = np.zeros(len(errors))
    for family in np.unique(families):
        of = families == family
        if (of & testable).any():
            found[of] = np.median(errors[of & testable])
    return found
