"""Write the page of each study of a batch, and a page that lists them."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd

from cytodisk.errors import CytodiskError, MissingPartError, StudyError
from cytodisk.pages.report.page import REPORT, write_report
from cytodisk.pages.report.template import jinja
from cytodisk.runs.population.opening.found_studies import FoundStudy, find_studies
from cytodisk.store.provenance_file import read_provenance
from cytodisk.store.results.study_results import DERIVED
from cytodisk.store.study import open_study
from cytodisk.store.study_kind import CELLS
from cytodisk.store.tables import read_table
from cytodisk.store.written_files import lost_files, recorded

OK, KEPT, REFUSED, NO_STUDY = "ok", "kept", "refused", "no study"
_FROM_INPUTS = ("kind", "cells", "frames", "flags")

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class BatchReports:
    """Pages of a batch.

    Attributes
    ----------
    folder : Path
        Of the batch.
    table : DataFrame
        One row an input: input; page, its path from the folder, empty if there is none; kind; status ("ok",
        "kept", "refused", "no study"); reason; cells, frames and flags of its study; the user's columns.
    """

    folder: Path
    table: pd.DataFrame

    @property
    def failed(self) -> pd.DataFrame:
        """Rows of inputs without a page."""
        return self.table[self.table["page"] == ""]


def write_batch_reports(
    folder: str | os.PathLike[str], *, resume: bool = False, progress: Progress | None = None
) -> BatchReports:
    """Write the page of each study in a batch folder.

    Parameters
    ----------
    folder : path-like
        That `cytodisk batch` wrote.
    resume : bool
        Keep pages that are younger than their study and its correlations.
    progress : callable, optional
        Called with (studies done, in all).

    Returns
    -------
    BatchReports
        An input without a page has a row that says why.

    Raises
    ------
    PopulationError
        The folder holds no batch.
    StudyError
        No page could be written.
    MissingPartError
        Jinja2 is not installed.
    """
    jinja()  # before any work is done
    place = Path(folder)
    studies, without = find_studies(place)
    report = progress or (lambda done, whole: None)
    report(0, len(studies))
    rows = []
    for done, study in enumerate(studies, 1):
        rows.append(_page_of(study, place, resume))
        report(done, len(studies))
    rows += [
        {"input": row["input"], "page": "", "status": NO_STUDY, "reason": row["reason"]}
        for row in without.rows
    ]
    table = _with_inputs(pd.DataFrame(rows), place)
    if not (table["page"] != "").any():
        raise StudyError(f"no input of {place} has a page: {table['reason'].iloc[0]}")
    return BatchReports(place, table)


def _page_of(study: FoundStudy, folder: Path, resume: bool) -> dict[str, Any]:
    """Write the page of a study, or keep that which is there."""
    row: dict[str, Any] = {"input": study.name, "page": "", "status": OK, "reason": ""}
    page = study.folder / REPORT
    try:
        if resume and _is_young(study.folder):
            row["status"] = KEPT
        else:
            page = write_report(open_study(study.folder))
    except MissingPartError:
        raise
    except CytodiskError as error:
        return row | {"status": REFUSED, "reason": str(error)}
    return row | {"page": page.relative_to(folder).as_posix()}


def _is_young(study: Path) -> bool:
    """Whether a study's page is whole, and written after its tables and what was computed from them."""
    own = {REPORT: recorded(read_provenance(study) or {}).get(REPORT, "")}
    if not own[REPORT] or lost_files(study, own):
        return False
    settings = [file for folder in DERIVED for file in (study / folder).glob("*/settings.json")]
    sources = [study / CELLS, *settings]
    written = (study / REPORT).stat().st_mtime_ns
    return all(file.stat().st_mtime_ns <= written for file in sources)


def _with_inputs(table: pd.DataFrame, folder: Path) -> pd.DataFrame:
    """The rows with what the batch knows of each input, in the order of the batch file."""
    inputs = read_table(folder / "inputs.parquet")
    own = [str(name) for name in (read_provenance(folder) or {}).get("columns", []) if name in inputs]
    known = inputs[["input", *(name for name in (*_FROM_INPUTS, *own) if name in inputs)]]
    joined = known.merge(table, on="input", how="left").fillna({"page": "", "status": NO_STUDY, "reason": ""})
    first = ["input", "page", "kind", "status", "reason"]
    return joined[[*first, *(name for name in joined if name not in first)]]
