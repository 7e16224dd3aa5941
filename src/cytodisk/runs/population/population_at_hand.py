"""The population of a run: opened, normalised, aligned, with the channels that are asked for."""

from __future__ import annotations

import os
from dataclasses import replace

from cytodisk.errors import PopulationError
from cytodisk.population.cell_directions import SIGNAL
from cytodisk.population.population import Population
from cytodisk.runs.population.conditions_compared import (
    chosen_cells,
    compared_conditions,
    with_conditions,
)
from cytodisk.runs.population.opening.found_studies import Paths
from cytodisk.runs.population.opening.open_population import open_population
from cytodisk.runs.population.population_parameters import PopulationParameters


def opened_population(
    path: Paths, groups: str | os.PathLike[str] | None, chosen: PopulationParameters
) -> Population:
    """Read the studies, with the channels that are compared and the one that cells are aligned by.

    Parameters
    ----------
    path : path-like, or sequence of path-like
    groups : path-like or None
    chosen : PopulationParameters

    Returns
    -------
    Population

    Raises
    ------
    PopulationError, ReadError
        See `open_population`.
    """
    channels = list(chosen.channel)
    if channels and chosen.align.startswith(SIGNAL):
        channels.append(chosen.align.removeprefix(SIGNAL))
    return open_population(
        path,
        summary=chosen.summary,
        channels=list(dict.fromkeys(channels)) or None,
        groups=groups,
        scalars=chosen.scalars or None,
    )


def prepared(population: Population, chosen: PopulationParameters) -> Population:
    """The population, normalised and aligned as asked for."""
    given = [name for name in ("normalise", "align") if getattr(chosen, name) != "none"]
    if given and not population.channels:
        raise PopulationError(f"{given[0]}: these cells have no windows: leave --{given[0]} out")
    if chosen.normalise != "none":
        population = population.normalise(chosen.normalise)
    return population.align(chosen.align) if chosen.align != "none" else population


def of_channels(population: Population, channels: tuple[str, ...]) -> Population:
    """The population without channels that were read for the alignment alone."""
    if not channels or channels == population.channels:
        return population
    at = [population.channel_number(name) for name in channels]
    scaling = population.scaling
    levels = {name: getattr(scaling, name)[:, at] for name in ("background", "centre", "factor")}
    return population.changed(raw=population.raw.isel(channel=at), scaling=replace(scaling, **levels))


def population_at_hand(
    path: Paths, groups: str | os.PathLike[str] | None, chosen: PopulationParameters
) -> Population:
    """The cells that a comparison would use.

    Parameters
    ----------
    path : path-like, or sequence of path-like
    groups : path-like or None
    chosen : PopulationParameters

    Returns
    -------
    Population

    Raises
    ------
    PopulationError, ReadError
        See `run_population`.
    """
    opened = opened_population(path, groups, chosen)
    conditions = compared_conditions(opened, chosen.compare, chosen.dose)
    whole = with_conditions(prepared(opened, chosen), conditions)
    used = (chosen_cells(whole, conditions) == "").to_numpy()
    return of_channels(whole if used.all() else whole.select(used), chosen.channel)
