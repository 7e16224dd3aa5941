"""The ways to exchange labels between units: all of them where there are few, a random draw elsewhere."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, islice, product
from math import comb, lgamma, log
from typing import Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from cytodisk.arrays import BoolArray

Label = TypeVar("Label", bound=np.generic)
_VERY_MANY = 10**15  # ways to exchange labels, of which more make no difference
MOST_LABELS = 30_000_000  # labels held at a time


class Exchanges(Protocol):
    """Labels of units, the observed ones first."""

    @property
    def count(self) -> int:
        """Number of ways, with the observed one."""

    @property
    def smallest_p(self) -> float:
        """The smallest p-value that these ways can give."""

    @property
    def all_ways(self) -> bool:
        """Whether all ways there are were taken."""

    def chunks(self, size: int) -> Iterator[NDArray[np.generic]]:
        """Labels of some ways at a time: arrays (ways, units)."""


@dataclass(frozen=True, eq=False)
class LabelExchanges:
    """Which units are treated: (ways, units) of bool.

    Attributes
    ----------
    treated : ndarray of shape (units,) and dtype bool
        As it was.
    permutations : int
        Most ways beside the observed one.
    seed : int
    """

    treated: BoolArray
    permutations: int
    seed: int

    @property
    def _ways(self) -> int:
        units, chosen = len(self.treated), int(self.treated.sum())
        size = lgamma(units + 1) - lgamma(chosen + 1) - lgamma(units - chosen + 1)
        return comb(units, chosen) if size < log(_VERY_MANY) + 1.0 else 2 * _VERY_MANY

    @property
    def all_ways(self) -> bool:
        """Whether all ways there are were taken."""
        return self._ways <= self.permutations + 1

    @property
    def count(self) -> int:
        """Number of ways, with the observed one."""
        return self._ways if self.all_ways else self.permutations + 1

    @property
    def smallest_p(self) -> float:
        """With groups of one size both labels exchanged give the same difference with the other sign."""
        equal = 2 * int(self.treated.sum()) == len(self.treated)
        return max(1.0 / self.count, (2.0 if equal else 1.0) / min(self._ways, _VERY_MANY))

    def chunks(self, size: int) -> Iterator[BoolArray]:
        """Labels of some ways at a time."""
        if self.all_ways:
            yield from _chunks(self._every(), size)
            return
        rng = np.random.default_rng(self.seed)
        left, first = self.permutations, self.treated[None]
        while left:
            rows = min(size, left)
            drawn = rng.permuted(np.broadcast_to(self.treated, (rows, len(self.treated))), axis=1)
            yield np.concatenate([first, drawn])
            left, first = left - rows, self.treated[None][:0]

    def _every(self) -> Iterator[BoolArray]:
        yield self.treated
        units, chosen = len(self.treated), tuple(int(k) for k in np.flatnonzero(self.treated))
        for way in combinations(range(units), len(chosen)):
            if way != chosen:
                labels = np.zeros(units, dtype=np.bool_)
                labels[list(way)] = True
                yield labels


@dataclass(frozen=True, eq=False)
class SignExchanges:
    """Which pairs are exchanged: (ways, pairs) of 1 or -1.

    Attributes
    ----------
    pairs : int
    permutations : int
        Most ways beside the observed one.
    seed : int
    """

    pairs: int
    permutations: int
    seed: int

    @property
    def all_ways(self) -> bool:
        """Whether all ways there are were taken."""
        return self.pairs < 60 and 2**self.pairs <= self.permutations + 1

    @property
    def count(self) -> int:
        """Number of ways, with the observed one."""
        return 2**self.pairs if self.all_ways else self.permutations + 1

    @property
    def smallest_p(self) -> float:
        """All pairs exchanged give the same difference with the other sign."""
        return max(1.0 / self.count, 2.0 ** (1 - min(self.pairs, 60)))

    def chunks(self, size: int) -> Iterator[NDArray[np.int8]]:
        """Signs of some ways at a time."""
        if self.all_ways:
            signs = product((1, -1), repeat=self.pairs)  # the first has them as they were
            yield from _chunks((np.array(row, dtype=np.int8) for row in signs), size)
            return
        rng = np.random.default_rng(self.seed)
        left, first = self.permutations, np.ones((1, self.pairs), dtype=np.int8)
        while left:
            rows = min(size, left)
            drawn = 1 - 2 * rng.integers(0, 2, (rows, self.pairs), dtype=np.int8)
            yield np.concatenate([first, drawn])
            left, first = left - rows, first[:0]


def _chunks(rows: Iterator[NDArray[Label]], size: int) -> Iterator[NDArray[Label]]:
    while some := list(islice(rows, size)):
        yield np.stack(some)
