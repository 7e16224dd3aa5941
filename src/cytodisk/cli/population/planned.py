"""A plan of experiments: what it is made for, and its table."""

import sys
import warnings
from pathlib import Path
from typing import TYPE_CHECKING

from cytodisk.cli.console import progress_bar
from cytodisk.cli.options import Given
from cytodisk.cli.population.power_words import plan_lines, say_power
from cytodisk.errors import ParameterError, PopulationWarning
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.runs.population.power.power_parameters import PowerParameters

if TYPE_CHECKING:
    import pandas as pd
    from rich.console import Console

    from cytodisk.population.population import Population

_OF_CELLS = ("compare", "channel", "summary", "normalise", "align")
"""Parameters of a comparison that a plan takes for the cells at hand."""


def planned(
    console: "Console", given: Given, paths: list[Path], is_kept: bool
) -> tuple["pd.DataFrame", list[str]]:
    """Say how many experiments find a difference of which size.

    Parameters
    ----------
    console : Console
    given : Given
    paths : list of Path
        Studies whose variance is taken; none for the defaults.
    is_kept : bool
        The table goes to a folder.

    Returns
    -------
    table : DataFrame
    notes : list of str
        What was assumed or measured.

    Raises
    ------
    ParameterError
        A flag is not for a plan.
    """
    from cytodisk.runs.population.power.population_power import plan_of, population_power

    known = {
        *PowerParameters.model_fields,
        *(_OF_CELLS if paths else ()),
        *(["overwrite"] if is_kept else ()),
    }
    beyond = [given.flags[name] for name in given.values if name not in known]
    beyond += ["--groups"] if given.groups and not paths else []
    if beyond:
        advice = "leave it out" if paths else "leave it out, or pass PATH if it is about your cells"
        raise ParameterError(f"{', '.join(beyond)}: not with --power; {advice}")
    settings = given.of(PowerParameters)
    population = _cells_at_hand(given, paths) if paths else None
    notes = plan_lines(plan_of(settings, population), settings)
    for note in notes:
        console.print(note)
    with progress_bar(console.quiet, "lines", stopped="Stopped.") as progress:
        table = population_power(population, progress=progress, parameters=settings)
    say_power(console, table)
    return table, notes


def _cells_at_hand(given: Given, paths: list[Path]) -> "Population":
    """The population whose variance a plan takes, of the conditions and channels that are asked for."""
    from cytodisk.runs.population.population_at_hand import population_at_hand

    values = {name: value for name, value in given.values.items() if name in _OF_CELLS}
    chosen = PopulationParameters.called(values, given.flags)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", PopulationWarning)
        population = population_at_hand(paths, given.groups, chosen)
    for one in caught:
        print(f"Warning: {one.message}", file=sys.stderr)
    return population
