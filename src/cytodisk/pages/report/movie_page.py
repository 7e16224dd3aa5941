"""The page of a movie's study: all its cells, one after the other."""

from __future__ import annotations

import shlex
from collections.abc import Callable

from cytodisk.errors import ParameterError
from cytodisk.images.signal_files import FrameSource
from cytodisk.pages.report.encode import json_for_script
from cytodisk.pages.report.encoded_cells import MovieCells
from cytodisk.pages.report.palettes import palette
from cytodisk.pages.report.pictures import OUTSIDE
from cytodisk.pages.report.shown_cell import STRIPS, ShownCell
from cytodisk.pages.report.template import rendered
from cytodisk.pages.report.words import MOST_PLACES, page_words
from cytodisk.plot.correlation.correlation_peaks import LAG_COLOURS
from cytodisk.plot.style import DIVERGING_COLOURS, SIGNAL_COLOURS
from cytodisk.plot.waves.phase_colours import PHASE_COLOURS
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.inputs.study_signal import FoundSignal, shown_signal
from cytodisk.store.provenance_file import other_maps, writer_of
from cytodisk.store.study import Study

_SCRIPTS = (
    "decode",
    "elements",
    "numbers",
    "chart",
    "state",
    "disk",
    "pixels",
    "frame",
    "views",
    "controls",
    "network",
    "results",
    "main",
)

Progress = Callable[[int, int], None]


def open_cell(study: Study, cell: int) -> ShownCell:
    """A cell to show first.

    Raises
    ------
    ParameterError
        The study has no such cell, none of its frames is mapped, or a page cannot hold so many windows.
    """
    rows = study.cells[study.cells["cell"] == cell]
    if rows.empty:
        count = study.cells["cell"].nunique()
        raise ParameterError(f"cell must be a number of the study's {count} cells from 0, got {cell}")
    if not (rows["status"] == "ok").any():
        raise ParameterError(f"cell {cell} has no mapped frame: choose another one, or leave it out")
    data = ShownCell(study, cell)
    if data.grid.n_windows >= OUTSIDE:
        raise ParameterError(
            f"study {study.path} has {data.grid.n_windows} windows a cell, a page holds fewer than "
            f"{OUTSIDE}: run it with fewer layers or sectors"
        )
    return data


def page_flags(study: Study, signal: FrameSource | None = None) -> list[QCFlag]:
    """The QC flags that stand on the page of a study.

    Parameters
    ----------
    study : Study
        Study of a movie.
    signal : FrameSource, optional
        As for `write_report`.

    Returns
    -------
    list of QCFlag
        Those of `qc_flags`, and before them one if the maps are of another version, and one if the signal
        cannot be shown.

    Raises
    ------
    SignalError
        As for `write_report`.
    """
    return _flags(study, shown_signal(study, signal))


def _flags(study: Study, found: FoundSignal) -> list[QCFlag]:
    return [*_map_flags(study), *_signal_flags(study, found), *qc_flags(study)]


def movie_page(cell: ShownCell, found: FoundSignal, progress: Progress | None) -> str:
    """The page as text.

    Parameters
    ----------
    cell : ShownCell
        The cell that is shown first; the study's others follow, as many as there is room for.
    found : FoundSignal
        The movie behind the windows.
    progress : callable, optional
        Called with the number of frames done and that of all.

    Returns
    -------
    str
    """
    study = cell.study
    flags = _flags(study, found)
    texts = MovieCells(cell, found, flags).encoded(progress)
    words = page_words(cell, list(texts), flags)
    strips = [*STRIPS.values(), *(["intensity"] if cell.channels else [])]
    told = {
        "first": cell.cell,
        "cells": [{"cell": row["cell"], "shown": row["shown"]} for row in words["cells"]],
        "strips": strips,
        "pixel_size_um": study.scale.pixel_size_um,
        "length_unit": study.scale.length_unit,
        "palettes": {
            "signal": palette(SIGNAL_COLOURS),
            "correlation": palette(DIVERGING_COLOURS),
            "lag": palette(LAG_COLOURS),
            "phase": palette(PHASE_COLOURS),
        },
    }
    words |= {
        "most_places": MOST_PLACES,
        "several": len(words["cells"]) > 1,
        "signal": bool(cell.channels),
        "correlated": bool(study.correlations),
        "predicted": bool(study.predictions),
        "waves": bool(study.wave_signals),
        "nuclei": bool(cell.grid.nucleus_layers),
        "strips": strips,
        "finding": texts[cell.cell]["finding"],
        "texts": [
            ("study", json_for_script(told)),
            *((f"cell-{number}", text["json"]) for number, text in texts.items()),
        ],
    }
    return rendered("page", ["page"], _SCRIPTS, words)


EARLIER_MAPS = "earlier maps"  # name of a flag


def _map_flags(study: Study) -> list[QCFlag]:
    if not other_maps(study.provenance):
        return []
    return [
        QCFlag(
            EARLIER_MAPS,
            f"the maps were made by {writer_of(study.provenance)}",
            "Windows lie at other places than in studies made now.",
            "Do not compare window by window with those; run cytodisk movie again where you must.",
        )
    ]


def _signal_flags(study: Study, found: FoundSignal) -> list[QCFlag]:
    if not found.fault:
        return []
    return [
        QCFlag(
            "signal not shown",
            f"the movie's pixels are not on this page: {found.fault}",
            "The cell is drawn as its windows alone; all numbers are those of the run.",
            "Put the file back where it was, or name the place where it is now: cytodisk report "
            f"{shlex.quote(study.path.name or '.')} --signal FILE",
        )
    ]
