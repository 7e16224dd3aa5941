"""`cytodisk population`."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cytodisk.cli.console import console_for, progress_bar
from cytodisk.cli.options import Given, Quiet, with_parameters
from cytodisk.cli.population.population_words import say_population
from cytodisk.cli.population.power_words import say_plan, say_power
from cytodisk.errors import ParameterError
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.runs.population.power.power_parameters import PowerParameters
from cytodisk.runs.run_options import FolderOptions

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.population.population import Population

_OF_CELLS = ("compare", "channel", "summary", "normalise", "align")
"""Parameters of a comparison that a plan takes for the cells at hand."""


@with_parameters(PopulationParameters, FolderOptions, modes={"--power": PowerParameters})
def population_command(
    given: Given,
    paths: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="PATH",
            help="Folder that cytodisk batch, map, movie or shapes wrote, or a folder of such studies; "
            "several are put together.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FOLDER", help="Folder for the results.", show_default=False),
    ] = None,
    groups: Annotated[
        Path | None,
        typer.Option(
            metavar="TABLE",
            help="Table (CSV) with the columns file or cell, condition and experiment, and any others: what "
            "was done to which cell.",
        ),
    ] = None,
    power: Annotated[
        bool, typer.Option("--power", help="Plan: how many experiments find a difference of which size.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    console = console_for(quiet)
    if power:
        _plan(console, given, paths or [], out, groups)
        return
    if beyond := given.beyond(PopulationParameters, FolderOptions):
        raise ParameterError(f"{', '.join(beyond)}: only with --power; pass that too, or leave it out")
    if not paths:
        raise ParameterError(
            "PATH is missing: pass the folder that cytodisk batch, map, movie or shapes wrote"
        )
    if out is None:
        raise ParameterError("--out is missing: name a folder for the results, as -o atlas/")
    _compare(console, given, paths, out, groups)


def _compare(console: "Console", given: Given, paths: list[Path], out: Path, groups: Path | None) -> None:
    from cytodisk.runs.population.run_population import run_population

    settings, options = given.of(PopulationParameters), given.options(FolderOptions)
    with progress_bar(console.quiet, "percent", stopped=_STOPPED) as progress:
        study = run_population(
            paths, out, groups=groups, progress=progress, parameters=settings, **dict(options)
        )
    say_population(console, study)


_STOPPED = "Stopped; the results are not complete: run it again with --resume."


def _plan(console: "Console", given: Given, paths: list[Path], out: Path | None, groups: Path | None) -> None:
    """Say how many experiments find a difference of which size."""
    from cytodisk.runs.population.power.population_power import plan_of, population_power

    known = {*PowerParameters.model_fields, *(_OF_CELLS if paths else ())}
    beyond = [given.flags[name] for name in given.values if name not in known]
    beyond += [flag for flag, value in (("--out", out), ("--groups", None if paths else groups)) if value]
    if beyond:
        advice = "leave it out" if paths else "leave it out, or pass PATH if it is about your cells"
        raise ParameterError(f"{', '.join(beyond)}: not with --power; {advice}")
    settings = given.of(PowerParameters)
    population = _cells_at_hand(given, paths, groups) if paths else None
    say_plan(console, plan_of(settings, population), settings)
    with progress_bar(console.quiet, "lines", stopped="Stopped.") as progress:
        table = population_power(population, progress=progress, parameters=settings)
    say_power(console, table)


def _cells_at_hand(given: Given, paths: list[Path], groups: Path | None) -> "Population":
    """The population whose variance a plan takes, of the conditions and channels that are asked for."""
    import warnings

    from cytodisk.errors import PopulationWarning
    from cytodisk.runs.population.population_at_hand import population_at_hand

    values = {name: value for name, value in given.values.items() if name in _OF_CELLS}
    chosen = PopulationParameters.called(values, given.flags)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", PopulationWarning)
        population = population_at_hand(paths, groups, chosen)
    for one in caught:
        print(f"Warning: {one.message}", file=sys.stderr)
    return population
