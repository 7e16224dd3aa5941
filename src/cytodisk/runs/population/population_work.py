"""What a run of `cytodisk population` computes, from the open population to its tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.errors import PopulationError
from cytodisk.population.cell_scalars import scalar_names
from cytodisk.population.conditions.with_control import smallest_corrected
from cytodisk.population.group_columns import CONDITION
from cytodisk.population.population import Population
from cytodisk.runs.population.cells_of_study import cells_of_study, more_columns, with_distances
from cytodisk.runs.population.compared import Compared, compared
from cytodisk.runs.population.comparison_rows import (
    comparison_row,
    comparison_tables,
    described_scalars,
    described_windows,
    experiment_table,
    trend_tables,
    untested_row,
)
from cytodisk.runs.population.conditions_compared import (
    ComparedConditions,
    chosen_cells,
    compared_conditions,
    with_conditions,
)
from cytodisk.runs.population.depth_profiles import depth_profiles
from cytodisk.runs.population.population_at_hand import of_channels, prepared
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.runs.population.typical_cells import distances_to_mean, gallery
from cytodisk.store.populations.population_study import SCALARS, StudyWarning
from cytodisk.store.populations.window_arrays import window_rows
from cytodisk.store.tables import Column

_SCALARS_DONE, _ATLAS_DONE, _COMPARED = 0.1, 0.3, 0.9  # shares of the work after opening
_BY_WINDOW = ("atlas", "windows", "trends", "gallery")
_SCALE = {"length_unit": "px", "pixel_size_um": None, "frame_interval_s": None}


@dataclass(frozen=True)
class PopulationResult:
    """All that a run writes.

    Attributes
    ----------
    tables : dict of str to DataFrame
        By the names of a population's tables.
    more : dict of str to Column
        Columns of cells beside those of every study.
    notes : dict
        For the provenance.
    """

    tables: dict[str, pd.DataFrame]
    more: dict[str, Column]
    notes: dict[str, Any] = field(default_factory=dict)


def population_result(
    opened: Population, parameters: PopulationParameters, step: Callable[[float], None]
) -> PopulationResult:
    """Normalise, align, average and compare a population.

    Parameters
    ----------
    opened : Population
    parameters : PopulationParameters
    step : callable
        Called with the share of the work that is done.

    Returns
    -------
    PopulationResult

    Raises
    ------
    PopulationError
        A condition, channel or direction is not there, or no cell is left.
    """
    chosen = compared_conditions(opened, parameters.compare, parameters.dose)
    whole = with_conditions(prepared(opened, parameters), chosen)
    left_out = chosen_cells(whole, chosen)
    used = (left_out == "").to_numpy()
    if not used.any():
        raise PopulationError(f"no cell is left ({left_out.value_counts().index[0]}): check --normalise")
    shown = of_channels(whole if used.all() else whole.select(used), parameters.channel)
    whole_scalars = whole.scalar_table()
    step(_SCALARS_DONE)
    atlas = shown.atlas()
    distances = distances_to_mean(shown, atlas)
    step(_ATLAS_DONE)
    tests = compared(
        shown, chosen, parameters, lambda share: step(_ATLAS_DONE + share * (_COMPARED - _ATLAS_DONE))
    )
    cells = with_distances(cells_of_study(whole, left_out, whole_scalars), used, distances)
    tables, more = _tables(shown, chosen, parameters, tests, atlas), more_columns(cells, whole)
    notes = _notes(shown, chosen, tests)
    if not tests.found and chosen.control:
        compared_ones = whole_scalars.loc[used, notes[SCALARS]]
        tables["scalars"] = described_scalars(
            compared_ones, shown.cells[CONDITION], chosen.control, chosen.treated
        )
    if len(tables["scalars"]):
        units = {name: column.unit for name, column in more.items()}
        tables["scalars"]["unit"] = tables["scalars"]["scalar"].map(units).fillna("")
    tables |= {
        "cells": cells,
        "gallery": _gallery(shown, distances, used),
        "profiles": depth_profiles(shown, whole_scalars[used].reset_index(drop=True)),
        "excluded": opened.excluded,
        "warnings": pd.DataFrame(tests.warnings, columns=list(StudyWarning._fields)),
    }
    for name in _BY_WINDOW:
        tables[name] = _with_compartments(tables[name], shown.compartments)
    step(1.0)
    scale = {name: opened.cells.attrs.get(name, unknown) for name, unknown in _SCALE.items()}
    return PopulationResult(tables, more, notes | scale)


def _with_compartments(table: pd.DataFrame, compartments: Sequence[str]) -> pd.DataFrame:
    """A table by window that says the compartment of each layer."""
    if "layer" not in table:
        return table
    return table.assign(compartment=np.array(compartments, dtype=object)[table["layer"]])


def _gallery(shown: Population, distances: Any, used: Any) -> pd.DataFrame:
    """With rows counted as in the table of cells."""
    table = gallery(shown, distances)
    return table.assign(row=np.flatnonzero(used)[table["row"]]) if len(table) else table


def _tables(
    shown: Population,
    chosen: ComparedConditions,
    parameters: PopulationParameters,
    tests: Compared,
    atlas: xr.Dataset,
) -> dict[str, pd.DataFrame]:
    channels, unit = shown.channels, parameters.unit
    smallest = smallest_corrected(tests.found)
    rows = [comparison_row(one, channels, unit, smallest[name]) for name, one in tests.found.items()]
    tables = comparison_tables(tests.found, chosen.control)
    if not tests.found and chosen.control:
        rows = [untested_row(name, chosen.control, channels, unit) for name in chosen.treated]
        tables["windows"] = described_windows(atlas, chosen.control, chosen.treated)
    ordered = atlas.sel({CONDITION: list(chosen.names)})
    return tables | {
        "atlas": window_rows(ordered) if atlas.sizes["layer"] else pd.DataFrame(),
        "comparisons": pd.DataFrame(rows),
        "experiments": experiment_table(tests.found, shown, tests.why),
        **trend_tables(tests.trend),
    }


def _notes(shown: Population, chosen: ComparedConditions, tests: Compared) -> dict[str, Any]:
    of_signal = scalar_names(shown.channels, shown.compartments, shown.last)
    lag = shown.raw.coords.get("lag")
    return {
        "curves": shown.last == "lag",
        "control": chosen.control,
        "conditions": list(chosen.names),
        "sentences": list(tests.sentences),
        SCALARS: list(dict.fromkeys([*of_signal, *shown.scalars])),
        "signal_unit": shown.units,
        "lag_unit": "" if lag is None else str(lag.attrs.get("units", "frames")),
    }
