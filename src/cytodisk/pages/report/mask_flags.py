"""Red flags of masks, maps and pixels."""

from __future__ import annotations

from collections.abc import Iterator

from cytodisk.pages.report.flag import Flag, frames_of, mapped_rows, places_of, words_in
from cytodisk.store.study import Study

LARGEST_DISTORTION = 0.15
"""Mean |ln λ| above which windows differ in area by some 15 %; ordinary cells stay below 0.05."""


def without_map(study: Study) -> Iterator[Flag]:
    meanings = {
        "unreadable": (
            "The file is damaged there; the frame has no numbers.",
            "Copy the file again from the microscope and run again.",
        ),
        "refused": (
            "The mask there is no single cell that can be mapped; the frame has no numbers.",
            "Correct the mask, or leave the frame out of what you compare.",
        ),
        "missing": (
            "The cell is not in the mask there; the frame has no numbers, and velocity and tracking break.",
            "If the cell is in the image, complete the segmentation; if labels changed, link them (--link).",
        ),
    }
    for status in [*meanings, *sorted(set(study.cells["status"]) - {*meanings, "ok"})]:
        rows = study.cells[study.cells["status"] == status]
        if len(rows):
            meaning, advice = meanings.get(status, ("The frame has no numbers.", "Read the reason."))
            places = places_of(rows, lambda row: str(row["reason"]))
            yield Flag(f"{status} frames", f"{frames_of(study, len(rows))} {status}", meaning, advice, places)


def doubts(study: Study) -> Iterator[Flag]:
    if "qc_flags" not in study.cells:
        return
    rows = study.cells[words_in(study.cells["qc_flags"]) != ""]
    if len(rows):
        yield Flag(
            "masks in doubt",
            f"{frames_of(study, len(rows))} may not be one whole cell",
            "Cleaning the mask changed much, or the cell is not where it was.",
            "Look at the mask; correct the segmentation or leave it out.",
            places_of(rows, lambda row: str(row["qc_flags"])),
        )


def border(study: Study) -> Iterator[Flag]:
    if "touches_border" not in study.cells:
        return
    rows = mapped_rows(study)[mapped_rows(study)["touches_border"].fillna(False).astype(bool)]
    if len(rows):
        yield Flag(
            "image border",
            f"the cell touches the image's border in {frames_of(study, len(rows))}",
            "Part of the cell may lie outside; layer 0 there is a cut, not an edge, and has no velocity.",
            "Leave the sectors at the border out, or take a movie with the whole cell in view.",
            places_of(rows, lambda row: f"{row['border_share']:.0%} of the edge"),
        )


def distortion(study: Study) -> Iterator[Flag]:
    rows = mapped_rows(study)
    rows = rows[rows["area_distortion"] > LARGEST_DISTORTION] if "area_distortion" in rows else rows[:0]
    if len(rows):
        yield Flag(
            "strong distortion",
            f"windows differ much in area in {frames_of(study, len(rows))}",
            f"The map's mean area error is above {LARGEST_DISTORTION:.0%}, as in cells with long thin arms: "
            "windows of one layer hold unequal shares of the cell.",
            "Weigh windows by their area, or use fewer and larger windows.",
            places_of(rows, lambda row: f"{row['area_distortion']:.0%}"),
        )


def nan_pixels(study: Study) -> Iterator[Flag]:
    if "nan_px" not in study.cells:
        return
    rows = study.cells[study.cells["nan_px"].fillna(0) > 0]
    if len(rows):
        yield Flag(
            "NaN pixels",
            f"the signal has pixels without a number (NaN) inside the cell in {frames_of(study, len(rows))}",
            "Windows with such pixels have no mean (--nan propagate) or the mean of the rest (--nan omit).",
            "Find the step of the image processing that divides by zero.",
            places_of(rows, lambda row: f"{int(row['nan_px'])} px"),
        )
