"""Neighbouring windows around the edge: their correlations averaged, and clusters of those that agree."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import convolve1d, label
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cytodisk.arrays import BoolArray, FloatArray, IntArray

CLUSTER_THRESHOLD = 2.25
"""Standard scores above which windows join a cluster; benchmarks/correlation.py prints what that finds."""

SIGNS = (1, -1)
_REACH = 15.0  # a window is averaged with those within a fifteenth of the edge to both sides
_BESIDE = np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], dtype=bool)  # windows that share a side
_LEAST_WORTH = 1.0  # effective pairs less three, below which the score of a correlation grows no more

Scores = NDArray[np.floating[Any]]


@dataclass(frozen=True, eq=False)
class WindowRing:
    """Sectors on the whole edge, where the last is the first one's neighbour; fields end in (layer, sector).

    Attributes
    ----------
    columns : ndarray of shape (S,) and dtype int
        Number of each sector on the edge.
    count : int
        Sectors of the whole edge; those that are not given hold no window.
    """

    columns: IntArray
    count: int

    @classmethod
    def of(cls, sectors: NDArray[Any], edge_sectors: int | None) -> WindowRing:
        """Ring of sectors by their numbers; without that of the whole edge, 0 to S - 1 are the whole."""
        numbers = sectors
        if not np.issubdtype(numbers.dtype, np.integer) or len(np.unique(numbers)) < len(numbers):
            numbers = np.arange(len(numbers))
        whole = np.array_equal(np.sort(numbers), np.arange(len(numbers)))
        least = int(numbers.max()) + (1 if whole else 2)  # a part of the edge does not close
        return cls(numbers.astype(np.int64), least if edge_sectors is None else edge_sectors)

    def averaged(self, field: Scores) -> Scores:
        """Means of each window with its neighbours along the edge, with weights that fall to 0."""
        reach = round(self.count / _REACH)
        weights = reach + 1.0 - np.abs(np.arange(-reach, reach + 1))
        around = convolve1d(self._around(field), weights / weights.sum(), axis=-1, mode="wrap")
        return np.asarray(around[..., self.columns])

    def averaged_scores(self, correlation: Scores, n_effective: Scores) -> Scores:
        """Averaged scores of correlations (…, K, L, S); 0 where a window has none itself."""
        averaged = self.averaged(standard_scores(correlation, n_effective))
        return np.where(np.isfinite(correlation), averaged, 0.0)

    def labelled(self, chosen: BoolArray) -> tuple[IntArray, int]:
        """Number of the cluster of each window of fields (N, L, S), 0 for none, and the largest number."""
        around = self._around(chosen)
        labels, found = label(around, np.stack([np.zeros_like(_BESIDE), _BESIDE, np.zeros_like(_BESIDE)]))
        first, last = labels[..., 0].ravel(), labels[..., -1].ravel()
        joined = (first > 0) & (last > 0)
        ends = first[joined], last[joined]
        graph = coo_array((np.ones(len(ends[0])), ends), shape=(found + 1, found + 1))
        groups, group = connected_components(graph, directed=False)  # that of 0 is the first
        return np.asarray(group[labels][..., self.columns], dtype=np.int64), groups - 1

    def masses(self, scores: Scores, sign: int) -> tuple[IntArray, FloatArray]:
        """Clusters of fields (N, L, S) above the threshold, with a sign, and the mass of each number."""
        excess = sign * scores - CLUSTER_THRESHOLD
        labels, found = self.labelled(excess > 0)
        mass: FloatArray = np.bincount(labels.ravel(), excess.ravel(), found + 1).astype(np.float64)
        mass[0] = 0.0
        return labels, mass

    def largest(self, scores: Scores) -> FloatArray:
        """Largest mass of either sign in each of fields (R, K, L, S) at any K."""
        flat = scores.reshape(-1, *scores.shape[2:])
        by_sign = []
        for sign in SIGNS:
            labels, mass = self.masses(flat, sign)
            by_sign.append(mass[labels].reshape(len(scores), -1).max(axis=1))
        return np.asarray(np.maximum(*by_sign))

    def _around(self, field: Any) -> Any:
        if np.array_equal(self.columns, np.arange(self.count)):
            return field
        around = np.zeros((*field.shape[:-1], self.count), dtype=field.dtype)
        around[..., self.columns] = field
        return around


def standard_scores(correlation: Scores, n_effective: Scores) -> Scores:
    """Correlations over their standard error, by Fisher's transformation; 0 where there is none.

    Parameters
    ----------
    correlation : ndarray of shape (…, K, L, S) and dtype float
    n_effective : ndarray of shape (K, L, S) and dtype float

    Returns
    -------
    ndarray of shape (…, K, L, S) and the dtype of correlation
    """
    worth = np.sqrt(np.maximum(np.nan_to_num(n_effective) - 3.0, _LEAST_WORTH))
    inside = np.clip(np.nan_to_num(correlation), -1.0 + 1e-6, 1.0 - 1e-6)
    return np.asarray(np.arctanh(inside) * worth.astype(correlation.dtype))
