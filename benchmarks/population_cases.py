"""Null studies of `population_null.py`: what is simulated, what is found, and what a test can attain."""

from __future__ import annotations

import math
import warnings
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

import cytodisk as cd
from cytodisk.population.conditions.experiment_units import units_of
from cytodisk.population.conditions.unit_values import scalar_means, usable_cells, window_means
from cytodisk.population.exchange.exchange_test import ExchangeTest, exchange_test
from cytodisk.population.exchange.exchanges import LabelExchanges, SignExchanges
from cytodisk.population.exchange.studentised import GroupDifference, PairDifference
from cytodisk.population.exchange.window_neighbours import ClusterField

ALPHA = 0.05
LAYERS, SECTORS, CELLS = 4, 12, 8
ALIGNMENTS = ("none", "nucleus", "front", "signal")
TESTS = ("windows", "clusters", "mean", "scalars")
_SAME = 1e-9  # of p-values that are the same


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


def study(case: Case, seed: int) -> cd.Population:
    """A study in which conditions differ by chance alone, aligned."""
    truth = cd.simulate.population(
        seed,
        effect=0.0,
        experiments=case.experiments,
        cells=CELLS,
        paired=case.design == "paired",
        between_experiments=case.share,
        layers=LAYERS,
        sectors=SECTORS,
        turned=case.alignment if case.alignment in ("nucleus", "front") else "none",
    )
    population = cd.Population(truth.values, truth.cells)
    by = f"signal:{population.channels[0]}" if case.alignment == "signal" else case.alignment
    return population.align(by, weakest=0.0)


class Tester:
    """What `compare_conditions` does for its p-values, without its tables, which take most of the time.

    Parameters
    ----------
    case : Case
    permutations : int
    """

    def __init__(self, case: Case, permutations: int) -> None:
        self._case, self._permutations = case, permutations
        first = study(case, 0)
        usable = usable_cells(first, first.channels)
        design = "auto" if case.unit == "experiment" else "unpaired"
        self._units = units_of(first.cells, usable, ("control", "drug"), case.unit, design)
        self._field = ClusterField((1, LAYERS, SECTORS), closed=True)
        self._family = np.zeros(LAYERS * SECTORS, dtype=np.int64)

    def p_values(self, seed: int) -> dict[str, float]:
        """The smallest corrected p-value of each kind of test; the mean of a cell alone."""
        population, units = study(self._case, seed), self._units
        values = window_means(population, population.channels, units.codes, units.count)
        scalars = scalar_means(population, population.channels, units.codes, units.count)
        of_windows = self._test(values, seed, self._family, self._field)
        of_scalars = self._test(scalars.values, seed)
        mean = int(np.flatnonzero(scalars.table["scalar"].str.startswith("mean_"))[0])
        return {
            "windows": float(np.nanmin(of_windows.p_fwer)),
            "clusters": float(min(of_windows.cluster_p, default=1.0)),
            "mean": float(of_scalars.p[mean]),
            "scalars": float(np.nanmin(of_scalars.p_fwer)),
        }

    def _test(self, values: Any, seed: int, family: Any = None, field: Any = None) -> ExchangeTest:
        units = self._units
        if units.paired:
            half = units.count // 2
            statistic = PairDifference(values[half:] - values[:half], family)
            return exchange_test(statistic, SignExchanges(half, self._permutations, seed), field)
        statistic = GroupDifference(values, units.treated, family)
        return exchange_test(statistic, LabelExchanges(units.treated, self._permutations, seed), field)


def is_found(p: float) -> bool:
    """Whether a p-value is at most .05."""
    return p <= ALPHA + _SAME


def p_values_of_comparison(case: Case, seed: int, permutations: int) -> dict[str, float]:
    """As those of `Tester`, from `compare_conditions` itself."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cd.compare_conditions(
            study(case, seed), "control", "drug", unit=case.unit, permutations=permutations, seed=seed
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
