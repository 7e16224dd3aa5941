"""Rows and columns of an autoregression that is pooled over sectors, each sector's mean removed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.analysis.prediction.layer_series import LayerSeries
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import ParameterError

_ROUNDING = 64.0 * np.finfo(np.float64).eps
"""Share of the largest magnitude below which a spread is nothing but rounding."""

DEPENDENT = 1e-10
"""Share of a column that others leave, below which it is nothing but rounding."""


@dataclass(frozen=True, eq=False)
class Rows:
    """Frames and sectors that a model is fitted to.

    Attributes
    ----------
    frame, sector : ndarray of shape (N,) and dtype int
        Sector by sector within a frame.
    count : ndarray of shape (S,) and dtype int
        Rows of each sector.
    """

    frame: IntArray
    sector: IntArray
    count: IntArray

    @classmethod
    def of(cls, used: BoolArray) -> Rows:
        """Rows of a table (T, S) of what is used."""
        frame, sector = np.nonzero(used)
        return cls(frame, sector, used.sum(axis=0))

    @property
    def size(self) -> int:
        """How many there are."""
        return len(self.frame)

    @property
    def sectors(self) -> int:
        """Sectors with a row."""
        return int((self.count > 0).sum())

    def centred(self, values: FloatArray) -> FloatArray:
        """Values (N,) minus the mean of their sector over these rows."""
        total = np.bincount(self.sector, values, len(self.count))
        return np.asarray(values - (total / np.maximum(self.count, 1))[self.sector])

    def lagged(self, series: FloatArray, lags: range) -> list[FloatArray]:
        """Centred columns (N,) of series (T, S), one for each lag."""
        return [self.centred(series[self.frame - lag, self.sector]) for lag in lags]

    def table(self, values: FloatArray, frames: int) -> FloatArray:
        """Values (N, …) as a table (T, S, …) that is 0 elsewhere."""
        table = np.zeros((frames, len(self.count), *values.shape[1:]))
        table[self.frame, self.sector] = values
        return table


def rows_with_past(series: LayerSeries, past: int) -> Rows:
    """Frames whose values and past are all known, of the sectors in which source and target vary.

    Parameters
    ----------
    series : LayerSeries
    past : int
        Frames before that must be known, of every signal.

    Raises
    ------
    ParameterError
        No row is left; the message says why.
    """
    frames = len(series.target)
    if frames <= past:
        raise ParameterError(
            f"there are {frames} frames, of which {past} are past alone: pass a longer movie, or a smaller "
            "max_order"
        )
    known = np.isfinite(series.target[past:])
    all_past = (series.target, series.source, *series.beside, *series.given)
    for one in all_past:
        finite = np.isfinite(one)
        for lag in range(1, past + 1):
            known &= finite[past - lag : frames - lag]
    if not known.any():
        raise ParameterError(_why_none(series, past))
    rows = Rows.of(np.concatenate([np.zeros((past, known.shape[1]), dtype=bool), known]))
    varies = _varies(rows, series.target, 0) & _varies(rows, series.source, 1)
    if not varies.any():
        for name, one, lag in (("target", series.target, 0), ("source", series.source, 1)):
            if not _varies(rows, one, lag).any():
                raise ParameterError(f"{name} is constant in every sector: pass a signal that changes")
        raise ParameterError(
            "in every sector target or source is constant: pass sectors in which both change"
        )
    return Rows.of(rows.table(np.ones(rows.size), frames).astype(bool) & varies)


def orthonormal(columns: list[FloatArray]) -> FloatArray:
    """Orthonormal columns (N, K) that span given ones.

    Raises
    ------
    ParameterError
        One of them is a linear function of those before it.
    """
    table = np.column_stack(columns)
    basis, triangle = np.linalg.qr(table)
    left = np.abs(np.diag(triangle))
    if (left <= DEPENDENT * np.linalg.norm(table, axis=0)).any():
        raise ParameterError(
            "the past of target, neighbours and given signals is linearly dependent: leave out a given "
            "signal that is constant or like another, or pass neighbours=False where sectors are all alike"
        )
    return np.asarray(basis)


def _varies(rows: Rows, series: FloatArray, lag: int) -> BoolArray:
    """Which sectors change over the rows, by more than rounding."""
    values = series[rows.frame - lag, rows.sector]
    high, low = (np.full(len(rows.count), sign * np.inf) for sign in (-1.0, 1.0))
    np.maximum.at(high, rows.sector, values)
    np.minimum.at(low, rows.sector, values)
    known = rows.count > 1
    extent = np.where(known, high, 0.0) - np.where(known, low, 0.0)
    largest = np.maximum(np.abs(np.where(known, high, 0.0)), np.abs(np.where(known, low, 0.0)))
    return np.asarray(extent > _ROUNDING * largest)


def _why_none(series: LayerSeries, past: int) -> str:
    for name, one in (("target", series.target), ("source", series.source)):
        if not np.isfinite(one).any():
            return f"{name} is NaN in every frame and sector"
    sides = [np.isfinite(one).any(axis=0) for one in series.beside]
    if sides and not np.logical_and.reduce(sides).any():
        return "no sector has both its neighbours among those passed: pass neighbours=False"
    return (
        f"no sector has {past + 1} frames on end with all signals: pass a smaller max_order, or fill in "
        "short gaps"
    )
