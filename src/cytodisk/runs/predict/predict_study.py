"""Test which signals of a movie's study predict which, cell by cell, and write the tables."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.flagged_cells import prediction_flags_by_cell
from cytodisk.runs.predict.pooled_links import pooled_table
from cytodisk.runs.predict.predict_cell import CellPrediction, PredictedCell
from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.predict.prediction_columns import PREDICTION_TABLES
from cytodisk.runs.qc_flags.one_prediction import UnwrittenPrediction
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
from cytodisk.store.predictions.prediction_store import Prediction, write_prediction
from cytodisk.store.study import Study

VELOCITY = VELOCITIES[0]
_FEWEST_PAIRS = 10  # of frames, that a geometry's lag leaves


def predict_study(
    study: Study,
    source: str | None = None,
    target: str | None = None,
    *,
    cells: list[int] | None = None,
    progress: Progress | None = None,
    parameters: PredictParameters | None = None,
    csv: bool = False,
    **settings: Any,
) -> Prediction:
    """Test whether signals predict each other in all cells of a study, and write the tables.

    Parameters
    ----------
    study : Study
        Study of a movie.
    source, target : str, optional
        Two of the channels and velocity, tested in both directions; without both, all of them against each
        other.
    cells : list of int, optional
        All by default. A cell in which nothing can be tested has a row in the table of cells that says why.
    progress : callable, optional
        Called with (steps done, in all).
    csv : bool
        Write every table as CSV too.
    **settings
        Fields of `PredictParameters`.

    Returns
    -------
    Prediction
        In STUDY/prediction/SOURCE~TARGET or STUDY/prediction/network, in place of an earlier one.

    Raises
    ------
    StudyError
        The study is not that of a movie, or has no signal.
    ParameterError
        There is no such signal or cell, a setting is out of range, or no cell could be tested.
    """
    chosen = chosen_cells(study, cells)
    options = PredictParameters.chosen(parameters, settings)
    channels = channels_of(study)
    refuse_velocity_channel(channels)
    tested = _tested(channels, source, target)
    names = _with_given(tested, channels, options.given)
    check_frames(study, options)
    network = source is None
    lag = max(options.max_order, usual_lag(study, chosen, _FEWEST_PAIRS))
    predicting = CellPrediction(study, tested, names, network, lag, options)
    found: dict[int, PredictedCell] = {}
    rows = []
    for place, cell in enumerate(chosen):
        try:
            found[cell] = predicting.of(cell, percents(progress, place, len(chosen)))
            rows.append({"cell": cell} | found[cell].row)
        except ParameterError as error:
            rows.append({"cell": cell, "status": "refused", "reason": str(error)})
    if not found:
        raise ParameterError(f"no cell of {study.path} can be tested: {rows[0]['reason']}")
    left = [name for name in (*channels, VELOCITY) if name not in names]
    tables = _tables(found, rows, options)
    tables["cells"]["not_given"] = ", ".join(_others(left, names))
    content: dict[str, Any] = options.model_dump() | {"cells": chosen if cells else None}
    content |= {"signals": list(tested), "lab_lag": lag}
    content["asked"] = options.model_dump(mode="json", exclude_defaults=True)
    content["cytodisk"] = installed(("cytodisk",))["cytodisk"]
    three = (source or "", target or "", options.name)
    tables["cells"]["qc_flags"] = prediction_flags_by_cell(
        study, UnwrittenPrediction(study.path, *three, content, tables)
    )
    tables = {name: with_units(table, name) for name, table in tables.items()}
    return write_prediction(study.path, three, tables, PREDICTION_TABLES, content, csv)


def with_units(table: pd.DataFrame, name: str) -> pd.DataFrame:
    """A table with its columns in order, and their units."""
    columns = [column for column in PREDICTION_TABLES[name] if column.name in table]
    ordered: pd.DataFrame = table[[column.name for column in columns]].copy()
    ordered.attrs = {"units": {column.name: column.unit for column in columns}}
    return ordered


def _tables(
    found: dict[int, PredictedCell], rows: list[dict[str, Any]], options: PredictParameters
) -> dict[str, pd.DataFrame]:
    def under(name: str) -> pd.DataFrame:
        parts: list[pd.DataFrame] = [getattr(one, name).assign(cell=cell) for cell, one in found.items()]
        return pd.concat([part for part in parts if len(part)], ignore_index=True)

    cells = pd.DataFrame(rows)
    for name in ("frames", "gaps", "surrogates", "restarts"):
        cells[name] = cells[name].astype("Int64")
    cells["geometry_not_tested"] = cells["geometry_not_tested"].fillna("")
    links = [link for one in found.values() for link in one.tested]
    return {
        "links": under("links"),
        "lags": under("lags"),
        "pooled": pooled_table(links, options.seed),
        "cells": cells,
    }


def _tested(channels: list[str], source: str | None, target: str | None) -> tuple[str, ...]:
    """Names of what is tested against each other."""
    known = (*channels, *VELOCITIES)
    listed = f"it has {', '.join(VELOCITIES)} and the signals {', '.join(map(repr, channels))}"
    if (source is None) != (target is None):
        missing, there = ("source", target) if source is None else ("target", source)
        raise ParameterError(
            f"{missing} is not given, only {there!r}: pass both, or none for a network of all signals"
        )
    if source is None or target is None:
        return (*channels, VELOCITY)
    for role, name in (("source", source), ("target", target)):
        if name not in known:
            raise ParameterError(f"{role} {name!r} is not in the study: {listed}")
    if source == target:
        raise ParameterError(f"source and target are both {source!r}: pass two signals")
    if {source, target} <= set(VELOCITIES):
        raise ParameterError(f"source and target are both velocities of the edge: pass one of {channels}")
    return (source, target)


def _with_given(
    tested: tuple[str, ...], channels: list[str], given: tuple[str, ...] | None
) -> tuple[str, ...]:
    """Names of what is tested, and of what is given, too."""
    known = (*channels, *VELOCITIES)
    for number, name in enumerate(given or ()):
        if name not in known:
            raise ParameterError(f"given {name!r} is not in the study: there is {', '.join(known)}")
        if name in (given or ())[:number]:
            raise ParameterError(f"given names {name!r} twice: name each signal once")
        if len(tested) == 2 and name in tested:
            raise ParameterError(f"given {name!r} is source or target: name another signal")
    return tuple(dict.fromkeys((*tested, *(given or ()))))


def _others(left: list[str], names: tuple[str, ...]) -> list[str]:
    """Signals that were left out; of two velocities one is enough."""
    return [name for name in left if name not in VELOCITIES or not set(VELOCITIES) & set(names)]
