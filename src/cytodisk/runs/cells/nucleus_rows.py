"""What the table of cells says of a cell's nucleus."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_nuclei import CellNucleus
from cytodisk.runs.frame_rows import FramePlace
from cytodisk.store.nuclei.nucleus_columns import NUCLEI_COLUMNS
from cytodisk.store.study_folder import StudyFolder


def nucleus_columns(nucleus: CellNucleus | None, report: NucleusReport | None = None) -> dict[str, Any]:
    """Columns of a cell's row in a study with nuclei; none in one without.

    Parameters
    ----------
    nucleus : CellNucleus or None
        As it came.
    report : NucleusReport or None
        What fitting it into the cell changed; None for a cell that is not mapped with it.
    """
    if nucleus is None:
        return {}
    match = nucleus.match
    if match is None:
        found: dict[str, Any] = {"nucleus_status": "unusable" if nucleus.fault else None}
    else:
        found = {
            "n_nuclei": len(match.nuclei),
            "nuclei": match.labels,
            "nucleus_status": match.status,
        }
    if report is None:
        return found
    return found | {
        "n_nuclei": report.n_nuclei,
        "nucleus_remarks": "; ".join(report.notes),
        "nucleus_area_px": report.area_px,
        "nucleus_dropped_px": report.dropped_px,
        "nucleus_filled_px": report.filled_px,
        "nucleus_outside_px": report.outside_px,
        "nucleus_clipped_px": report.clipped_px,
        "nucleus_clipped_share": report.clipped_share,
        "nucleus_joined_px": report.joined_px,
    }


def nuclei_table(found: SourceCell | FramePlace, nucleus: CellNucleus | None) -> dict[str, dict[str, Any]]:
    """What goes into the table of nuclei with a cell, as columns by the table's name; nothing without nuclei.

    Parameters
    ----------
    found : SourceCell or FramePlace
    nucleus : CellNucleus or None
    """
    rows = [] if nucleus is None else list(nucleus.rows(found))
    columns = [column.name for column in NUCLEI_COLUMNS]
    return {"nuclei": {name: [row[name] for row in rows] for name in columns}} if rows else {}


def nuclei_warnings(folder: StudyFolder, keys: Iterable[str]) -> list[str]:
    """What a user should know of the nuclei of a run.

    Parameters
    ----------
    folder : StudyFolder
        With all parts.
    keys : iterable of str
        Of the parts.
    """
    if "nuclei" not in folder.kind.others:
        return []
    tables = [folder.part_table(key, "nuclei") for key in keys if folder.has_table(key, "nuclei")]
    strays = sum(table["cell"].null_count for table in tables)
    if not strays:
        return []
    words = "1 nucleus lies" if strays == 1 else f"{strays} nuclei lie"
    return [f"{words} in no cell: the table of nuclei lists what no cell holds"]
