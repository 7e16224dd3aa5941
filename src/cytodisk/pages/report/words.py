"""The words of the page: title, facts, QC flags by frame, tables."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import pandas as pd

from cytodisk.files import real_path
from cytodisk.pages.grid_words import grid_words
from cytodisk.pages.report.pictures import Box
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
    "figures/": "figures for print",
    "columns.csv": "table, unit and meaning of each column of these tables",
    "parameters.toml": "the parameters, to be fed back with --parameters",
    "provenance.json": "versions, input files with their hashes, times, warnings",
}


def page_words(
    cell: ShownCell, flags: Sequence[QCFlag], found: FoundSignal, box: Box, left_out: Sequence[str]
) -> dict[str, Any]:
    """All that the template writes as text.

    Parameters
    ----------
    cell : ShownCell
    flags : sequence of QCFlag
    found : FoundSignal
    box : Box
        Box of the pictures.
    left_out : sequence of str
        What the page leaves out, beside frames and pixels.

    Returns
    -------
    dict
        By name in the template.
    """
    study = cell.study
    statuses, others = _other_cells(study)
    return {
        "title": real_path(study.path).name,
        "facts": list(_facts(cell)),
        "flags": [_flag(flag, cell.cell, study) for flag in flags],
        "pixels_words": "with its windows" if found.source else "as windows: no pixels to show",
        "folder": shlex.quote(study.path.name or "."),
        "signal_hint": shlex.quote(cell.channels[0]) if cell.channels else None,
        "reduced": _reduced(cell, found, box, left_out),
        "statuses": statuses,
        "others": others,
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


def _flag(flag: QCFlag, shown: int, study: Study) -> dict[str, Any]:
    """A flag's places gathered by cell and, where there are few, by what was found."""
    places = tuple(replace(place, note=without_folders(place.note, study)) for place in flag.places)
    flag = replace(
        flag,
        what=without_folders(flag.what, study),
        advice=without_folders(flag.advice, study),
        places=places,
    )
    cells = sorted({place.cell for place in flag.places}, key=lambda cell: (cell != shown, cell))
    groups = [group for cell in cells for group in _groups(flag, cell, shown)]
    more = sum(max(1, len(group["frames"])) for group in groups[_MOST_GROUPS:])
    kept = {"what": flag.what, "meaning": flag.meaning, "advice": flag.advice}
    return kept | {"groups": groups[:_MOST_GROUPS], "more": more}


def _groups(flag: QCFlag, cell: int, shown: int) -> Iterator[dict[str, Any]]:
    places = [place for place in flag.places if place.cell == cell]
    notes = list(dict.fromkeys(place.note for place in places))
    by_note = len(notes) <= _MOST_GROUPS
    for note in notes if by_note else [""]:
        frames = [
            {"frame": place.frame, "note": place.note, "shown": cell == shown, "sector": place.sector}
            for place in places
            if place.frame is not None and (not by_note or place.note == note)
        ]
        yield {"cell": None if cell == shown and frames else cell, "note": note, "frames": frames}


def _reduced(cell: ShownCell, found: FoundSignal, box: Box, left_out: Sequence[str]) -> str:
    """What the page shows less of than the study holds."""
    words = []
    if cell.every > 1:
        words.append(
            f"One frame in {cell.every} is shown, {len(cell.frames)} of {cell.activity.sizes['time']}; all "
            "are in the study, and QC flags are from all."
        )
    if found.source is not None:
        size = f" and reduced to {box.scale:.0%} of its size" if box.scale < 1 else ""
        words.append(
            f"The movie is cropped to the cell{size}, in 256 steps of brightness as JPEG: for looking, not "
            "for measuring. Numbers come from the unreduced images."
        )
    words += [f"Left out: {what}." for what in left_out]
    return " ".join(words)


def _other_cells(study: Study) -> tuple[list[str], list[dict[str, Any]]]:
    """Counts by status of each cell; none of a study of one."""
    if study.cells["cell"].nunique() < 2:
        return [], []
    counts = pd.crosstab(study.cells["cell"], study.cells["status"])
    times = study.cells.groupby("cell")["frame"].agg(["min", "max"])
    rows = [
        {
            "cell": int(str(cell)),
            "counts": [int(count) for count in row],
            "first": int(times.loc[cell, "min"]),
            "last": int(times.loc[cell, "max"]),
        }
        for cell, row in zip(counts.index, counts.to_numpy(), strict=True)
    ]
    return [str(status) for status in counts.columns], rows


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
