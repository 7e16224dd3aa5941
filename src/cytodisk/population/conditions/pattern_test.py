"""`pattern_test`: is there a pattern around the cell with respect to its direction?"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.checks import instance_of
from cytodisk.errors import PopulationError
from cytodisk.population.cell_directions import SIGNAL
from cytodisk.population.comparison_parameters import PermutationParameters
from cytodisk.population.conditions.comparison_tables import cluster_table, window_dataset
from cytodisk.population.conditions.condition_comparison import chosen_channels
from cytodisk.population.conditions.experiment_units import checked_conditions
from cytodisk.population.conditions.unit_values import usable_cells, window_means
from cytodisk.population.exchange.exchange_test import exchange_test
from cytodisk.population.exchange.turns import TurnedPattern, TurnExchanges
from cytodisk.population.exchange.window_neighbours import ClusterField
from cytodisk.population.group_columns import EXPERIMENT, codes_of, names_in
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL
from cytodisk.taking import takes


@dataclass(frozen=True, eq=False)
class PatternTest:
    """Where aligned cells differ from the mean of their layer.

    Attributes
    ----------
    windows : Dataset with dims ([channel,] layer, sector)
        `difference` of the window from the mean of its layer, mean over experiments; `p`, `p_fwer`, `q`,
        `cluster` and `status`, as in `ConditionComparison`.
    clusters : DataFrame
    cells : int
        Number of cells with a direction, which were used.
    experiments : tuple of str
        Empty where they are unknown.
    smallest_p : float
        The smallest p-value that so many experiments can give.
    sentences : tuple of str
    """

    windows: xr.Dataset
    clusters: pd.DataFrame
    cells: int
    experiments: tuple[str, ...]
    smallest_p: float
    sentences: tuple[str, ...]


@takes(PermutationParameters)
def pattern_test(
    pop: Population,
    condition: str | None = None,
    *,
    channel: str | Sequence[str] | None = None,
    parameters: PermutationParameters | None = None,
    **settings: Any,
) -> PatternTest:
    """Test whether a signal has a place with respect to the direction that cells are aligned by.

    Cells are averaged by experiment, and each experiment is turned at random, which keeps its own pattern and
    undoes its direction: a pattern must lie at the same place in all of them. Where experiments are unknown,
    each cell is turned, as if all were independent. Cells without a direction are left out.

    Parameters
    ----------
    pop : Population
        Aligned by nucleus, front, motion, axis or a signal.
    condition : str, optional
        By default all cells.
    channel : str or sequence of str, optional
        By default all but the one that cells are aligned by.
    parameters : PermutationParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `PermutationParameters`.

    Returns
    -------
    PatternTest

    Raises
    ------
    PopulationError
        Cells are not aligned, or by the signal that is tested: turned and aligned again it would come out the
        same, so no test can be made.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(effect=0.0, seed=0)
    >>> pop = cd.Population(truth.values, truth.cells).align("nucleus")
    >>> found = cd.pattern_test(pop, permutations=199)
    >>> bool((found.windows["p_fwer"] > 0.05).all())
    True
    """
    instance_of("pop", pop, Population, "a Population")
    chosen = PermutationParameters.chosen(parameters, settings)
    if pop.aligned_by == "none":
        raise PopulationError("pattern_test: cells are not aligned: call align first, as align('nucleus')")
    own = pop.aligned_by.removeprefix(SIGNAL) if pop.aligned_by.startswith(SIGNAL) else ""
    channels = chosen_channels(pop, channel)
    channels = tuple(name for name in channels if name != own or channel is not None)
    if own in channels or not channels:
        raise PopulationError(
            f"pattern_test: cells are aligned by {own}: turned at random and aligned by it again, it comes "
            "out the same, so its pattern cannot be tested; test another channel, or align by something else"
        )
    use = usable_cells(pop, channels) & (pop.alignment["status"] == "ok").to_numpy()
    if condition is not None:
        use &= (checked_conditions(pop.cells, [condition]) == condition).to_numpy()
    codes, names = codes_of(names_in(pop.cells, EXPERIMENT).where(pd.Series(use, index=pop.cells.index)))
    use &= (codes >= 0) | (not names)
    units, what = (len(names), "experiments") if names else (int(use.sum()), "cells")
    if units < 2:
        raise PopulationError(f"pattern_test: {units} of the {what} has a direction and values: 2 are needed")
    cells = pop.select(use)
    values = window_means(cells, channels, codes[use] if names else np.arange(units), units)
    layers, sectors = pop.raw.shape[2:]
    statistic = TurnedPattern(values.reshape(units, -1, sectors), np.full(units, 1.0 / units))
    exchanges = TurnExchanges(units, sectors, chosen.permutations, chosen.seed)
    field = ClusterField((len(channels), layers, sectors), closed=True)
    tested = exchange_test(statistic, exchanges, field)
    difference = statistic.means()
    windows = window_dataset(pop, channels, {"difference": difference}, tested)
    clusters = cluster_table(pop, channels, difference, tested)
    different = int((tested.p_fwer <= LEVEL).sum())
    by_cell = (
        "" if names else " Experiments are unknown: cells are treated as independent, which they are not."
    )
    words = (
        f"{units} {what}{f' with {len(cells)} cells' if names else ''} were turned at random "
        f"{chosen.permutations} times: they can give p = {exchanges.smallest_p:.2g} at best.{by_cell}",
        f"{different} of {len(difference)} windows differ from the mean of their layer "
        f"(max-T, p ≤ {LEVEL:g}).",
    )
    windows = windows.squeeze("channel") if len(channels) == 1 else windows
    return PatternTest(windows, clusters, len(cells), names, exchanges.smallest_p, words)
