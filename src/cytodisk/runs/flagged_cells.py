"""QC flags in the tables: their names stand in the rows of the cells and frames that they name."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.parquet as pq

from cytodisk.files import replacing
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.merging import repeating
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study
from cytodisk.store.study_folder import StudyFolder
from cytodisk.store.study_kind import CELLS
from cytodisk.store.tables import read_table

if TYPE_CHECKING:
    from cytodisk.runs.groups.given_groups import GivenGroups
    from cytodisk.runs.qc_flags.qc_flag import QCFlag

_FLAGS, _REMARKS = "qc_flags", "mask_remarks"


def fill_cells(folder: StudyFolder, groups: GivenGroups | None = None) -> None:
    """Write what is known when all cells are done into the table of cells: groups and QC flags.

    Parameters
    ----------
    folder : StudyFolder
        All tables stand.
    groups : GivenGroups, optional
    """
    if groups is not None:
        groups.fill(folder)
    fill_flags(folder)


def fill_flags(folder: StudyFolder) -> None:
    """Write the names of the QC flags of a run into its table of cells.

    Parameters
    ----------
    folder : StudyFolder
        All tables stand; flags that were there are replaced.
    """
    from cytodisk.runs.qc_flags.study_flags import run_flags

    path = folder.path / CELLS
    study = Study(folder.path, read_table(path), folder.provenance)
    cells = study.cells
    names = names_by_row(run_flags(study), zip(cells["cell"], cells["frame"], strict=True))
    words = [
        "; ".join(filter(None, [named, remarks]))
        for named, remarks in zip(names, cells[_REMARKS].fillna(""), strict=True)
    ]
    table = pq.read_table(path)
    place = table.schema.get_field_index(_FLAGS)
    table = table.set_column(place, table.schema.field(place), pa.array(words, pa.string()))
    with replacing(path) as temporary:
        pq.write_table(table, temporary, use_dictionary=repeating(table.schema))


def flags_by_cell(study: Study, found: Correlation) -> list[str]:
    """Names of the QC flags of a correlation, by row of its table of cells.

    Parameters
    ----------
    study : Study
    found : Correlation

    Returns
    -------
    list of str
    """
    from cytodisk.runs.qc_flags.one_correlation import with_one
    from cytodisk.runs.qc_flags.study_flags import correlation_flags_of

    flags = correlation_flags_of(with_one(study, found))
    return names_by_row(flags, [(cell, None) for cell in found.cells["cell"]])


def prediction_flags_by_cell(study: Study, found: Prediction) -> list[str]:
    """Names of the QC flags of a prediction, by row of its table of cells.

    Parameters
    ----------
    study : Study
    found : Prediction

    Returns
    -------
    list of str
    """
    from cytodisk.runs.qc_flags.one_prediction import with_one_prediction
    from cytodisk.runs.qc_flags.study_flags import prediction_flags_of

    flags = prediction_flags_of(with_one_prediction(study, found))
    return names_by_row(flags, [(cell, None) for cell in found.cells["cell"]])


def names_by_row(flags: Iterable[QCFlag], rows: Iterable[tuple[Any, Any]]) -> list[str]:
    """Names of the flags of each row.

    Parameters
    ----------
    flags : iterable of QCFlag
        Those of the whole run stand in no row.
    rows : iterable of (cell, frame)
        The frame is None in tables without time.

    Returns
    -------
    list of str
        With "; " between names. A flag of the cell as a whole stands in each of the cell's rows.
    """
    named: dict[tuple[int, int | None], dict[str, None]] = {}
    for flag in flags:
        for place in flag.places:
            named.setdefault((place.cell, place.frame), {})[flag.name] = None
    return [
        "; ".join(
            named.get((int(cell), None), {})
            | (named.get((int(cell), int(frame)), {}) if frame is not None else {})
        )
        for cell, frame in rows
    ]
