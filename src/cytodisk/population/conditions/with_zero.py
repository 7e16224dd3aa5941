"""`compare_with_zero`: one condition against nothing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import IntArray
from cytodisk.checks import instance_of
from cytodisk.errors import PopulationError
from cytodisk.population.comparison_parameters import PermutationParameters
from cytodisk.population.conditions.condition_comparison import chosen_channels
from cytodisk.population.conditions.experiment_units import checked_conditions
from cytodisk.population.conditions.tested_units import AgainstZero, unit_results
from cytodisk.population.conditions.unit_values import usable_cells
from cytodisk.population.group_columns import EXPERIMENT, codes_of, names_in
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL
from cytodisk.taking import takes


@dataclass(frozen=True, eq=False)
class ZeroComparison:
    """Where the mean of a condition is not 0.

    Attributes
    ----------
    condition : str
        Empty for all cells together.
    windows : Dataset with dims ([channel,] layer, last)
        `difference`: mean over experiments, with its 95 % interval `difference_low`, `difference_high`;
        `effect_size` (mean over sd of experiments) with `low`, `high`; `p`, `p_fwer`, `q`, `n_treated`,
        `cluster`, `status`, as in `ConditionComparison`.
    clusters, scalars : DataFrame
    experiments : tuple of str
    smallest_p : float
    sentences : tuple of str
    """

    condition: str
    windows: xr.Dataset
    clusters: pd.DataFrame
    scalars: pd.DataFrame
    experiments: tuple[str, ...]
    smallest_p: float
    sentences: tuple[str, ...]


@takes(PermutationParameters)
def compare_with_zero(
    pop: Population,
    condition: str | None = None,
    *,
    channel: str | Sequence[str] | None = None,
    parameters: PermutationParameters | None = None,
    **settings: Any,
) -> ZeroComparison:
    """Test whether the mean over experiments is 0, as that of correlations by chance is.

    Signs of whole experiments are exchanged.

    Parameters
    ----------
    pop : Population
    condition : str, optional
        By default all cells.
    channel : str or sequence of str, optional
        By default all.
    parameters : PermutationParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `PermutationParameters`.

    Returns
    -------
    ZeroComparison

    Raises
    ------
    PopulationError
        There is no such condition or channel, or experiments are unknown.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(experiments=6, seed=0)
    >>> found = cd.compare_with_zero(cd.Population(truth.values, truth.cells), "control")
    >>> found.smallest_p
    0.03125
    """
    instance_of("pop", pop, Population, "a Population")
    chosen = PermutationParameters.chosen(parameters, settings)
    channels = chosen_channels(pop, channel)
    use = usable_cells(pop, channels)
    if condition is not None:
        use &= (checked_conditions(pop.cells, [condition]) == condition).to_numpy()
    codes, names = experiment_codes(pop.cells, use)
    test = AgainstZero(len(names), chosen)
    found = unit_results(pop, channels, codes, len(names), test)
    p = test.exchanges.smallest_p
    different = found.windows["p_fwer"] <= LEVEL
    nameless = int((use & (codes < 0)).sum())
    left_out = f"{nameless} of {int(use.sum())} cells have no name of their experiment: they are not tested."
    words = (
        f"{len(names)} experiments can give p = {p:.2g} at best.",
        f"{int(different.sum())} of {different.size} windows differ from 0.",
        *([left_out] if nameless else []),
    )
    windows = found.windows.squeeze("channel") if len(channels) == 1 else found.windows
    windows = windows.drop_vars(["control", "n_control"])
    return ZeroComparison(condition or "", windows, found.clusters, found.scalars, names, p, words)


def experiment_codes(cells: pd.DataFrame, use: np.ndarray) -> tuple[IntArray, tuple[str, ...]]:
    """Number of the experiment of each cell that is used, -1 for others, and their names.

    Raises
    ------
    PopulationError
        No experiment is known.
    """
    experiment = names_in(cells, EXPERIMENT)
    codes, names = codes_of(experiment.where(pd.Series(use, index=experiment.index)))
    if not names:
        raise PopulationError(
            "experiments are unknown: add a column experiment with the name of the independent repetition "
            "(day, dish, animal) of each cell, as with --groups"
        )
    return codes, names
