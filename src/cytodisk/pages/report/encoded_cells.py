"""The cells of a movie's page as texts that its scripts read, within the size of a page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from cytodisk.pages.report.boxes import boxes_by_frame
from cytodisk.pages.report.encode import json_for_script
from cytodisk.pages.report.pictures import Pictures, encode_frames, size_of
from cytodisk.pages.report.shown_cell import MOST_ARRAY_BYTES, ShownCell
from cytodisk.pages.report.shown_correlations import MOST_CURVE_NUMBERS, pairs_of
from cytodisk.pages.report.shown_predictions import predictions_of
from cytodisk.pages.report.shown_waves import waves_of
from cytodisk.pages.report.words import reduced_words
from cytodisk.runs.findings.doubt_words import bearing_flags
from cytodisk.runs.findings.finding import Finding
from cytodisk.runs.findings.movie_finding import movie_finding
from cytodisk.runs.qc_flags.qc_flag import QCFlag
from cytodisk.store.inputs.study_signal import FoundSignal

MOST_BYTES = 10_000_000
"""Of all pictures of a page, as text; longer movies are thinned out."""
MOST_TEXT = 20_000_000
"""Of all cells of a page; cells beyond are left out."""
LEAST_BYTES = 350_000
"""Of pictures that a cell is given; more cells than that allows are left out."""

_FIRST = 0.5  # share of the page that the first of several cells may have

Progress = Callable[[int, int], None]


@dataclass(frozen=True, eq=False)
class MovieCells:
    """Encoder of a study's cells.

    Attributes
    ----------
    first : ShownCell
        The cell that is shown first.
    found : FoundSignal
        The movie behind the windows.
    flags : sequence of QCFlag
        Those of the study.
    """

    first: ShownCell
    found: FoundSignal
    flags: Sequence[QCFlag]

    @cached_property
    def cells(self) -> list[int]:
        """The cells to show: the first, those with a map after it, those before it."""
        rows = self.first.study.cells
        mapped = sorted({int(cell) for cell in rows.loc[rows["status"] == "ok", "cell"]})
        start = self.first.cell
        others = [cell for cell in mapped if cell > start] + [cell for cell in mapped if cell < start]
        return [start, *others[: int((1 - _FIRST) * MOST_BYTES / LEAST_BYTES)]]

    def share(self, cell: int) -> float:
        """Share of the page's room that a cell has."""
        others = len(self.cells) - 1
        if not others:
            return 1.0
        return _FIRST if cell == self.first.cell else (1 - _FIRST) / others

    def encoded(self, progress: Progress | None = None) -> dict[int, dict[str, Any]]:
        """Texts by cell, in the order of `cells`, as far as there is room.

        Parameters
        ----------
        progress : callable, optional
            Called with the number of frames done and that of all.

        Returns
        -------
        dict of int to dict
            "json", the text, and "finding", the sentences that come first.
        """
        opened = [self._opened(cell) for cell in self.cells]
        whole, done, size = sum(len(one.frames) for one in opened), 0, 0
        texts: dict[int, dict[str, Any]] = {}
        for one in opened:
            step = _shifted(progress, done, whole)
            text = self._text(one, step)
            done, size = done + len(one.frames), size + len(text["json"])
            if size > MOST_TEXT and texts:
                break
            texts[one.cell] = text
        return texts

    def _opened(self, cell: int) -> ShownCell:
        one = self.first if cell == self.first.cell else ShownCell(self.first.study, cell)
        one = one.thinned(int(self.share(cell) * MOST_ARRAY_BYTES))
        pictures = self._pictures(one)
        return one.every_frames(pictures.every(pictures.limits(), int(self.share(cell) * MOST_BYTES)))

    def _pictures(self, cell: ShownCell) -> Pictures:
        return Pictures(cell, boxes_by_frame(cell), self.found.source)

    def _text(self, cell: ShownCell, progress: Progress | None) -> dict[str, Any]:
        encoder, most = self._pictures(cell), int(self.share(cell.cell) * MOST_BYTES)
        limits, boxes = encoder.limits(), encoder.boxes
        pictures = list(encode_frames(encoder, limits, progress))
        while sum(map(size_of, pictures)) > most and len(pictures) > 1:  # larger than those judged by
            cell, pictures = cell.every_frames(2 * cell.every), pictures[::2]
        pairs, left_out = pairs_of(cell, int(self.share(cell.cell) * MOST_CURVE_NUMBERS))
        raised = tuple(bearing_flags(self.flags, cell.cell))
        waves, more_left_out = waves_of(cell, raised)
        left_out = [*left_out, *more_left_out]
        predictions = predictions_of(cell, raised)
        finding = _findings(movie_finding(cell.study, cell.cell, self.flags), [*predictions, *waves])
        data = cell.as_json() | {
            "pairs": pairs,
            "predictions": predictions,
            "waves": waves,
            "finding": finding,
            "reduced": reduced_words(cell, self.found, boxes, left_out),
            "has_pixels": any(frame["channels"] for frame in pictures),
            "first": next((k for k, frame in enumerate(pictures) if frame["labels"]), 0),
            "picture": {
                "shape": boxes[0].shape,
                "limits": limits,
                "size": [boxes[0].height, boxes[0].width],
                "corners": [[boxes[frame].top, boxes[frame].left] for frame in cell.frames],
            },
            "pictures": pictures,
        }
        return {"json": json_for_script(data), "finding": finding}


def _findings(first: Finding, others: Sequence[dict[str, Any]]) -> list[str]:
    """Sentences of the page: those of correlations and motion, and the head of predictions and waves.

    What was found beyond doubt comes first.
    """
    told = [one for one in others if one["finding"]]
    before = [one for one in told if one["kind"] == "found" != first.kind]
    after = [one for one in told if one not in before]
    return [*_heads(before), *first.sentences, *_heads(after)]


def _heads(told: Sequence[dict[str, Any]]) -> list[str]:
    """What was found, without what was given or what it is measured by."""
    return [words for one in told for words in one["finding"][: one["head"]]]


def _shifted(progress: Progress | None, before: int, whole: int) -> Progress | None:
    """The same progress, of one cell among several."""
    if progress is None:
        return None
    return lambda done, _: progress(before + done, whole)
