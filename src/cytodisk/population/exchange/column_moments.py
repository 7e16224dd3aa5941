"""Means and squares of the columns of a tall table, some rows at a time: nothing of its size is copied."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.population.ratios import ratio

ROWS = 4096  # taken at a time


@dataclass(frozen=True, eq=False)
class ColumnMoments:
    """Of each column: arrays of shape (columns,) and dtype float64.

    Attributes
    ----------
    count : ndarray
        Values that there are.
    mean : ndarray
        NaN where there is none.
    squares : ndarray
        Sum of squares about the mean.
    raw_squares : ndarray
        Sum of squares about 0.
    """

    count: FloatArray
    mean: FloatArray
    squares: FloatArray
    raw_squares: FloatArray

    @property
    def variance(self) -> FloatArray:
        """NaN where there are fewer than two values."""
        return ratio(self.squares, self.count - 1, self.count > 1)


def column_moments(values: FloatArray, chosen: BoolArray | None = None) -> ColumnMoments:
    """Moments of the columns.

    Parameters
    ----------
    values : ndarray of shape (rows, columns) and dtype float64
        NaN where there is no value.
    chosen : ndarray of shape (rows,) and dtype bool, optional
        Rows that count; by default all.

    Returns
    -------
    ColumnMoments
    """
    rows = np.arange(len(values)) if chosen is None else np.flatnonzero(chosen)
    count, total, raw = np.zeros((3, values.shape[1]))
    for block in _blocks(values, rows):
        finite = np.isfinite(block)
        known = np.where(finite, block, 0.0)
        count += finite.sum(axis=0)
        total += known.sum(axis=0)
        raw += (known**2).sum(axis=0)
    mean = ratio(total, count, count > 0)
    squares = np.zeros(values.shape[1])
    for block in _blocks(values, rows):
        away = block - mean
        squares += (np.where(np.isfinite(away), away, 0.0) ** 2).sum(axis=0)
    return ColumnMoments(count, mean, squares, raw)


def _blocks(values: FloatArray, rows: IntArray) -> Iterator[FloatArray]:
    for start in range(0, len(rows), ROWS):
        yield values[rows[start : start + ROWS]]
