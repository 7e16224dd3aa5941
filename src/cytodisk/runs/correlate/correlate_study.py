"""Correlate signals of a movie's study with the motion of the edge, or with each other, cell by cell."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.correlate_cell import CellCorrelation
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.correlation_columns import CORRELATION_TABLES
from cytodisk.runs.correlate.correlation_tables import merged, of_cell
from cytodisk.runs.flagged_cells import flags_by_cell
from cytodisk.runs.qc_flags.one_correlation import UnwrittenCorrelation
from cytodisk.runs.run_options import Progress
from cytodisk.runs.used_series.chosen_of_study import (
    channels_of,
    check_frames,
    chosen_cells,
    refuse_velocity_channel,
    usual_lag,
)
from cytodisk.runs.used_series.progress_phases import percents
from cytodisk.runs.versions import installed
from cytodisk.store.correlation_store import Correlation, write_correlation
from cytodisk.store.study import Study


def correlate_study(
    study: Study,
    signal: str,
    with_: str = "velocity",
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: CorrelateParameters | None = None,
    csv: bool = False,
    **settings: Any,
) -> Correlation:
    """Correlate a signal with edge velocity or another signal in all cells of a study, and write the tables.

    Parameters
    ----------
    study : Study
        Study of a movie.
    signal : str
        A channel of its tables.
    with_ : str
        "velocity", "velocity_cell_frame" or a channel. At a positive lag it follows `signal`.
    cells : list of int, optional
        All by default. A cell that cannot be correlated has a row in the table of cells that says why.
    progress : callable, optional
        Called with (steps done, in all).
    csv : bool
        Write every table as CSV too.
    **settings
        Fields of `CorrelateParameters`: max_lag, against, rule, detrend, difference, surrogates, and others.

    Returns
    -------
    Correlation
        In STUDY/correlation/SIGNAL~WITH, or SIGNAL~WITH~NAME, in place of an earlier one.

    Raises
    ------
    StudyError
        The study is not that of a movie, or has no signal.
    ParameterError
        There is no such signal (the message lists those there are) or cell, a setting is out of range, or no
        cell could be correlated.
    """
    chosen = chosen_cells(study, cells)
    options = CorrelateParameters.chosen(parameters, settings)
    names = channels_of(study)
    _check_names(names, signal, with_, options)
    check_frames(study, options)
    max_lag = options.max_lag if options.max_lag is not None else usual_lag(study, chosen, options.min_pairs)
    correlating = CellCorrelation(study, signal, with_, max_lag, options)
    found: dict[str, list[pd.DataFrame]] = {}
    rows = []
    for place, cell in enumerate(chosen):
        try:
            tables, row = correlating.of(cell, percents(progress, place, len(chosen)))
        except ParameterError as error:
            tables, row = {}, {"status": "refused", "reason": str(error)}
        rows.append({"cell": cell} | row)
        for name, table in tables.items():
            found.setdefault(name, []).append(of_cell(table, cell))
    if not found:
        raise ParameterError(f"no cell of {study.path} can be correlated: {rows[0]['reason']}")
    tables = {name: merged(parts) for name, parts in found.items()} | {"cells": pd.DataFrame(rows)}
    content: dict[str, Any] = options.model_dump() | {"max_lag": max_lag, "cells": chosen if cells else None}
    content["given"] = options.model_dump(mode="json", exclude_defaults=True)
    content["surrogates_made"] = max(int(row.get("surrogates", 0)) for row in rows)
    content["pair_surrogates"] = max(int(row.get("pair_surrogates", 0)) for row in rows)
    content["cytodisk"] = installed(("cytodisk",))["cytodisk"]
    tables["cells"]["qc_flags"] = flags_by_cell(
        study, UnwrittenCorrelation(study.path, signal, with_, options.name, content, tables)
    )
    return write_correlation(
        study.path, signal, with_, tables, CORRELATION_TABLES, content, options.name, csv
    )


def _check_names(names: list[str], signal: str, with_: str, options: CorrelateParameters) -> None:
    refuse_velocity_channel(names)
    listed = ", ".join(repr(name) for name in names)
    if signal not in names:
        raise ParameterError(f"signal {signal!r} is not in the study: it has {listed}")
    if with_ not in (*names, *VELOCITIES):
        raise ParameterError(
            f"with {with_!r} is not in the study: it has {', '.join(VELOCITIES)} and the signals {listed}"
        )
    if with_ == signal and options.against == "window":
        raise ParameterError(
            f"signal {signal!r} with itself in the same window is 1: pass against 'edge' to compare it "
            "with that of the outermost layer"
        )
    for number, name in enumerate(options.control):
        if name in options.control[:number]:
            raise ParameterError(f"control names {name!r} twice: name each channel once")
        if name in (signal, with_):
            raise ParameterError(
                f"control {name!r} is one of the two that are correlated: name another channel"
            )
        if name not in names:
            others = ", ".join(repr(other) for other in names if other not in (signal, with_)) or "none"
            raise ParameterError(f"control {name!r} is no other channel of the study: there is {others}")
    if options.pairs and with_ in VELOCITIES:
        raise ParameterError(
            "pairs need two signals: velocity has no windows inside; pass with another signal"
        )
