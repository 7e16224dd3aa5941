"""p-values from exchanged labels: of each window, of the largest score (max-T), and of clusters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.stats import false_discovery_control, t

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.population.exchange.exchanges import MOST_LABELS, Exchanges
from cytodisk.population.exchange.studentised import Statistic
from cytodisk.population.exchange.window_neighbours import ClusterField

_MOST_SCORES = 2_000_000
_TIE = 1e-9  # two scores that differ by less, as a share, are equal
_CLUSTER_TAIL = 0.01  # of each side: scores beyond it join clusters


@dataclass(frozen=True, eq=False)
class ExchangeTest:
    """Scores and p-values of windows, and of clusters of them.

    Attributes
    ----------
    scores : ndarray of shape (windows,) and dtype float64
    p, p_fwer, q : ndarray of shape (windows,) and dtype float64
        NaN where a window is not tested. p_fwer is that of the step-down max-T procedure of Westfall & Young
        (1993), q that of Benjamini & Hochberg (1995).
    labels : ndarray of shape (windows,) and dtype int64
        Number of each window's cluster from 1; 0 for none.
    masses, cluster_p : ndarray of shape (clusters,) and dtype float64
    """

    scores: FloatArray
    p: FloatArray
    p_fwer: FloatArray
    q: FloatArray
    labels: IntArray
    masses: FloatArray
    cluster_p: FloatArray


def exchange_test(
    statistic: Statistic,
    exchanges: Exchanges,
    field: ClusterField | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> ExchangeTest:
    """Test all windows together.

    Parameters
    ----------
    statistic : Statistic
    exchanges : Exchanges
    field : ClusterField, optional
        How windows lie beside each other; without it there are no clusters.
    progress : callable, optional
        Called with (exchanges done, exchanges in all).

    Returns
    -------
    ExchangeTest
    """
    testable, scored = statistic.testable, statistic.scored
    windows = len(testable)
    nothing = np.full(windows, np.nan)
    no_clusters = np.zeros(windows, dtype=np.int64), np.empty(0), np.empty(0)
    if not scored.any():
        return ExchangeTest(nothing, nothing, nothing, nothing, *no_clusters)
    threshold = float(t.isf(_CLUSTER_TAIL, statistic.degrees))
    found: _Counts | None = None
    for labels in exchanges.chunks(_chunk_size(exchanges, windows)):
        scores = statistic.scores(labels)
        if found is None:
            found = _Counts.of(scores[0], testable, field, threshold)
        found.add(scores)
        if progress is not None:
            progress(found.ways, exchanges.count)
    assert found is not None  # the observed labels are always there
    p, stepped = found.exceeding / found.ways, found.stepped / found.ways
    p_fwer = nothing.copy()
    p_fwer[found.order] = np.maximum.accumulate(stepped)
    q = nothing.copy()
    q[testable] = false_discovery_control(p[testable])
    clusters = found.labels, found.masses, found.larger / found.ways
    told = [np.where(scored, numbers, np.nan) for numbers in (found.observed, p, p_fwer, q)]
    return ExchangeTest(told[0], told[1], told[2], told[3], *clusters)


def _chunk_size(exchanges: Exchanges, windows: int) -> int:
    units = len(next(iter(exchanges.chunks(1)))[0])
    return int(np.clip(min(MOST_LABELS // units, _MOST_SCORES // windows), 8, 4096))


@dataclass(eq=False)
class _Counts:
    """How many exchanges reach what was observed, summed up as they come."""

    observed: FloatArray
    order: IntArray  # testable windows from the largest score down
    field: ClusterField | None
    threshold: float
    labels: IntArray
    masses: FloatArray
    exceeding: FloatArray
    stepped: FloatArray
    larger: FloatArray
    ways: int = 0

    @classmethod
    def of(
        cls, observed: FloatArray, testable: BoolArray, field: ClusterField | None, threshold: float
    ) -> _Counts:
        tested = np.flatnonzero(testable)
        order = tested[np.argsort(-np.abs(observed[tested]), kind="stable")]
        labels, masses = np.zeros(len(observed), dtype=np.int64), np.empty(0)
        if field is not None:
            labels, masses = field.clusters(observed, threshold)
        zeros = np.zeros(len(observed)), np.zeros(len(order)), np.zeros(len(masses))
        return cls(observed, order, field, threshold, labels, masses, *zeros)

    def add(self, scores: FloatArray) -> None:
        """Count some exchanges."""
        sizes = np.abs(scores)
        reach = np.abs(self.observed) * (1.0 - _TIE) - _TIE
        self.exceeding += (sizes >= reach).sum(axis=0)
        below = np.maximum.accumulate(sizes[:, self.order[::-1]], axis=1)[:, ::-1]
        self.stepped += (below >= reach[self.order]).sum(axis=0)
        if self.field is not None and len(self.masses):
            largest = np.sort(self.field.largest(scores, self.threshold))
            self.larger += len(largest) - np.searchsorted(largest, self.masses * (1.0 - _TIE))
        self.ways += len(scores)
