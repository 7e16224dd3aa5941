"""How deep the layers of cells lie, summed up while windows are read."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.population.ratios import ratio
from cytodisk.runs.population.opening.streamed_windows import WindowBlock


class LayerDepths:
    """Mean depth of the windows of each layer, weighted by area.

    Parameters
    ----------
    rows, layers : int
        Cells, or frames of cells.
    """

    def __init__(self, rows: int, layers: int) -> None:
        self._shape = rows, layers
        self._sum, self._weight = np.zeros(rows * layers), np.zeros(rows * layers)

    def add(self, block: WindowBlock) -> None:
        """Take windows into account, those of one channel."""
        depth, area = block.numbers["depth"], block.numbers["area"]
        known = np.isfinite(depth) & (area > 0)
        place = (block.row * self._shape[1] + block.layer)[known]
        if len(place):
            there = slice(int(place.min()), int(place.max()) + 1)
            beside, number = place - there.start, there.stop - there.start
            self._sum[there] += np.bincount(beside, (depth * area)[known], number)
            self._weight[there] += np.bincount(beside, area[known], number)

    @property
    def means(self) -> FloatArray:
        """By row and layer; NaN where it is unknown."""
        return np.asarray(ratio(self._sum, self._weight, self._weight > 0).reshape(self._shape))


def median_of_cells(depths: FloatArray) -> FloatArray:
    """Median over rows (rows, layers) → (layers,), NaN for a layer that none has."""
    columns = [column[np.isfinite(column)] for column in depths.T]
    return np.array([np.median(known) if len(known) else np.nan for known in columns])
