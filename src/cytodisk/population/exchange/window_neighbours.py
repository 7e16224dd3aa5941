"""Windows that lie beside each other, and clusters of those that agree."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.analysis.correlation.cluster_fields import SIGNS, WindowRing
from cytodisk.arrays import FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class ClusterField:
    """Windows of some channels, in the order (channel, layer, last).

    Attributes
    ----------
    shape : (int, int, int)
        Channels, layers, and sectors or lags.
    closed : bool
        The last sector is the first one's neighbour.
    """

    shape: tuple[int, int, int]
    closed: bool

    @property
    def _ring(self) -> WindowRing:
        last = self.shape[2]
        return WindowRing(np.arange(last), last if self.closed else last + 1)

    def clusters(self, scores: FloatArray, threshold: float) -> tuple[IntArray, FloatArray]:
        """Clusters of windows with one sign, from the largest mass down.

        Parameters
        ----------
        scores : ndarray of shape (windows,) and dtype float64
        threshold : float

        Returns
        -------
        labels : ndarray of shape (windows,) and dtype int64
            Numbers from 1; 0 for none.
        masses : ndarray of shape (clusters,) and dtype float64
            Sum over the cluster of how far the scores lie beyond the threshold.
        """
        labels, masses = np.zeros(len(scores), dtype=np.int64), np.empty(0)
        for sign in SIGNS:
            own, mass = self._masses(scores[None], threshold, sign)
            labels = np.where(own.ravel() > 0, own.ravel() + len(masses), labels)
            masses = np.concatenate([masses, mass[1:]])
        order = np.argsort(-masses, kind="stable")
        number = np.zeros(len(masses) + 1, dtype=np.int64)
        number[order + 1] = np.arange(1, len(masses) + 1)
        return number[labels], masses[order]

    def largest(self, scores: FloatArray, threshold: float) -> FloatArray:
        """Largest mass of either sign in each of the rows (ways, windows)."""
        by_sign = []
        for sign in SIGNS:
            labels, mass = self._masses(scores, threshold, sign)
            by_sign.append(mass[labels].reshape(len(scores), -1).max(axis=1))
        return np.asarray(np.maximum(*by_sign))

    def _masses(self, scores: FloatArray, threshold: float, sign: int) -> tuple[IntArray, FloatArray]:
        excess = (sign * scores - threshold).reshape(-1, *self.shape[1:])
        labels, found = self._ring.labelled(excess > 0)
        mass = np.bincount(labels.ravel(), excess.ravel(), found + 1).astype(np.float64)
        mass[0] = 0.0
        return labels, mass
