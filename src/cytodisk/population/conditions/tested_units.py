"""One way to test units, applied to windows, to clusters of them, and to scalars."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.population.comparison_parameters import PermutationParameters
from cytodisk.population.conditions.comparison_tables import (
    cluster_table,
    numbers_of_results,
    scalar_rows,
    window_dataset,
)
from cytodisk.population.conditions.experiment_units import Units
from cytodisk.population.conditions.unit_values import scalar_means, window_means
from cytodisk.population.exchange.effect_intervals import group_effects, mean_effects, pair_effects
from cytodisk.population.exchange.exchange_test import exchange_test
from cytodisk.population.exchange.exchanges import Exchanges, LabelExchanges, SignExchanges
from cytodisk.population.exchange.studentised import GroupDifference, PairDifference, Statistic
from cytodisk.population.exchange.window_neighbours import ClusterField
from cytodisk.population.population import Population


class UnitTest(Protocol):
    """How units are tested."""

    @property
    def exchanges(self) -> Exchanges:
        """Labels that are exchanged."""

    def statistic(self, values: FloatArray, families: IntArray | None) -> Statistic:
        """Scores of (units, windows)."""

    def effects(self, values: FloatArray) -> Mapping[str, FloatArray]:
        """Columns of (units, windows); `difference` is one of them."""


@dataclass(frozen=True, eq=False)
class TwoConditions:
    """Two conditions against each other."""

    units: Units
    chosen: PermutationParameters

    @property
    def exchanges(self) -> Exchanges:
        """Labels of experiments, or the halves of pairs."""
        most, seed = self.chosen.permutations, self.chosen.seed
        if self.units.paired:
            return SignExchanges(self.units.count // 2, most, seed)
        return LabelExchanges(self.units.treated, most, seed)

    def statistic(self, values: FloatArray, families: IntArray | None) -> Statistic:
        """Differences."""
        if self.units.paired:
            return PairDifference(values[self.units.treated] - values[~self.units.treated], families)
        return GroupDifference(values, self.units.treated, families)

    def effects(self, values: FloatArray) -> Mapping[str, FloatArray]:
        """Differences, effect sizes and their intervals."""
        if self.units.paired:
            return pair_effects(values[~self.units.treated], values[self.units.treated])
        return group_effects(values, self.units.treated)


@dataclass(frozen=True, eq=False)
class AgainstZero:
    """One condition against 0."""

    units: int
    chosen: PermutationParameters

    @property
    def exchanges(self) -> Exchanges:
        """Signs of experiments."""
        return SignExchanges(self.units, self.chosen.permutations, self.chosen.seed)

    def statistic(self, values: FloatArray, families: IntArray | None) -> Statistic:
        """Means."""
        return PairDifference(values, families)

    def effects(self, values: FloatArray) -> Mapping[str, FloatArray]:
        """Means and their intervals."""
        return mean_effects(values)


@dataclass(frozen=True, eq=False)
class TestedUnits:
    """What a test found.

    Attributes
    ----------
    windows : Dataset with dims (channel, layer, last)
    clusters, scalars : DataFrame
    results : dict of str to (ndarray of shape (units,), bool)
        See `numbers_of_results`.
    values : ndarray of shape (units, windows) and dtype float64
        Means of the units; in scalars where cells have no windows.
    """

    windows: xr.Dataset
    clusters: pd.DataFrame
    scalars: pd.DataFrame
    results: dict[str, tuple[FloatArray, bool]]
    values: FloatArray


def unit_results(
    pop: Population,
    channels: Sequence[str],
    codes: IntArray,
    units: int,
    test: UnitTest,
    progress: Callable[[int, int], None] | None = None,
) -> TestedUnits:
    """Test the means of units.

    Parameters
    ----------
    pop : Population
    channels : sequence of str
        Tested and corrected together.
    codes : ndarray of shape (cells,) and dtype int64
        Unit of each cell, -1 for none.
    units : int
    test : UnitTest
    progress : callable, optional
        Called with (exchanges done, exchanges in all) of the windows.

    Returns
    -------
    TestedUnits
    """
    values = window_means(pop, channels, codes, units)
    shape = (len(channels), pop.raw.shape[2], pop.raw.shape[3])
    families = np.repeat(np.arange(len(channels)), shape[1] * shape[2])
    field = ClusterField(shape, closed=pop.last == "sector")
    effects = test.effects(values)
    tested = exchange_test(test.statistic(values, families), test.exchanges, field, progress)
    windows = window_dataset(pop, channels, effects, tested)
    clusters = cluster_table(pop, channels, effects["difference"], tested)
    numbers = scalar_means(pop, channels, codes, units)
    scalar_test = exchange_test(test.statistic(numbers.values, None), test.exchanges)
    scalars = scalar_rows(numbers.table, test.effects(numbers.values), scalar_test)
    results = numbers_of_results(values, windows, clusters, numbers.values, scalars)
    shown = values if values.shape[1] else numbers.values
    return TestedUnits(windows, clusters, scalars, results, shown)
