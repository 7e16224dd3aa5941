"""How much of the variance of cells lies between experiments, in a population at hand."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.errors import PopulationError
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, codes_of, names_in
from cytodisk.population.group_means import group_sums
from cytodisk.population.population import Population

Block: TypeAlias = tuple[slice, FloatArray]
"""Rows of cells, and their values (cells, channels, layers, sectors)."""


@dataclass(frozen=True)
class VarianceShares:
    """What a plan takes from cells at hand.

    Attributes
    ----------
    between_experiments : float
        Share of the variance that both conditions of an experiment share.
    between_dishes : float
        Share between conditions of one experiment, beside the difference of the conditions.
    cells : int
        Median number of cells of a condition in an experiment.
    experiments, conditions : int
    separate : bool
        Experiments hold several conditions, so that the two shares can be told apart.
    """

    between_experiments: float
    between_dishes: float
    cells: int
    experiments: int
    conditions: int
    separate: bool


def variance_shares(population: Population) -> VarianceShares:
    """Shares of the variance of windows, or else of scalars, between experiments and between dishes.

    A dish is all cells of one condition in one experiment. Mean squares within and between dishes are taken
    apart as in an analysis of variance by the method of moments, mean over windows; a share below 0 counts
    as 0.

    Parameters
    ----------
    population : Population

    Returns
    -------
    VarianceShares

    Raises
    ------
    PopulationError
        There are no two experiments of one condition, or no cells with values in them.
    """
    cells = population.cells
    condition, conditions = codes_of(names_in(cells, CONDITION))
    if not conditions:
        condition = np.zeros(len(cells), dtype=np.int64)
    experiment, experiments = codes_of(names_in(cells, EXPERIMENT))
    known = (condition >= 0) & (experiment >= 0)
    table = pd.DataFrame({CONDITION: condition, EXPERIMENT: experiment})[known]
    dishes = table.drop_duplicates(ignore_index=True).sort_values([CONDITION, EXPERIMENT], ignore_index=True)
    if not len(dishes) or dishes.groupby(CONDITION).size().max() < 2:
        raise PopulationError(
            "power: the variance between experiments needs two experiments of one condition: name them in "
            "the column experiment, or leave PATH out and pass --between-experiments"
        )
    place = {pair: number for number, pair in enumerate(dishes.itertuples(index=False, name=None))}
    code = np.full(len(cells), -1, dtype=np.int64)
    code[known] = [place[pair] for pair in table.itertuples(index=False, name=None)]
    within, between, alike = _components(population, code, dishes)
    total = within + between
    if not total > 0:
        raise PopulationError("power: all cells have the same values, which leaves no variance to plan with")
    per_dish = np.bincount(code[code >= 0], minlength=len(dishes))
    separate = bool(dishes.groupby(EXPERIMENT).size().max() > 1)
    common = float(np.clip(alike, 0.0, between)) if separate else between
    return VarianceShares(
        common / total,
        (between - common) / total,
        max(int(np.median(per_dish)), 1),
        len(experiments),
        max(len(conditions), 1),
        separate,
    )


def _components(population: Population, code: np.ndarray, dishes: pd.DataFrame) -> tuple[float, float, float]:
    """Variance of cells within dishes, of dishes of a condition, and what an experiment's dishes share."""
    blocks, shape = _values_of(population)
    sums = group_sums(iter(blocks()), code, len(dishes), shape)
    squares = group_sums(iter(blocks()), code, len(dishes), shape, centre=sums.mean)
    scale = _spread_of_channels(squares.total, sums.count)
    degrees = np.maximum(sums.count - 1, 0)
    within = _mean_of(squares.total.sum(axis=0), degrees.sum(axis=0), scale)
    means = sums.mean / scale
    per_cell = np.nanmean(1.0 / np.where(sums.count > 0, sums.count, np.nan))
    condition = dishes[CONDITION].to_numpy()
    centred = means.copy()
    for one in np.unique(condition):
        centred[condition == one] -= np.nanmean(means[condition == one], axis=0)
    n = np.array([(condition == one).sum() for one in condition], dtype=np.float64)
    enough = n > 1
    between = np.nanmean(centred[enough] ** 2 * (n / (n - 1))[enough, None, None, None])
    unbiased = np.sqrt(n / np.maximum(n - 1, 1))
    pairs = [
        np.nanmean(centred[first] * centred[second]) * unbiased[first] * unbiased[second]
        for first, second in _same_experiment(dishes, enough)
    ]
    alike = float(np.mean(pairs)) if pairs else 0.0
    return within, max(float(between) - within * float(per_cell), 0.0), alike


def _values_of(population: Population) -> tuple[Callable[[], Iterable[Block]], tuple[int, ...]]:
    """Blocks of windows, and their shape; of cells without windows their scalars, each as a channel."""
    if population.channels:
        return population.blocks, population.raw.shape[1:]
    numbers = population.scalar_table().to_numpy(dtype=np.float64)[:, :, None, None]
    return lambda: [(slice(0, len(numbers)), numbers)], numbers.shape[1:]


def _spread_of_channels(total: FloatArray, count: FloatArray) -> FloatArray:
    """Standard deviation within dishes of each channel, so that a bright one does not count for more."""
    squares = np.nansum(total, axis=(0, 2, 3))
    degrees = np.maximum(count - 1, 0).sum(axis=(0, 2, 3))
    spread = np.sqrt(np.divide(squares, degrees, out=np.ones_like(squares), where=degrees > 0))
    return np.where(spread > 0, spread, 1.0)[:, None, None]


def _mean_of(squares: FloatArray, degrees: FloatArray, scale: FloatArray) -> float:
    known = degrees > 0
    if not known.any():
        raise PopulationError("power: no experiment has two cells of one condition: add cells")
    variance = np.divide(squares, degrees, out=np.full(squares.shape, np.nan), where=known) / scale**2
    return float(np.nanmean(variance))


def _same_experiment(dishes: pd.DataFrame, enough: np.ndarray) -> list[tuple[int, int]]:
    found = []
    for rows in dishes.groupby(EXPERIMENT).groups.values():
        some = [int(row) for row in rows if enough[int(row)]]
        found += [(first, second) for k, first in enumerate(some) for second in some[k + 1 :]]
    return found
