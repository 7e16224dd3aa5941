"""Doses exchanged between experiments, or within them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice, permutations, product
from math import factorial, prod

import numpy as np
from numpy.typing import NDArray

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.population.exchange.studentised import shared_medians, sure_scores


@dataclass(frozen=True, eq=False)
class DoseExchanges:
    """Doses of units: (ways, units), the observed ones first.

    Attributes
    ----------
    doses : ndarray of shape (units,) and dtype float64
    blocks : ndarray of shape (units,) and dtype int64
        Doses are exchanged between units of one block alone.
    permutations : int
        Most ways beside the observed one.
    seed : int
    """

    doses: FloatArray
    blocks: IntArray
    permutations: int
    seed: int

    @cached_property
    def _members(self) -> list[IntArray]:
        return [np.flatnonzero(self.blocks == block) for block in np.unique(self.blocks)]

    @property
    def _ways(self) -> int:
        """Ways that differ."""
        each = []
        for members in self._members:
            alike = Counter(self.doses[members].tolist()).values()
            each.append(factorial(len(members)) // prod(factorial(count) for count in alike))
        return prod(each)

    @property
    def _orders(self) -> int:
        """Ways to order the units, of which some give equal doses."""
        return prod(factorial(len(members)) for members in self._members)

    @property
    def all_ways(self) -> bool:
        """Whether all ways there are were taken."""
        return self._orders <= self.permutations + 1

    @property
    def count(self) -> int:
        """Number of ways, with the observed one."""
        return self._orders if self.all_ways else self.permutations + 1

    @property
    def smallest_p(self) -> float:
        """Doses that lie evenly around their mean give the same trend with the other sign."""
        return max(
            1.0 / self.count,
            (2.0 if all(map(self._is_even, self._members)) else 1.0) / min(self._ways, 10**15),
        )

    def _is_even(self, members: IntArray) -> bool:
        doses = np.sort(self.doses[members])
        return bool(np.ptp(doses + doses[::-1]) <= 1e-9 * max(1.0, float(np.abs(doses).max())))

    def chunks(self, size: int) -> Iterator[FloatArray]:
        """Doses of some ways at a time."""
        if self.all_ways:
            orders = product(*(permutations(members.tolist()) for members in self._members))
            places = np.concatenate(self._members)
            while some := list(islice(orders, size)):
                rows = np.empty((len(some), len(self.doses)))
                rows[:, places] = self.doses[np.array([[k for part in way for k in part] for way in some])]
                yield rows
            return
        rng = np.random.default_rng(self.seed)
        left, first = self.permutations, self.doses[None]
        while left:
            rows = np.broadcast_to(self.doses, (min(size, left), len(self.doses))).copy()
            for members in self._members:
                rows[:, members] = rng.permuted(rows[:, members], axis=1)
            yield np.concatenate([first, rows])
            left, first = left - len(rows), first[:0]


class DoseSlope:
    """Slope over the dose, over its standard error, in each window.

    Parameters
    ----------
    values : ndarray of shape (units, windows) and dtype float64
        A window in which a unit has no value is not tested.
    doses : ndarray of shape (units,) and dtype float64
    blocks : ndarray of shape (units,) and dtype int64
        Each block has a level of its own.
    families : ndarray of shape (windows,) and dtype int64, optional
        As for `GroupDifference`.
    """

    def __init__(
        self, values: FloatArray, doses: FloatArray, blocks: IntArray, families: IntArray | None = None
    ) -> None:
        self.testable: BoolArray = np.asarray(np.isfinite(values).all(axis=0))
        self.scored = self.testable
        self._blocks = blocks
        self._values = without_levels(np.where(self.testable, values, 0.0), blocks)
        self._squares = (self._values**2).sum(axis=0)
        self._spread = float((without_levels(doses[:, None], blocks) ** 2).sum())
        self._own = max(len(doses) - len(np.unique(blocks)) - 1, 1)
        variance = self._squares / (self._own + 1) / self._spread
        self._shared = None if families is None else shared_medians(variance, self.testable, families)

    @property
    def degrees(self) -> float:
        """Degrees of freedom, twice those of a window alone where its error is shared."""
        return float(self._own if self._shared is None else 2 * self._own)

    def scores(self, labels: NDArray[np.generic]) -> FloatArray:
        """Scores (ways, windows) for doses (ways, units)."""
        doses = without_levels(labels.astype(np.float64).T, self._blocks).T
        products = doses @ self._values
        slope = products / self._spread
        within = self._squares - products * slope
        within = np.where(within > 1e-13 * self._squares, within, 0.0)
        error = within / self._own / self._spread
        if self._shared is not None:
            error = 0.5 * (error + self._shared)
        rounding = 1e-9 * np.sqrt(self._squares / self._spread)
        return sure_scores(np.where(self.testable, slope, 0.0), error, rounding)


def without_levels(values: FloatArray, blocks: IntArray) -> FloatArray:
    """Values (units, …) minus the mean of their block.

    Parameters
    ----------
    values : ndarray of shape (units, …) and dtype float64
    blocks : ndarray of shape (units,) and dtype int64

    Returns
    -------
    ndarray of the shape of values
    """
    found = np.array(values, dtype=np.float64)
    for block in np.unique(blocks):
        found[blocks == block] -= found[blocks == block].mean(axis=0)
    return found
