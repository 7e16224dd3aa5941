"""`compare_conditions`: two conditions, tested over experiments."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd
import xarray as xr

from cytodisk.checks import instance_of
from cytodisk.population.comparison_parameters import ComparisonParameters
from cytodisk.population.conditions.comparison_sentences import (
    found_words,
    reach_words,
    valueless_words,
)
from cytodisk.population.conditions.comparison_warnings import (
    alignment_warnings,
    design_warnings,
    driven,
    of_shares,
    too_few,
    untested,
)
from cytodisk.population.conditions.experiment_units import units_of
from cytodisk.population.conditions.left_out import left_out_table
from cytodisk.population.conditions.tested_units import TwoConditions, unit_results
from cytodisk.population.conditions.unequal_spread import spread_warning
from cytodisk.population.conditions.unit_values import usable_cells
from cytodisk.population.named_warning import NamedWarning
from cytodisk.population.population import Population
from cytodisk.taking import takes


@dataclass(frozen=True, eq=False)
class ConditionComparison:
    """What two conditions differ in.

    Attributes
    ----------
    control, treated : str
        Names of the conditions; a difference is treated minus control.
    windows : Dataset with dims ([channel,] layer, sector)
        `control`, `treated`: means over experiments; `difference` with its 95 % interval `difference_low`,
        `difference_high`; `effect_size` (Hedges' g over experiments) with its 95 % interval `low`, `high`;
        `p` of the window alone; `p_fwer` for all windows together (max-T); `q` (false discovery rate);
        `n_control`, `n_treated` experiments with a value; `cluster` (0 for none); `status`, ok or why the
        window is not tested.
    clusters : DataFrame
        Neighbouring windows that differ together, the largest mass first: cluster, channel, sign, mass, p,
        n_windows, layers, sectors, difference.
    scalars : DataFrame
        One row for each scalar: its means, difference, effect size, intervals, p, p_fwer and q.
    left_out : DataFrame
        Results without one experiment at a time: result, experiment, difference_of_all, difference, p. The
        last is that of the number alone.
    units : DataFrame
        One row for each experiment and condition: experiment, condition, cells, used, reason.
    smallest_p : float
        The smallest p-value that this number of experiments can give.
    design : str
        paired or unpaired.
    sentences : tuple of str
        What can be reached, how the design was found, and what was found, in this order.
    warnings : tuple of NamedWarning
    """

    control: str
    treated: str
    windows: xr.Dataset
    clusters: pd.DataFrame
    scalars: pd.DataFrame
    left_out: pd.DataFrame
    units: pd.DataFrame
    smallest_p: float
    design: str
    sentences: tuple[str, ...]
    warnings: tuple[NamedWarning, ...]

    def __repr__(self) -> str:
        return f"<ConditionComparison {self.treated} against {self.control}: {' '.join(self.sentences)}>"


@takes(ComparisonParameters)
def compare_conditions(
    pop: Population,
    control: str,
    treated: str,
    *,
    channel: str | Sequence[str] | None = None,
    progress: Callable[[int, int], None] | None = None,
    parameters: ComparisonParameters | None = None,
    **settings: Any,
) -> ConditionComparison:
    """Compare two conditions window by window, in clusters of windows, and in scalars.

    Cells are averaged by experiment, and the labels of whole experiments are exchanged, because cells of one
    dish are not independent. All ways to exchange them are tried where there are few.

    Parameters
    ----------
    pop : Population
    control, treated : str
        Names of conditions.
    channel : str or sequence of str, optional
        By default all. Channels that are tested together are corrected together.
    progress : callable, optional
        Called with (exchanges done, exchanges in all).
    parameters : ComparisonParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `ComparisonParameters`.

    Returns
    -------
    ConditionComparison

    Raises
    ------
    PopulationError
        A condition or channel is not there, experiments are unknown, or the design does not fit.
    ParameterError
        A parameter is unknown or out of its range.

    See Also
    --------
    compare_with_control : Several conditions.
    dose_trend : An ordered dose.
    compare_with_zero : One condition against nothing.

    Notes
    -----
    max-T: Westfall & Young (1993), step-down. Clusters: Maris & Oostenveld (2007),
    doi:10.1016/j.jneumeth.2007.03.024.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.population(experiments=6, effect=3.0, seed=0)
    >>> pop = cd.Population(truth.values, truth.cells)
    >>> found = cd.compare_conditions(pop, "control", "drug")
    >>> found.design, round(found.smallest_p, 4)
    ('unpaired', 0.0022)
    """
    instance_of("pop", pop, Population, "a Population")
    chosen = ComparisonParameters.chosen(parameters, settings)
    channels = chosen_channels(pop, channel)
    usable = usable_cells(pop, channels)
    units = units_of(pop.cells, usable, (control, treated), chosen.unit, chosen.design)
    test = TwoConditions(units, chosen)
    found = unit_results(pop, channels, units.codes, units.count, test, progress)
    results = found.results if chosen.unit == "experiment" else {}
    left_out = left_out_table({name: number for name, (number, _) in results.items()}, units, chosen.seed)
    warnings = (
        *too_few(test.exchanges.smallest_p, units),
        *design_warnings(pop, units, chosen.unit),
        *alignment_warnings(pop, channels, units.codes),
        *spread_warning(found.values, units, (control, treated)),
        *of_shares(pop, found.windows),
        *untested(found.windows["status"].values),
        *driven(left_out, [name for name, (_, different) in results.items() if different]),
    )
    sentences = (
        reach_words(test.exchanges, units),
        units.found,
        *valueless_words(units),
        *found_words((control, treated), found.windows, found.clusters, found.scalars),
    )
    return ConditionComparison(
        control,
        treated,
        found.windows.squeeze("channel") if len(channels) == 1 else found.windows,
        found.clusters,
        found.scalars,
        left_out,
        units.table,
        test.exchanges.smallest_p,
        units.design,
        sentences,
        warnings,
    )


def chosen_channels(pop: Population, channel: str | Sequence[str] | None) -> tuple[str, ...]:
    """Channels by name, all by default.

    Raises
    ------
    PopulationError
        The population has no such channel.
    """
    if channel is None:
        return pop.channels
    names = (channel,) if isinstance(channel, str) else tuple(channel)
    for name in names:
        pop.channel_number(name)
    return tuple(dict.fromkeys(names))
