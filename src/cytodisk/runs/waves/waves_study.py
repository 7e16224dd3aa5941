"""Look for waves in all cells of a movie's study, and write the tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError, StudyError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.qc_flags.wave_doubts import doubts_of
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.chosen_of_study import (
    check_frames,
    chosen_cells,
    refuse_velocity_channel,
)
from cytodisk.runs.used_series.progress_phases import percents
from cytodisk.runs.versions import installed
from cytodisk.runs.waves.cell_waves import CellWaves, with_whole_numbers
from cytodisk.runs.waves.disk_rows import NOT_INSIDE
from cytodisk.runs.waves.layer_waves import NO_WAVE
from cytodisk.runs.waves.wave_run_parameters import WavesParameters
from cytodisk.runs.waves.waves_columns import WAVE_TABLES
from cytodisk.store.study import Study
from cytodisk.store.tables import Columns, unit_of
from cytodisk.store.waves.waves_store import Waves, write_waves

_UNKNOWN = NO_WAVE | NOT_INSIDE | {"layer": None, "geometry_not_tested": ""}  # of a cell that is left out


def waves_study(
    study: Study,
    signal: str = "velocity",
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: WavesParameters | None = None,
    csv: bool = False,
    **settings: Any,
) -> Waves:
    """Look for waves of the edge's velocity, or of a signal, in all cells of a study, and write the tables.

    Parameters
    ----------
    study : Study
        Of a movie.
    signal : str
        "velocity", "velocity_cell_frame" or a channel of its tables.
    cells : list of int, optional
        All by default. A cell in which waves cannot be looked for has a row that says why.
    progress : callable, optional
        Called with (steps done, in all).
    csv : bool
        Write every table as CSV too.
    **settings
        Fields of `WavesParameters`.

    Returns
    -------
    Waves
        In STUDY/waves/SIGNAL, or SIGNAL~NAME, in place of an earlier one.

    Raises
    ------
    StudyError
        The study is not that of a movie.
    ParameterError
        There is no such signal (the message lists those there are), layer or cell, a setting is out of range,
        or waves could be looked for in no cell.
    """
    if not study.is_movie:
        raise StudyError(
            f"study {study.path} is not that of a movie: without time there are no waves; use cytodisk movie"
        )
    chosen = chosen_cells(study, cells)
    options = WavesParameters.chosen(parameters, settings)
    _check_signal(study, signal, options)
    check_frames(study, options)
    looking = CellWaves(study, signal, options)
    found: dict[str, list[pd.DataFrame]] = {}
    rows = []
    for place, cell in enumerate(chosen):
        try:
            tables, row = looking.of(cell, percents(progress, place, len(chosen)))
        except ParameterError as error:
            tables, row = {}, {"status": "refused", "reason": str(error)}
        rows.append({"cell": cell} | _UNKNOWN | row)
        for name, table in tables.items():
            table.insert(0, "cell", cell)
            found.setdefault(name, []).append(table)
    if not found:
        raise ParameterError(f"waves cannot be looked for in any cell of {study.path}: {rows[0]['reason']}")
    tables = {name: pd.concat(parts, ignore_index=True) for name, parts in found.items()}
    content = _content(options, chosen if cells else None)
    tables["cells"] = _cell_table(rows)
    ordered = {
        name: _in_order(study, tables[name], columns)
        for name, columns in WAVE_TABLES.items()
        if name in tables
    }
    return write_waves(study.path, signal, ordered, WAVE_TABLES, content, options.name, csv)


def _check_signal(study: Study, signal: str, options: WavesParameters) -> None:
    activity = study.activity(int(study.cells["cell"].iloc[0]))
    names = [str(name) for name in activity["channel"].to_numpy()] if "mean" in activity else []
    refuse_velocity_channel(names)
    if signal in VELOCITIES:
        if options.layer:
            raise ParameterError(
                f"layer {options.layer} is given, but {signal} is that of the edge alone: pass a channel as "
                "signal, or leave layer out"
            )
        return
    if signal not in names:
        raise ParameterError(
            f"signal {signal!r} is not in the study: it has {', '.join(map(repr, (*VELOCITIES, *names)))}"
        )


def _content(options: WavesParameters, cells: list[int] | None) -> dict[str, Any]:
    """The settings as they are written."""
    content: dict[str, Any] = options.model_dump(mode="json") | {"cells": cells}
    content["given"] = options.model_dump(mode="json", exclude_defaults=True)
    content["surrogates_made"] = options.surrogates
    content["cytodisk"] = installed(("cytodisk",))["cytodisk"]
    return content


def _cell_table(rows: list[dict[str, Any]]) -> pd.DataFrame:
    """A row a cell, with the names of the QC flags of its wave."""
    table = with_whole_numbers(pd.DataFrame(rows))
    table["qc_flags"] = ["; ".join(doubts_of(row)) for row in rows]
    return table


def _in_order(study: Study, table: pd.DataFrame, columns: Columns) -> pd.DataFrame:
    """A table with its columns in the order in which they are told, and their units."""
    known = {name: str(study.provenance.get(name, "")) for name in ("length_unit", "velocity_unit")}
    found = table[[column.name for column in columns if column.name in table]].copy()
    found.attrs = {
        "units": {
            column.name: unit_of(column, known["length_unit"], known["velocity_unit"])
            for column in columns
            if column.name in table
        }
    }
    return found
