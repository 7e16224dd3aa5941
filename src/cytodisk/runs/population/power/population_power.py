"""How often a difference is found, by its size and the number of experiments."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.population.exchange.exchange_test import exchange_test
from cytodisk.population.exchange.exchanges import LabelExchanges, SignExchanges
from cytodisk.population.exchange.studentised import GroupDifference, PairDifference
from cytodisk.population.exchange.window_neighbours import ClusterField
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL
from cytodisk.runs.population.power.power_parameters import PowerParameters
from cytodisk.runs.population.power.variance_shares import VarianceShares, variance_shares
from cytodisk.runs.run_options import Progress, silent
from cytodisk.simulate.populations.simulated_populations import population as simulated
from cytodisk.taking import takes

LAYERS, SECTORS = 6, 24
CELLS, BETWEEN_EXPERIMENTS, BETWEEN_DISHES = 12, 0.1, 0.05
"""Of a plan without cells at hand."""

_AT_BEST = 9999  # permutations of a real comparison
DESIGNS = ("unpaired", "paired")


@dataclass(frozen=True)
class Plan:
    """What is simulated.

    Attributes
    ----------
    cells : int
    between_experiments, between_dishes : float
        Shares of a cell's variance.
    measured : VarianceShares or None
        What was found in cells at hand.
    """

    cells: int
    between_experiments: float
    between_dishes: float
    measured: VarianceShares | None = None


def plan_of(parameters: PowerParameters, population: Population | None = None) -> Plan:
    """What is simulated: as given, else as measured in a population, else the defaults.

    Parameters
    ----------
    parameters : PowerParameters
    population : Population, optional

    Returns
    -------
    Plan

    Raises
    ------
    PopulationError
        The population does not tell its variance between experiments.
    ParameterError
        Shares sum to more than 1.
    """
    measured = None if population is None else variance_shares(population)
    known = (CELLS, BETWEEN_EXPERIMENTS, BETWEEN_DISHES)
    if measured is not None:
        known = (measured.cells, measured.between_experiments, measured.between_dishes)
    given = (parameters.cells, parameters.between_experiments, parameters.between_dishes)
    cells, experiments, dishes = (
        there if own is None else own for own, there in zip(given, known, strict=True)
    )
    if experiments + dishes > 1:
        raise parameters.fault(
            f"between_experiments + between_dishes must be at most 1, got {experiments:g} + {dishes:g}"
        )
    return Plan(int(cells), float(experiments), float(dishes), measured)


@takes(PowerParameters)
def population_power(
    population: Population | None = None,
    *,
    progress: Progress | None = None,
    parameters: PowerParameters | None = None,
    **settings: Any,
) -> pd.DataFrame:
    """How often a difference between two conditions is found, by its size and the number of experiments.

    Studies are simulated as `simulate.population` makes them, with a sixth of the windows raised in the
    treated cells, and tested as `compare_conditions` tests them.

    Parameters
    ----------
    population : Population, optional
        Cells at hand, whose variance between experiments and number of cells are taken.
    progress : callable, optional
        Called with (lines of the table done, in all).
    parameters : PowerParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `PowerParameters`.

    Returns
    -------
    DataFrame
        One row a design, number of experiments and effect: `smallest_p` that the number can reach; and the
        share of studies in which is found: `window`, at least one of the raised windows (max-T, p ≤ 0.05);
        `cluster`, a cluster that overlaps them; `scalar`, one number by cell that differs as much, tested
        alone. `windows` is the share of the raised windows that is found (max-T). What was simulated is in
        `attrs`.

    Raises
    ------
    PopulationError
        The population does not tell its variance between experiments.
    ParameterError
        A parameter is unknown or out of its range.

    See Also
    --------
    compare_conditions : Compares conditions.
    simulate.population : Makes the cells.

    Examples
    --------
    >>> import cytodisk as cd
    >>> table = cd.population_power(effects=(2.0,), experiments=(3, 4), studies=20, seed=1)
    >>> table[["design", "experiments", "smallest_p"]].round(3).values.tolist()
    [['unpaired', 3, 0.1], ['unpaired', 4, 0.029], ['paired', 3, 0.25], ['paired', 4, 0.125]]
    """
    chosen = PowerParameters.chosen(parameters, settings)
    plan = plan_of(chosen, population)
    report, done = progress or silent, 0
    lines = len(DESIGNS) * len(chosen.experiments) * len(chosen.effects)
    report(0, lines)
    rows = []
    for design in DESIGNS:
        for count in chosen.experiments:
            for row in _lines(plan, chosen, design, count):
                rows.append(row)
                done += 1
                report(done, lines)
    table = pd.DataFrame(rows)
    table.attrs = {
        "cells": plan.cells,
        "between_experiments": plan.between_experiments,
        "between_dishes": plan.between_dishes,
        "studies": chosen.studies,
        "windows": (LAYERS, SECTORS),
    }
    return table


def _lines(plan: Plan, chosen: PowerParameters, design: str, count: int) -> Iterator[dict[str, Any]]:
    """The lines of one design and number of experiments; all effects on the same simulated cells."""
    paired = design == "paired"
    treated = np.repeat([False, True], count)
    smallest_p = _exchanges(paired, treated, _AT_BEST, chosen.seed).smallest_p
    possible = smallest_p <= LEVEL
    values, region = _experiment_means(plan, paired, count, chosen) if possible else _nothing()
    for effect in chosen.effects:
        shares = dict.fromkeys(("window", "windows", "cluster", "scalar"), 0.0)
        if possible:
            raised = values + effect * treated[:, None] * region
            found = [_found(one, treated, paired, chosen, region) for one in raised]
            shares = dict(zip(shares, np.mean(found, axis=0).tolist(), strict=True))
        place = {"design": design, "experiments": count, "effect": effect}
        yield place | {"smallest_p": smallest_p} | shares


def _nothing() -> tuple[FloatArray, BoolArray]:
    return np.empty((0, 0, 0)), np.empty(0, dtype=np.bool_)


def _exchanges(
    paired: bool, treated: BoolArray, permutations: int, seed: int
) -> LabelExchanges | SignExchanges:
    if paired:
        return SignExchanges(len(treated) // 2, permutations, seed)
    return LabelExchanges(treated, permutations, seed)


def _experiment_means(
    plan: Plan, paired: bool, count: int, chosen: PowerParameters
) -> tuple[FloatArray, BoolArray]:
    """Means of experiments in windows: (studies, units, windows), in standard deviations of a cell.

    The mean of n cells is distributed as one cell whose own variance is an n-th of it.
    """
    shares = plan.between_experiments, plan.between_dishes
    own = (1.0 - sum(shares)) / plan.cells
    total = sum(shares) + own
    truth = simulated(
        chosen.seed,
        layers=LAYERS,
        sectors=SECTORS,
        experiments=count * chosen.studies,
        paired=paired,
        cells=1,
        mean=0.0,
        effect=0.0,
        deviation=float(np.sqrt(total)),
        between_experiments=shares[0] / total,
        between_dishes=shares[1] / total,
    )
    of_condition = truth.values.to_numpy().reshape(2, chosen.studies, count, -1)
    values = np.concatenate([of_condition[0], of_condition[1]], axis=1)
    return values, truth.region.to_numpy().ravel()


def _found(
    values: FloatArray, treated: BoolArray, paired: bool, chosen: PowerParameters, region: BoolArray
) -> tuple[float, float, float, float]:
    """Whether a study finds a window, how many of them, a cluster, and one number alone."""
    exchanges = _exchanges(paired, treated, chosen.permutations, chosen.seed)
    family = np.zeros(values.shape[1], dtype=np.int64)
    field = ClusterField((1, LAYERS, SECTORS), closed=True)
    one = values[:, np.flatnonzero(region)[:1]]
    if paired:
        differences, single = values[treated] - values[~treated], one[treated] - one[~treated]
        test = exchange_test(PairDifference(differences, family), exchanges, field)
        alone = exchange_test(PairDifference(single), exchanges)
    else:
        test = exchange_test(GroupDifference(values, treated, family), exchanges, field)
        alone = exchange_test(GroupDifference(one, treated), exchanges)
    windows = float((test.p_fwer[region] <= LEVEL).mean())
    clusters = np.flatnonzero(test.cluster_p <= LEVEL) + 1
    cluster = np.isin(test.labels[region], clusters).any()
    return float(windows > 0), windows, float(cluster), float(alone.p[0] <= LEVEL)
