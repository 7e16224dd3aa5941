"""Do one thing with every movie of a batch, and note how each went."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import pandas as pd

from cytodisk.errors import CytodiskError
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.runs.population.opening.found_studies import FoundStudy
from cytodisk.runs.population.pooling.batch_movies import BatchMovies
from cytodisk.runs.population.pooling.pooled_population import Pooled
from cytodisk.runs.run_options import Progress
from cytodisk.runs.versions import installed
from cytodisk.store.study import Study, open_study
from cytodisk.store.tables import Columns

DONE, KEPT, REFUSED = "ok", "kept", "refused"
"""How a study went."""

_GROUP = ["input", "cell"]

Found = TypeVar("Found")
Doing = Callable[[Study, Progress | None], Found]
Keeping = Callable[[FoundStudy], Found | None]


def each_movie(
    movies: BatchMovies, do: Doing[Found], keep: Keeping[Found] | None, progress: Progress | None
) -> tuple[list[dict[str, Any]], list[tuple[FoundStudy, Found]]]:
    """Do something with each movie, or keep what is there.

    Parameters
    ----------
    movies : BatchMovies
    do : callable
        Called with the study, and what to report its steps to.
    keep : callable or None
        Called with the study first: what was done before in the same way, or None; raises `CytodiskError`
        where that is damaged. Without it all is done anew.
    progress : callable, optional
        Called with (percents done, 100 for each movie).

    Returns
    -------
    rows : list of dict
        input, status (ok, kept, refused or left out) and reason of each input of the batch.
    done : list of (FoundStudy, found)
        Those that went well.
    """
    rows, done = list(movies.left_out), []
    for place, study in enumerate(movies.studies):
        report = _share(progress, place, len(movies.studies))
        found, row = _one(study, do, keep, report)
        rows.append(row)
        if found is not None:
            done.append((study, found))
        if report is not None:
            report(1, 1)
    return rows, done


def _one(
    study: FoundStudy, do: Doing[Found], keep: Keeping[Found] | None, progress: Progress | None
) -> tuple[Found | None, dict[str, Any]]:
    row: dict[str, Any] = {"input": study.name, "status": DONE, "reason": ""}
    if keep is not None:
        try:
            if (there := keep(study)) is not None:
                return there, row | {"status": KEPT}
        except CytodiskError:  # damaged: it is made anew
            pass
    try:
        return do(open_study(study.folder), progress), row
    except CytodiskError as error:
        return None, row | {"status": REFUSED, "reason": str(error)}


def _share(progress: Progress | None, place: int, whole: int) -> Progress | None:
    """What to call with the steps of one study, to report percents of all."""
    if progress is None:
        return None
    return lambda done, steps: progress(100 * place + round(100 * done / max(steps, 1)), 100 * whole)


def made_alike(settings: dict[str, Any], wanted: dict[str, Any]) -> bool:
    """Whether what is there was made with the same settings, by this version, of all cells.

    Parameters
    ----------
    settings : dict
        Of what is there.
    wanted : dict
        Parameters that are asked for.

    Returns
    -------
    bool
    """
    asked = wanted | {"cytodisk": installed(("cytodisk",))["cytodisk"], "cells": None}
    return all(settings.get(name) == value for name, value in asked.items())


def of_input(table: pd.DataFrame, names: tuple[str, ...], name: str) -> pd.DataFrame:
    """Columns of a study's table, with the name of its input."""
    found = table.reindex(columns=list(names))
    found.attrs = {}
    found.insert(0, "input", name)
    return found


def with_groups_of(table: pd.DataFrame, groups: pd.DataFrame) -> pd.DataFrame:
    """The table with condition and experiment of each cell; a cell without a condition is left out."""
    found = table.merge(groups, on=_GROUP, how="left")
    if "status" in found:
        for name in (CONDITION, EXPERIMENT):
            unknown = found[name].fillna("") == ""
            if not unknown.all():
                left = unknown & (found["status"] == "ok")
                found.loc[left, ["status", "reason"]] = ["left out", f"it has no {name}"]
    return found.fillna({CONDITION: "", EXPERIMENT: ""})


def table_of_studies(rows: list[dict[str, Any]], cells: pd.DataFrame) -> pd.DataFrame:
    """A row for each input, with the number of its cells that are pooled."""
    counts = cells[cells["status"] == "ok"].groupby("input").size()
    table = pd.DataFrame(rows)
    return table.assign(cells=table["input"].map(counts).fillna(0).astype(int))


def pooled_settings(movies: BatchMovies, pooled: Pooled) -> dict[str, Any]:
    """What is said of pooled numbers, for their settings."""
    return {
        "sentences": [*pooled.sentences, *movies.remarks],
        "warnings": pooled.warnings,
        "cytodisk": installed(("cytodisk",))["cytodisk"],
    }


def in_order(table: pd.DataFrame, columns: Columns) -> pd.DataFrame:
    """The table with its columns in order, and their units."""
    found = table.reindex(columns=[column.name for column in columns])
    found.attrs = {"units": {column.name: column.unit for column in columns}}
    return found
