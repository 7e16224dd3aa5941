"""The words of the page of single cells: what came of the run, its QC flags, what the page leaves out."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.report.cells.cell_table import CONDITION, EXPERIMENT
from cytodisk.pages.report.provenance_words import version_of
from cytodisk.pages.report.shown_names import without_folders
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.study import Study
from cytodisk.windows.study_grid import polar_grid_of

_MOST_PLACES = 8
_MOST_REASONS = 6


def cell_names(cells: pd.DataFrame) -> dict[int, str]:
    """Each cell by file, frame and label, as far as these differ, as "f02_masks.tif, label 3".

    Parameters
    ----------
    cells : DataFrame
        The table of cells of a study.
    """
    frames, labels = cells["frame"].nunique() > 1, cells["label"].nunique() > 1
    many = "source" in cells
    names = {}
    for row in cells[["cell", *(["source"] if many else []), "frame", "label"]].to_dict("records"):
        words = [str(row["source"])] if many else []
        words += [f"frame {row['frame']}"] if frames else []
        words += [f"label {row['label']}"] if labels and row["label"] else []
        names[int(row["cell"])] = ", ".join(words) or f"cell {row['cell']}"
    return names


def groups_words(study: Study) -> str:
    """Cells by condition and experiment, and the command that compares them; empty without conditions."""
    rows = study.cells
    mapped = rows[rows["status"] == "ok"]
    if CONDITION not in rows or mapped[CONDITION].dropna().empty:
        return ""
    words = []
    for name, part in mapped.groupby(CONDITION, sort=False):
        repeats = part[EXPERIMENT].dropna().nunique() if EXPERIMENT in part else 0
        words.append(
            f"{name}: {counted(len(part), 'cell')}"
            + (f" in {counted(repeats, 'experiment')}" if repeats else "")
        )
    return "; ".join(words)


def lost_groups(study: Study) -> list[dict[str, Any]]:
    """Why cells were lost: reasons that differ in numbers alone are one, those of most cells first."""
    names = cell_names(study.cells)
    groups: dict[tuple[str, str], list[tuple[int, str]]] = {}
    for row in study.cells[study.cells["status"] != "ok"].to_dict("records"):
        reason = without_folders(str(row["reason"]), study)
        alike = re.sub(r"\d+", "N", reason.replace(str(row.get("source", "")) or "\n", "FILE"))
        groups.setdefault((row["status"], alike), []).append((int(row["cell"]), reason))
    ordered = sorted(groups.items(), key=lambda item: -len(item[1]))
    found = [
        {
            "status": status,
            "count": len(cells),
            "reason": cells[0][1],
            "cells": [{"cell": cell, "name": names[cell]} for cell, _ in cells[:_MOST_PLACES]],
            "more": max(0, len(cells) - _MOST_PLACES),
        }
        for (status, _), cells in ordered
    ]
    return found[:_MOST_REASONS]


def flag_words(flags: Sequence[QCFlag], study: Study) -> list[dict[str, Any]]:
    """QC flags with the first of their cells, by name."""
    names = cell_names(study.cells)
    return [
        {
            "name": flag.name,
            "what": without_folders(flag.what, study),
            "meaning": flag.meaning,
            "advice": without_folders(flag.advice, study),
            "cells": [
                {"cell": place.cell, "name": names[place.cell], "note": without_folders(place.note, study)}
                for place in flag.places[:_MOST_PLACES]
            ],
            "count": len({place.cell for place in flag.places}),
        }
        for flag in flags
    ]


def facts(study: Study) -> Iterator[tuple[str, str]]:
    """What the head of the page says of the study."""
    rows, pixel = study.cells, study.scale.pixel_size_um
    yield "cells", str(int((rows["label"] != 0).sum()))
    yield "mapped", str(int((rows["status"] == "ok").sum()))
    yield "pixel", f"{pixel:.4g} µm" if pixel else "size unknown"
    yield "windows", grid_words(polar_grid_of(study.provenance))
    yield "cytodisk", version_of(study.provenance)


def left_out(
    study: Study, shown: Sequence[int], wanted: Sequence[int], fault: str, with_map: int
) -> list[str]:
    """What the page shows less of than the study holds, as sentences.

    Parameters
    ----------
    study : Study
    shown : sequence of int
        Cells with a picture.
    wanted : sequence of int
        Cells that could have had one, from the first that was asked for.
    fault : str
        Why there are no pixels; empty if there are.
    with_map : int
        Number of cells whose map is in the study.
    """
    folder, words = shlex.quote(str(study.path)), []
    lost = int((study.cells["status"] == "ok").sum()) - with_map
    if lost > 0:
        words.append(
            f"The maps of {counted(lost, 'cell')} were not kept (--no-maps): no windows are drawn in their "
            "pictures."
        )
    if fault:
        words.append(
            f"The images are not on this page: {fault}. Cells are drawn as their windows alone; all numbers "
            f"are those of the run. Put the files back, then run: cytodisk report {folder}"
        )
    if len(shown) < len(wanted):
        following = next((cell for cell in wanted if cell > max(shown, default=-1)), None)
        words.append(
            f"Pictures of {len(shown)} of {counted(len(study.cells), 'cell')} are on this page; the list has "
            f"all. A page with pictures of the next ones: cytodisk report {folder} --cell {following}"
        )
    return words
