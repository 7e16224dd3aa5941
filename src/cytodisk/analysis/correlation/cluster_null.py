"""What chance gives for clusters of windows: correlations of all windows with the same surrogates."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.analysis.correlation.cluster_fields import Scores, WindowRing
from cytodisk.arrays import FloatArray

MOST_SURROGATES = 499
"""Surrogates of clusters, which are all held at once: their p-values go down to 0.002."""

_MOST_BYTES = 2**28
_AT_ONCE = 16  # surrogates, of which fields are held in double precision


class ClusterNull:
    """Correlations of surrogates that all windows share, filled series by series of `b`.

    Parameters
    ----------
    lags : int
    windows : dict of str to int
        Sizes of the dims of a window, in the order of the tables.
    surrogates : int
        How many there are; 499 at most are held, fewer where they would take more than 256 MB.
    ring : WindowRing
    """

    def __init__(self, lags: int, windows: dict[str, int], surrogates: int, ring: WindowRing):
        size = 4 * lags * int(np.prod(list(windows.values())))
        count = max(1, min(surrogates, MOST_SURROGATES, _MOST_BYTES // max(size, 1)))
        self._windows, self._ring = windows, ring
        self._chance = np.zeros((count, lags, *windows.values()), dtype=np.float32)

    def put(self, place: tuple[Any, ...], chance: FloatArray) -> None:
        """Keep the correlations (K, …, R) of one series of `b`."""
        kept = chance[..., : len(self._chance)]
        at: tuple[Any, ...] = (slice(None), slice(None), *place)
        self._chance[at] = np.moveaxis(kept, -1, 0)

    def masses(self, n_effective: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Largest mass of each surrogate, and the spread of the averaged scores of each window.

        Parameters
        ----------
        n_effective : ndarray of shape (K, *windows) and dtype float

        Returns
        -------
        largest : ndarray of shape (surrogates, *rest) and dtype float
            Rest are the dims that are neither layer nor sector.
        spread : ndarray of shape (*windows) and dtype float
        """
        spread = np.ones(tuple(self._windows.values()))
        fields, worth = self._layers_and_sectors(self._chance, 2), self._layers_and_sectors(n_effective, 1)
        scales = self._layers_and_sectors(spread, 0)
        largest = np.zeros((len(fields), *fields.shape[2:-2]))
        for rest in np.ndindex(fields.shape[2:-2]):
            of_rest = fields[(slice(None), slice(None), *rest)]
            scales[rest] = self._to_scores(of_rest, worth[(slice(None), *rest)])
            largest[(slice(None), *rest)] = self._largest(of_rest, scales[rest])
        return largest, spread

    def _to_scores(self, fields: Scores, worth: Scores) -> FloatArray:
        """Make correlations averaged scores, in place; their spread."""
        squares = np.zeros(fields.shape[1:])
        for start in range(0, len(fields), _AT_ONCE):
            some = slice(start, start + _AT_ONCE)
            scores = self._ring.averaged_scores(fields[some].astype(np.float64), worth)
            squares += (scores**2).sum(axis=0)
            fields[some] = scores
        known = np.maximum((squares > 0).sum(axis=0), 1)  # lags that were left out have no score
        spread = np.sqrt(squares.sum(axis=0) / known / len(fields))
        return np.where(spread > 0, spread, 1.0)

    def _largest(self, fields: Scores, spread: Scores) -> FloatArray:
        starts = range(0, len(fields), _AT_ONCE)
        parts = [self._ring.largest(fields[start : start + _AT_ONCE] / spread) for start in starts]
        return np.concatenate(parts)

    def _layers_and_sectors(self, table: Scores, before: int) -> Scores:
        """A view with the layer, of which there may be one alone, and the sector last."""
        names = list(self._windows)
        if "layer" not in names:
            return np.moveaxis(table, before + names.index("sector"), -1)[..., None, :]
        axes = [before + names.index(name) for name in ("layer", "sector")]
        return np.moveaxis(table, axes, [-2, -1])
