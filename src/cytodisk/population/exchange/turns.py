"""Cells turned at random: what patterns around the cell chance would give."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.population.ratios import known_mean, ratio

_VALUES = 4_000_000  # turned at a time


@dataclass(frozen=True, eq=False)
class TurnExchanges:
    """Sectors by which cells are turned: (ways, cells), 0 first.

    Attributes
    ----------
    cells, sectors : int
    permutations : int
        Ways beside the observed one.
    seed : int
    """

    cells: int
    sectors: int
    permutations: int
    seed: int

    @property
    def all_ways(self) -> bool:
        """Whether all ways there are were taken."""
        return False

    @property
    def count(self) -> int:
        """Number of ways, with the observed one."""
        return self.permutations + 1

    @property
    def smallest_p(self) -> float:
        """All turned alike, each window has another place and the largest score is the same."""
        return max(1.0 / self.count, float(self.sectors) ** (1 - self.cells))

    def chunks(self, size: int) -> Iterator[IntArray]:
        """Turns of some ways at a time."""
        rng = np.random.default_rng(self.seed)
        left, first = self.permutations, np.zeros((1, self.cells), dtype=np.int64)
        while left:
            rows = min(size, left)
            yield np.concatenate([first, rng.integers(0, self.sectors, (rows, self.cells))])
            left, first = left - rows, first[:0]


class TurnedPattern:
    """Mean of cells in each window, over what turned cells give on average in its layer.

    Parameters
    ----------
    values : ndarray of shape (cells, rows, sectors) and dtype float64
        Rows are layers of channels. NaN counts as the mean of the cell's row.
    weights : ndarray of shape (cells,) and dtype float64
        Of the cells in the mean; their sum is 1.
    """

    def __init__(self, values: FloatArray, weights: FloatArray) -> None:
        finite, level = np.isfinite(values), known_mean(values, -1)[..., None]
        self._values = np.where(finite, values - level, 0.0)
        self._weights = weights
        own = (self._values**2).mean(axis=-1)
        self._error = np.sqrt((weights[:, None] ** 2 * own).sum(axis=0))[:, None]
        self.testable: BoolArray = np.broadcast_to(self._error > 0, self._values.shape[1:]).ravel()
        self.scored = self.testable

    @property
    def degrees(self) -> float:
        """Degrees of freedom."""
        return float(max(len(self._weights) - 1, 1))

    def means(self) -> FloatArray:
        """Mean of the cells in each window, as a difference from its layer's: (windows,)."""
        return np.asarray(np.tensordot(self._weights, self._values, axes=1)).ravel()

    def scores(self, labels: NDArray[np.generic]) -> FloatArray:
        """Scores (ways, windows) for turns (ways, cells)."""
        cells, rows, sectors = self._values.shape
        found = np.empty((len(labels), rows, sectors))
        step = max(1, _VALUES // (rows * sectors))
        error = np.broadcast_to(self._error, (rows, sectors))
        for way, turns in enumerate(labels.astype(np.int64)):
            mean = np.zeros((rows, sectors))
            for start in range(0, cells, step):
                some = slice(start, start + step)
                at = (np.arange(sectors) + turns[some, None]) % sectors
                block = np.take_along_axis(self._values[some], at[:, None], axis=-1)
                mean += np.tensordot(self._weights[some], block, axes=1)
            found[way] = ratio(mean, error, error > 0, 0.0)
        return found.reshape(len(labels), -1)
