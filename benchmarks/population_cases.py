"""Null studies of `population_null.py`: what is simulated, what is found, and what a test can attain."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import cytodisk as cd
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.population.conditions.experiment_units import units_of
from cytodisk.population.conditions.unit_values import scalar_means, usable_cells, window_means
from cytodisk.population.exchange.exchange_test import ExchangeTest, exchange_test
from cytodisk.population.exchange.exchanges import Exchanges, LabelExchanges, SignExchanges
from cytodisk.population.exchange.studentised import GroupDifference, PairDifference
from cytodisk.population.exchange.window_neighbours import ClusterField

ALPHA = 0.05
LAYERS, SECTORS, CELLS = 4, 12, 8
ALIGNMENTS = ("none", "nucleus", "front", "signal")
TESTS = ("windows", "clusters", "mean", "scalars")
BLOCK = 50  # studies that are simulated at once
_SAME = 1e-9  # of p-values that are the same
_FAMILY = np.zeros(LAYERS * SECTORS, dtype=np.int64)
_FIELD = ClusterField((1, LAYERS, SECTORS), closed=True)


@dataclass(frozen=True)
class Case:
    """One kind of null study.

    Attributes
    ----------
    share : float
        Of the variance, between experiments.
    design : {"unpaired", "paired"}
    experiments : int
        Of each condition, or pairs.
    alignment : str
        One of `ALIGNMENTS`.
    unit : {"experiment", "cell"}
    """

    share: float
    design: str
    experiments: int
    alignment: str = "none"
    unit: str = "experiment"

    @property
    def key(self) -> str:
        """Name in a file of results."""
        return " ".join(str(value) for value in asdict(self).values())


def ways(case: Case, permutations: int) -> tuple[int, int]:
    """Number of exchanges that are tried, with the observed one, and of those that are as far apart.

    With groups of one size, and with pairs, labels that are all exchanged give the same difference with the
    other sign; among drawn exchanges only the observed one is sure to be there.
    """
    n = case.experiments * (CELLS if case.unit == "cell" else 1)
    number = 2**n if case.design == "paired" and case.unit == "experiment" else math.comb(2 * n, n)
    return (number, 2) if number <= permutations + 1 else (permutations + 1, 1)


def attainable(case: Case, permutations: int) -> float:
    """Largest level of at most .05 that an exact test of this case can have."""
    number, step = ways(case, permutations)
    return math.floor(ALPHA * number / step + _SAME) * step / number


def population(case: Case, block: int) -> cd.Population:
    """`BLOCK` studies in one, in which conditions differ by chance alone, aligned."""
    truth = cd.simulate.population(
        block,
        effect=0.0,
        experiments=case.experiments * BLOCK,
        cells=CELLS,
        paired=case.design == "paired",
        between_experiments=case.share,
        layers=LAYERS,
        sectors=SECTORS,
        turned=case.alignment if case.alignment in ("nucleus", "front") else "none",
    )
    cells = cd.Population(truth.values, truth.cells)
    by = f"signal:{cells.channels[0]}" if case.alignment == "signal" else case.alignment
    return cells.align(by, weakest=0.0)


class Studies:
    """A block of studies of a case, with means and scalars of all their units.

    A study is so many experiments of each condition as the case has, in the order of the units. It is tested
    as `compare_conditions` does it, without the tables, which take most of the time.

    Parameters
    ----------
    case : Case
    block : int
        Seed of the population.
    permutations : int
    """

    def __init__(self, case: Case, block: int, permutations: int) -> None:
        self._case, self._permutations = case, permutations
        self.cells = population(case, block)
        usable = usable_cells(self.cells, self.cells.channels)
        design = "auto" if case.unit == "experiment" else "unpaired"
        self._units = units_of(self.cells.cells, usable, ("control", "drug"), case.unit, design)
        given = self.cells, self.cells.channels, self._units.codes, self._units.count
        self._values, scalars = window_means(*given), scalar_means(*given)
        self._scalars = scalars.values
        self._mean = int(np.flatnonzero(scalars.table["scalar"].str.startswith("mean_"))[0])

    def _rows(self, number: int) -> IntArray:
        """Units of a study: those of the control, then the others."""
        size = self._units.count // (2 * BLOCK)
        first = number * size + np.arange(size)
        return np.concatenate([first, first + self._units.count // 2])

    def alone(self, number: int) -> cd.Population:
        """The cells of a study."""
        return self.cells.select(np.isin(self._units.codes, self._rows(number)))

    def p_values(self, number: int, seed: int) -> dict[str, float]:
        """The smallest corrected p-value of each kind of test in a study; of the mean of a cell alone."""
        rows = self._rows(number)
        exchanges = self._exchanges(len(rows) // 2, seed)
        of_windows = self._test(self._values[rows], exchanges, _FAMILY, _FIELD)
        of_scalars = self._test(self._scalars[rows], exchanges)
        return {
            "windows": float(np.nanmin(of_windows.p_fwer)),
            "clusters": float(min(of_windows.cluster_p, default=1.0)),
            "mean": float(of_scalars.p[self._mean]),
            "scalars": float(np.nanmin(of_scalars.p_fwer)),
        }

    def _exchanges(self, half: int, seed: int) -> Exchanges:
        if self._units.paired:
            drawn: Exchanges = SignExchanges(half, self._permutations, seed)
        else:
            drawn = LabelExchanges(np.arange(2 * half) >= half, self._permutations, seed)
        return _all_at_once(drawn, self._units.paired, half) if drawn.all_ways else drawn

    def _test(
        self, values: FloatArray, exchanges: Exchanges, family: Any = None, field: Any = None
    ) -> ExchangeTest:
        half = len(values) // 2
        if self._units.paired:
            return exchange_test(PairDifference(values[half:] - values[:half], family), exchanges, field)
        treated = np.arange(2 * half) >= half
        return exchange_test(GroupDifference(values, treated, family), exchanges, field)


@dataclass(frozen=True, eq=False)
class AllExchanges:
    """All ways to exchange labels, listed once."""

    labels: Any
    smallest_p: float
    all_ways: bool = True

    @property
    def count(self) -> int:
        """Number of ways."""
        return len(self.labels)

    def chunks(self, size: int) -> Iterator[Any]:
        """Some ways at a time."""
        for start in range(0, self.count, size):
            yield self.labels[start : start + size]


_listed: dict[tuple[bool, int], AllExchanges] = {}


def _all_at_once(exchanges: Exchanges, paired: bool, half: int) -> AllExchanges:
    if (paired, half) not in _listed:
        labels = np.concatenate(list(exchanges.chunks(4096)))
        _listed[paired, half] = AllExchanges(labels, exchanges.smallest_p)
    return _listed[paired, half]


def is_found(p: float) -> bool:
    """Whether a p-value is at most .05."""
    return p <= ALPHA + _SAME


def p_values_of_comparison(
    case: Case, cells: cd.Population, seed: int, permutations: int
) -> dict[str, float]:
    """As those of `Studies`, from `compare_conditions` itself."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cd.compare_conditions(
            cells, "control", "drug", unit=case.unit, permutations=permutations, seed=seed
        )
    scalars = found.scalars.set_index("scalar")
    mean = [name for name in scalars.index if name.startswith("mean_")]
    return {
        "windows": float(found.windows["p_fwer"].min()),
        "clusters": float(min(found.clusters["p"], default=1.0)),
        "mean": float(scalars.loc[mean[0], "p"]),
        "scalars": float(scalars["p_fwer"].min()),
    }


def standard_error(level: float, studies: int) -> float:
    """Of a rate whose true value is a level."""
    return math.sqrt(level * (1.0 - level) / studies)
