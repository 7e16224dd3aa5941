"""QC flags that a column of the table of cells raises: masks, maps, pixels, tracking."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.runs.qc_flags.qc_flag import QCFlag, frames_of, mapped_rows, places_of
from cytodisk.runs.qc_flags.remedy import run_again
from cytodisk.scale import Scale
from cytodisk.store.study import Study

LARGEST_DISTORTION = 0.15
"""Area error of windows above which they differ in area by some 15 %; ordinary cells stay below 0.07."""
LARGEST_RESIDUAL_PX = 1.0
"""Tracking residual of a frame, in px; good frames have a few hundredths."""

WITHOUT_MAP = {
    "unreadable": (
        "The file is damaged there; the frame has no numbers.",
        "Copy the file again from the microscope and run again.",
    ),
    "refused": (
        "The mask there is no single cell that can be mapped; the frame has no numbers.",
        "Correct the mask, or leave the frame out of what you compare.",
    ),
    "missing": (
        "The cell, or the file, is not there; the frame has no numbers, and velocity and tracking break.",
        "If the cell is in the image, complete the segmentation; if labels changed, link them (--link); "
        "if a file is missing, put it back.",
    ),
}
"""What a frame without a map means, and what to do, by its status."""


@dataclass(frozen=True)
class ColumnRule:
    """A flag that rows of the table of cells raise by one of their columns.

    Attributes
    ----------
    name, meaning, advice : str
        As of `QCFlag`.
    what : str
        With {frames} where their number goes.
    column : str
        A study without it has no such flag.
    raised : callable
        Which values of the column raise it.
    note : callable
        What stands beside a frame: (value of the column, row).
    mapped : bool
        Only frames with a map count.
    again : (str, str) or None
        Parameter and value that the advice ends with, as the command of a run with it.
    unless : str
        Column whose words leave a row out; empty for none.
    """

    name: str
    what: str
    meaning: str
    advice: str
    column: str
    raised: Callable[[pd.Series[Any], Scale], pd.Series[bool]]
    note: Callable[[Any, Any, Scale], str]
    mapped: bool = True
    again: tuple[str, str] | None = None
    unless: str = ""

    def __call__(self, study: Study) -> Iterator[QCFlag]:
        rows = mapped_rows(study) if self.mapped else study.cells
        if self.column not in rows:
            return
        scale = study.scale
        if self.unless in rows:
            rows = rows[~said(rows[self.unless], scale)]
        rows = rows[self.raised(rows[self.column], scale)]
        if len(rows):
            most = f"{scale.length(LARGEST_RESIDUAL_PX):.3g} {scale.length_unit}"
            yield QCFlag(
                self.name,
                self.what.format(frames=frames_of(study, len(rows))),
                self.meaning.format(most=most),
                self.advice + self._command(study),
                places_of(rows, lambda row: self.note(row[self.column], row, scale)),
            )

    def _command(self, study: Study) -> str:
        return "" if self.again is None else run_again(study, self.again[1], **dict([self.again]))


def without_map(study: Study) -> Iterator[QCFlag]:
    """Frames without a map, by their status."""
    for status in [*WITHOUT_MAP, *sorted(set(study.cells["status"]) - {*WITHOUT_MAP, "ok"})]:
        rows = study.cells[study.cells["status"] == status]
        if len(rows):
            words = WITHOUT_MAP.get(status, ("The frame has no numbers.", "Read the reason."))
            places = places_of(rows, lambda row: str(row["reason"]))
            what = frames_of(study, len(rows)) if (rows["label"] != 0).any() else _images(len(rows))
            yield QCFlag(f"{status} frames", f"{what} {status}", *words, places)


def _images(number: int) -> str:
    """Rows of a map without a cell, each a file or one of its images."""
    return counted(number, "file or image", "files or images")


def said(column: pd.Series[Any], _: Scale) -> pd.Series[bool]:
    """Which values of a column are words."""
    return column.fillna("").astype(str) != ""


def _above_zero(column: pd.Series[Any], _: Scale) -> pd.Series[bool]:
    return pd.to_numeric(column, errors="coerce").fillna(0) > 0


flagged_masks = ColumnRule(
    "flagged masks",
    "{frames} may not be one whole cell",
    "Cleaning the mask changed much, or the cell is not where it was.",
    "Look at the mask; correct the segmentation or leave it out.",
    "mask_remarks",
    said,
    lambda value, row, scale: str(value),
    mapped=False,
)
image_border = ColumnRule(
    "image border",
    "the cell touches the image's border in {frames}",
    "Part of the cell may lie outside; layer 0 there is a cut, not an edge, and has no velocity.",
    "Leave the sectors at the border out, or take a movie with the whole cell in view.",
    "touches_border",
    _above_zero,
    lambda value, row, scale: f"{row['border_share']:.0%} of the edge",
)
distortion = ColumnRule(
    "strong distortion",
    "windows differ much in area in {frames}",
    f"The mean area error of windows is above {LARGEST_DISTORTION:.0%}, as in cells with long thin arms: "
    "windows of one layer hold unequal shares of the cell.",
    "Weigh windows by their area, or use fewer and larger windows.",
    "window_area_error",
    lambda column, scale: column > LARGEST_DISTORTION,
    lambda value, row, scale: f"{value:.0%}",
)
nan_pixels = ColumnRule(
    "NaN pixels",
    "the signal has pixels without a number (NaN) inside the cell in {frames}",
    "Windows with such pixels have no mean (--nan propagate) or the mean of the rest (--nan omit).",
    "Find the step of the image processing that divides by zero.",
    "nan_px",
    _above_zero,
    lambda value, row, scale: f"{int(value)} px",
    mapped=False,
)
tracking_residual = ColumnRule(
    "tracking residual",
    "tracking is unsure in {frames}",
    "Boundary points carried on and back again miss their start by more than {most}: sectors may have slid "
    "along the edge there.",
    "Look at the outlines before and after; a mask that lost or gained a piece is the usual cause.",
    "tracking_residual",
    lambda column, scale: column > scale.length(LARGEST_RESIDUAL_PX),
    lambda value, row, scale: f"{value:.3g} {scale.length_unit}",
)
order_violations = ColumnRule(
    "order violations",
    "boundary points changed their order in {frames}",
    "The tracker put neighbouring points past each other; they were put back in order, which moves them "
    "along the edge.",
    "Use the tracker that keeps the order: ",
    "order_violations",
    _above_zero,
    lambda value, row, scale: counted(int(value), "point"),
    again=("tracker", "matching"),
)
tracking_restarts = ColumnRule(
    "tracking restarts",
    "tracking started anew in {frames}",
    "A sector is the same place of the cell before and after only as far as the shape tells; velocity is "
    "unknown across the restart.",
    "Compare sectors within the stretches between restarts.",
    "restarted",
    said,
    lambda value, row, scale: str(value),
)
