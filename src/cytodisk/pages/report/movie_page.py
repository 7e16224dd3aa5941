"""The page of a movie's study."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from typing import Any

import numpy as np

from cytodisk.errors import ParameterError, StudyError
from cytodisk.images.signal_files import FrameSource
from cytodisk.pages.report.bokeh_parts import palette
from cytodisk.pages.report.encode import json_for_script
from cytodisk.pages.report.page_figures import figures_of, library_script
from cytodisk.pages.report.pictures import MOST_BYTES, OUTSIDE, Pictures, box_around, encode_frames, size_of
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_correlations import pairs_of
from cytodisk.pages.report.template import rendered
from cytodisk.pages.report.words import MOST_PLACES, page_words
from cytodisk.plot.correlation.correlation_peaks import LAG_COLOURS
from cytodisk.plot.style import DIVERGING_COLOURS
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.runs.qc_flags.study_flags import qc_flags
from cytodisk.store.inputs.study_signal import FoundSignal, shown_signal
from cytodisk.store.provenance_file import other_maps, writer_of
from cytodisk.store.study import Study

_SCRIPTS = ("decode", "numbers", "state", "pixels", "views", "controls", "main")

Progress = Callable[[int, int], None]


def usual_cell(study: Study) -> int:
    """The cell with the most mapped frames, the first of several."""
    mapped = study.cells.loc[study.cells["status"] == "ok", "cell"]
    if mapped.empty:
        raise StudyError(f"study {study.path} has no mapped frame: column 'reason' of cells.parquet says why")
    cells, counts = np.unique(mapped, return_counts=True)
    return int(cells[counts.argmax()])


def open_cell(study: Study, cell: int) -> ShownCell:
    """A cell to show, with so many frames as a page holds.

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
    return data.thinned()


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
    found : FoundSignal
        The movie behind the windows.
    progress : callable, optional
        Called with the number of frames done and that of all.

    Returns
    -------
    str
    """
    box = box_around(cell)
    limits = Pictures(cell, box, found.source).limits()
    cell = cell.every_frames(Pictures(cell, box, found.source).every(limits))
    pictures = list(encode_frames(Pictures(cell, box, found.source), limits, progress))
    while sum(map(size_of, pictures)) > MOST_BYTES and len(pictures) > 1:  # larger than the frames judged by
        cell, pictures = cell.every_frames(2 * cell.every), pictures[::2]
    pairs, left_out = pairs_of(cell)
    data = cell.as_json() | {
        "pairs": pairs,
        "first": next(k for k, frame in enumerate(pictures) if frame["labels"]) if _any(pictures) else 0,
        "picture": {"shape": box.shape, "limits": limits, "box": vars(box)},
        "palettes": {"correlation": palette(DIVERGING_COLOURS), "lag": palette(LAG_COLOURS)},
    }
    words = page_words(cell, _flags(cell.study, found), found, box, left_out)
    words |= {
        "data": data,
        "most_places": MOST_PLACES,
        "library": library_script(),
        "data_json": json_for_script(data),
        "pictures_json": json_for_script(pictures),
        "figures_json": json_for_script(figures_of(cell, box, correlated=bool(pairs))),
    }
    return rendered("page", ["page"], _SCRIPTS, words)


def _any(pictures: list[dict[str, Any]]) -> bool:
    return any(frame["labels"] for frame in pictures)


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
