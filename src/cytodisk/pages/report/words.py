"""The words of the page: title, facts, QC flags by frame, tables."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from cytodisk.files import real_path
from cytodisk.number_words import counted
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.report.boxes import Box
from cytodisk.pages.report.provenance_words import input_words, run_words, value_words, version_of
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_names import without_folders
from cytodisk.runs.channel_names import correlation_name
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.inputs.study_signal import FoundSignal
from cytodisk.store.study import Study

MOST_PLACES = 30
"""Frames that are listed of a flag and cell; the table has them all."""
_MOST_GROUPS = 6
_HEADING = ("signal", "with", "name", "unit", "given")  # settings of a correlation that stand in its name

_FILES = {
    "cells.parquet": "one row a cell and frame: area, distortion, tracking, status and its reason",
    "windows.parquet": "one row a cell, frame, channel, layer and sector: mean, sd, area",
    "edge.parquet": "one row a cell, frame and sector: edge velocity with its error, areas won and lost",
    "consistency.parquet": "how alike consecutive frames are, by layer",
    "activity.zarr.zip": "the same as arrays by time, channel, layer and sector",
    "maps/": "the map of each cell and frame",
    "correlation/": "correlations by window and layer, if any were computed",
    "prediction/": "which signals predict which, by layer, if it was tested",
    "waves/": "waves around the cell, if they were looked for",
    "figures/": "figures for print",
    "columns.csv": "table, unit and meaning of each column of these tables",
    "parameters.toml": "the parameters, to be fed back with --parameters",
    "provenance.json": "versions, input files with their hashes, times, warnings",
}


def page_words(cell: ShownCell, shown: Sequence[int], flags: Sequence[QCFlag]) -> dict[str, Any]:
    """All that the template writes as text.

    Parameters
    ----------
    cell : ShownCell
        The cell that is shown first.
    shown : sequence of int
        Cells that can be opened on the page.
    flags : sequence of QCFlag

    Returns
    -------
    dict
        By name in the template.
    """
    study = cell.study
    statuses, cells = _all_cells(study, shown)
    return {
        "title": real_path(study.path).name,
        "facts": list(_facts(cell)),
        "flags": [_flag(flag, cell.cell, shown, study) for flag in flags],
        "folder": shlex.quote(study.path.name or "."),
        "signal_hint": shlex.quote(cell.channels[0]) if cell.channels else None,
        "statuses": statuses,
        "cells": cells,
        "left_out": list(_cells_left_out(study, cells)),
        "settings": list(_settings(study)),
        "files": list(_FILES.items()),
        "version": version_of(study.provenance),
    }


def _facts(cell: ShownCell) -> Iterator[tuple[str, str]]:
    study, grid = cell.study, cell.grid
    ok = int((study.cells["status"] == "ok").sum())
    pixel, interval = cell.scale.pixel_size_um, cell.scale.frame_interval_s
    yield "cells", str(study.cells["cell"].nunique())
    yield "frames", str(study.cells["frame"].nunique())
    yield "mapped", f"{ok} of {len(study.cells)}"
    yield "pixel", f"{pixel:.4g} µm" if pixel else "size unknown"
    yield "interval", f"{interval:.4g} s" if interval else "unknown"
    yield "windows", grid_words(grid)
    yield "tracker", str(study.provenance["parameters"].get("tracker", "unknown"))
    yield "cytodisk", version_of(study.provenance)


def _flag(flag: QCFlag, first: int, shown: Sequence[int], study: Study) -> dict[str, Any]:
    """A flag's places gathered by cell and, where there are few, by what was found."""
    places = tuple(replace(place, note=without_folders(place.note, study)) for place in flag.places)
    flag = replace(
        flag,
        what=without_folders(flag.what, study),
        advice=without_folders(flag.advice, study),
        places=places,
    )
    cells = sorted({place.cell for place in flag.places}, key=lambda cell: (cell != first, cell))
    several = study.cells["cell"].nunique() > 1
    groups = [group for cell in cells for group in _groups(flag, cell, cell in shown, several=several)]
    more = sum(max(1, len(group["frames"])) for group in groups[_MOST_GROUPS:])
    kept = {"what": flag.what, "meaning": flag.meaning, "advice": flag.advice}
    return kept | {"groups": groups[:_MOST_GROUPS], "more": more}


def _groups(flag: QCFlag, cell: int, shown: bool, *, several: bool) -> Iterator[dict[str, Any]]:
    places = [place for place in flag.places if place.cell == cell]
    notes = list(dict.fromkeys(place.note for place in places))
    by_note = len(notes) <= _MOST_GROUPS
    for note in notes if by_note else [""]:
        frames = [
            {"frame": place.frame, "note": place.note, "shown": shown, "sector": place.sector, "cell": cell}
            for place in places
            if place.frame is not None and (not by_note or place.note == note)
        ]
        named = several or not frames
        yield {"cell": cell if named else None, "open": shown, "note": note, "frames": frames}


def reduced_words(cell: ShownCell, found: FoundSignal, boxes: Sequence[Box], left_out: Sequence[str]) -> str:
    """What the page shows less of a cell than the study holds.

    Parameters
    ----------
    cell : ShownCell
    found : FoundSignal
        The movie behind the windows.
    boxes : sequence of Box
        What is shown of each frame.
    left_out : sequence of str
        What the page leaves out, beside frames and pixels.

    Returns
    -------
    str
    """
    words, box, travels = [], boxes[0], len(set(boxes)) > 1
    if cell.every > 1:
        words.append(
            f"One frame in {cell.every} is shown, {len(cell.frames)} of {cell.activity.sizes['time']}; all "
            "are in the study, and QC flags are from all."
        )
    if found.source is not None:
        size = f" and reduced to {box.scale:.0%} of its size" if box.scale < 1 else ""
        words.append(
            f"The movie is cropped to the cell{', goes with it' if travels else ''}{size}, in 256 steps of "
            "brightness as JPEG: for looking, not for measuring. Numbers come from the unreduced images."
        )
    elif travels:
        words.append("The picture goes with the cell.")
    if found.source is None and cell.channels:
        words.append("The cell is drawn as its windows: there are no pixels to show.")
    words += [f"Left out: {what}." for what in left_out]
    return " ".join(words)


def _all_cells(study: Study, shown: Sequence[int]) -> tuple[list[str], list[dict[str, Any]]]:
    """Statuses, and each cell with its frames by status, its QC flags and whether it is on the page."""
    table = study.cells
    counts = pd.crosstab(table["cell"], table["status"])
    times = table.groupby("cell")["frame"].agg(["min", "max"])
    flags = table.groupby("cell")["qc_flags"].agg(_flag_names)
    rows = [
        {
            "cell": int(str(cell)),
            "counts": [int(count) for count in row],
            "first": int(times.loc[cell, "min"]),
            "last": int(times.loc[cell, "max"]),
            "flags": flags.loc[cell],
            "shown": int(str(cell)) in shown,
        }
        for cell, row in zip(counts.index, counts.to_numpy(), strict=True)
    ]
    return [str(status) for status in counts.columns], rows


def _flag_names(flags: pd.Series) -> str:
    names = [name for words in flags.dropna() for name in str(words).split("; ") if name]
    return ", ".join(f"{name} ({names.count(name)})" for name in dict.fromkeys(names))


def _cells_left_out(study: Study, cells: Sequence[dict[str, Any]]) -> Iterator[str]:
    """What the page has no views of, and the command that shows them."""
    mapped = set(study.cells.loc[study.cells["status"] == "ok", "cell"])
    lost = [row["cell"] for row in cells if row["cell"] not in mapped]
    if lost:
        yield f"{counted(len(lost), 'cell')} without a map: {_numbers(lost)}."
    rest = [row["cell"] for row in cells if row["cell"] in mapped and not row["shown"]]
    if rest:
        folder, room = shlex.quote(study.path.name or "."), sum(row["shown"] for row in cells)
        yield (
            f"This page has room for {counted(room, 'cell')}. Left out: {_numbers(rest)}. "
            f"A page that begins with another cell: cytodisk report {folder} --cell {rest[0]}"
        )


def _numbers(cells: Sequence[int]) -> str:
    more = len(cells) - MOST_PLACES
    return ", ".join(map(str, cells[:MOST_PLACES])) + (f" and {more} more" if more > 0 else "")


def _setting(given: Any, used: Any) -> str:
    """A parameter, or what the run used where none was given."""
    if given is None:
        return "not set" if used is None else f"{used:.6g} (not given; this was found and used)"
    return value_words(given)


def _settings(study: Study) -> Iterator[tuple[str, str]]:
    provenance = study.provenance
    yield from input_words(provenance)
    for name, value in provenance.get("parameters", {}).items():
        yield name, _setting(value, provenance.get(name))
    for names in study.correlations:
        told = study.correlation(*names).settings
        words = [
            f"{name} {value_words(value)}"
            for name, value in told.items()
            if name not in _HEADING and not (value is None or value is False or value in ([], ""))
        ]
        yield f"correlation of {correlation_name(names)}", ", ".join(words)
    yield from run_words(provenance)
