"""`red_flags`: what in a study deserves a second look before its numbers are believed."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.io.study import Study
from cytodisk.report.drift import signal_drifts

LARGEST_DISTORTION = 0.15
"""Mean |ln λ| above which windows differ in area by some 15 %; ordinary cells stay below 0.05."""
LARGEST_RESIDUAL_PX = 1.0
"""Tracking residual of a frame, in px; good frames have a few hundredths."""
LARGEST_AREA_STEP = 0.05
"""Relative change of area from a frame to the next that is never flagged."""
AREA_STEP_SPREADS = 6.0
"""Changes of area beyond so many robust standard deviations of the cell's own are flagged."""
VELOCITY_SPREADS = 15.0
"""Edge velocities beyond so many robust standard deviations of the cell's own are flagged."""
SMALLEST_FAST_STEP_PX = 3.0
"""Motion of the edge in a frame, in px, that is never flagged."""

_MAD_TO_SD = 1.4826  # of a normal distribution


@dataclass(frozen=True)
class Place:
    """Where a flag was raised.

    Attributes
    ----------
    cell : int
    time : int or None
        Number of the frame; None for the cell as a whole, or a study without time.
    note : str
        What was found there, in words; empty if the flag says all.
    """

    cell: int
    time: int | None
    note: str = ""


@dataclass(frozen=True)
class Flag:
    """One kind of fault that a study shows.

    Attributes
    ----------
    name : str
        Short and fixed, to be matched by programs, as "area jumps".
    what : str
        What was found and how often, as a sentence.
    meaning, advice : str
        What it means for the results, and what to do.
    places : tuple of Place
        Empty for a fault of the whole run.
    """

    name: str
    what: str
    meaning: str
    advice: str
    places: tuple[Place, ...] = ()


def red_flags(study: Study) -> list[Flag]:
    """Look for faults in a study's tables, over all of its cells.

    Parameters
    ----------
    study : Study
        Of a movie or of single masks. Pixels are not read.

    Returns
    -------
    list of Flag
        The gravest first; empty if there are none. A frame may stand in several.

    Notes
    -----
    A frame is compared with the other frames of its own cell where cells differ by nature (area, velocity),
    by the median and the median absolute deviation, so that the faults themselves do not raise the bar; the
    thresholds are the constants of this module and of `drift`.
    """
    found = [flag for rule in _RULES for flag in rule(study)]
    return [*found, *_other_warnings(study, found)]


def _places(rows: pd.DataFrame, note: Callable[[Any], str] | None = None) -> tuple[Place, ...]:
    times = rows["time"] if "time" in rows else [None] * len(rows)
    return tuple(
        Place(int(row["cell"]), None if time is None else int(time), note(row) if note else "")
        for (_, row), time in zip(rows.iterrows(), times, strict=True)
    )


def _count(number: int, one: str, many: str | None = None) -> str:
    return f"{number} {one if number == 1 else many or one + 's'}"


def _frames(study: Study, number: int) -> str:
    return _count(number, "frame" if study.is_movie else "cell")


def _ok(study: Study) -> pd.DataFrame:
    return study.cells[study.cells["status"] == "ok"]


def _words(column: pd.Series[Any]) -> pd.Series[Any]:
    return column.fillna("").astype(str)


def _without_map(study: Study) -> Iterator[Flag]:
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
            places = _places(rows, lambda row: str(row["reason"]))
            yield Flag(f"{status} frames", f"{_frames(study, len(rows))} {status}", meaning, advice, places)


def _restarts(study: Study) -> Iterator[Flag]:
    if "restarted" not in study.cells:
        return
    rows = _ok(study)[_words(_ok(study)["restarted"]) != ""]
    if len(rows):
        yield Flag(
            "tracking restarts",
            f"tracking started anew in {_frames(study, len(rows))}",
            "A sector is the same place of the cell before and after only as far as the shape tells; "
            "velocity is unknown across the restart.",
            "Compare sectors within the stretches between restarts.",
            _places(rows, lambda row: str(row["restarted"])),
        )


def _residuals(study: Study) -> Iterator[Flag]:
    if "tracking_residual" not in study.cells:
        return
    pixel, unit = study.provenance.get("pixel_size_um") or 1.0, study.provenance.get("length_unit", "px")
    rows = _ok(study)[_ok(study)["tracking_residual"] > LARGEST_RESIDUAL_PX * pixel]
    if len(rows):
        yield Flag(
            "tracking residual",
            f"tracking is unsure in {_frames(study, len(rows))}",
            f"Boundary points carried on and back again miss their start by more than "
            f"{LARGEST_RESIDUAL_PX * pixel:.3g} {unit}: sectors may have slid along the edge there.",
            "Look at the outlines before and after; a mask that lost or gained a piece is the usual cause.",
            _places(rows, lambda row: f"{row['tracking_residual']:.3g} {unit}"),
        )


def _order(study: Study) -> Iterator[Flag]:
    if "order_violations" not in study.cells:
        return
    rows = _ok(study)[_ok(study)["order_violations"] > 0]
    if len(rows):
        yield Flag(
            "order violations",
            f"boundary points changed their order in {_frames(study, len(rows))}",
            "The tracker put neighbouring points past each other; they were put back in order, which moves "
            "them along the edge.",
            "Use --tracker matching, which keeps the order.",
            _places(rows, lambda row: _count(int(row["order_violations"]), "point")),
        )


def _area_jumps(study: Study) -> Iterator[Flag]:
    if not study.is_movie:
        return
    places: list[Place] = []
    for cell, rows in _ok(study).groupby("cell"):
        time, area = rows["time"].to_numpy(), np.log(rows["area"].to_numpy(dtype=np.float64))
        step = np.where(np.diff(time) == 1, np.diff(area), np.nan)
        bar = max(float(np.log1p(LARGEST_AREA_STEP)), AREA_STEP_SPREADS * _spread(step))
        at = np.flatnonzero(np.abs(step) > bar)
        places += [
            Place(int(str(cell)), int(time[k + 1]), f"{np.expm1(step[k]):+.0%}".replace("-", "−")) for k in at
        ]
    if places:
        yield Flag(
            "area jumps",
            f"the mask's area jumps in {_frames(study, len(places))}",
            "Cells do not gain or lose so much at once: the mask did. Windows and velocity are wrong there.",
            "Look at the mask; correct the segmentation or leave the frames out.",
            tuple(places),
        )


def _fast_edge(study: Study) -> Iterator[Flag]:
    if not study.is_movie:
        return
    unit, edge = study.provenance.get("velocity_unit", ""), study.edge
    pixel = (study.provenance.get("pixel_size_um") or 1.0) / (study.provenance.get("frame_interval_s") or 1.0)
    places: list[Place] = []
    for cell, rows in edge.groupby("cell"):
        speed = rows["velocity"].abs()
        bar = max(SMALLEST_FAST_STEP_PX * pixel, VELOCITY_SPREADS * _spread(rows["velocity"].to_numpy()))
        for time, fast in rows[speed > bar].groupby("time"):
            top = fast.iloc[int(np.abs(fast["velocity"].to_numpy()).argmax())]
            note = f"up to {top['velocity']:+.3g} {unit} in sector {int(top['sector'])}".replace("-", "−")
            places.append(Place(int(str(cell)), int(str(time)), note))
    if places:
        yield Flag(
            "velocity outliers",
            f"the edge leaps in {_frames(study, len(places))}",
            f"A velocity more than {VELOCITY_SPREADS:g} times the cell's usual spread is nearly always a "
            "mask that lost or gained a piece between this frame and the next.",
            "Look at both frames; leave these sectors out of averages of velocity.",
            tuple(places),
        )


def _doubts(study: Study) -> Iterator[Flag]:
    if "doubts" not in study.cells:
        return
    rows = study.cells[_words(study.cells["doubts"]) != ""]
    if len(rows):
        yield Flag(
            "masks in doubt",
            f"{_frames(study, len(rows))} may not be one whole cell",
            "Cleaning the mask changed much, or the cell is not where it was.",
            "Look at the mask; correct the segmentation or leave it out.",
            _places(rows, lambda row: str(row["doubts"])),
        )


def _border(study: Study) -> Iterator[Flag]:
    if "touches_border" not in study.cells:
        return
    rows = _ok(study)[_ok(study)["touches_border"].fillna(False).astype(bool)]
    if len(rows):
        yield Flag(
            "image border",
            f"the cell touches the image's border in {_frames(study, len(rows))}",
            "Part of the cell may lie outside; layer 0 there is a cut, not an edge, and has no velocity.",
            "Leave the sectors at the border out, or take a movie with the whole cell in view.",
            _places(rows, lambda row: f"{row['border_share']:.0%} of the edge"),
        )


def _distortion(study: Study) -> Iterator[Flag]:
    rows = _ok(study)
    rows = rows[rows["area_distortion"] > LARGEST_DISTORTION] if "area_distortion" in rows else rows[:0]
    if len(rows):
        yield Flag(
            "strong distortion",
            f"windows differ much in area in {_frames(study, len(rows))}",
            f"The map's mean area error is above {LARGEST_DISTORTION:.0%}, as in cells with long thin arms: "
            "windows of one layer hold unequal shares of the cell.",
            "Weigh windows by their area, or use fewer and larger windows.",
            _places(rows, lambda row: f"{row['area_distortion']:.0%}"),
        )


def _nan_pixels(study: Study) -> Iterator[Flag]:
    if "nan_px" not in study.cells:
        return
    rows = study.cells[study.cells["nan_px"].fillna(0) > 0]
    if len(rows):
        yield Flag(
            "NaN pixels",
            f"the signal has pixels without a number (NaN) inside the cell in {_frames(study, len(rows))}",
            "Windows with such pixels have no mean (--nan propagate) or the mean of the rest (--nan omit).",
            "Find the step of the image processing that divides by zero.",
            _places(rows, lambda row: f"{int(row['nan_px'])} px"),
        )


def _drift(study: Study) -> Iterator[Flag]:
    drifts = signal_drifts(study) if study.is_movie else []
    if drifts:
        yield Flag(
            "signal drift",
            f"the mean signal drifts in {_count(len({drift.cell for drift in drifts}), 'cell')}",
            "The whole cell fades (bleaching, focus) or brightens over the movie: correlations in time and "
            "comparisons of early with late frames feel it.",
            "Correct for bleaching before the run, or correlate with a trend taken out (--detrend).",
            tuple(Place(drift.cell, None, drift.words) for drift in drifts),
        )


def _spread(values: Any) -> float:
    """Robust standard deviation of the finite values; 0 if there are none."""
    finite = np.asarray(values, dtype=np.float64)
    finite = finite[np.isfinite(finite)]
    return float(_MAD_TO_SD * np.median(np.abs(finite - np.median(finite)))) if finite.size else 0.0


def _other_warnings(study: Study, found: Sequence[Flag]) -> Iterator[Flag]:
    """Warnings of the run that no other flag tells already."""
    told = {(place.cell, place.time) for flag in found for place in flag.places}
    heads = tuple(f"cell {cell}, frame {time}:" for cell, time in told)
    warnings = [str(words) for words in study.provenance.get("warnings", [])]
    other = [words for words in warnings if not words.startswith(heads)]
    if other:
        yield Flag(
            "warnings",
            f"{_count(len(other), 'warning')} of the run: " + "; ".join(other[:5]),
            "The run went on, but something was out of the ordinary.",
            "Read them all in provenance.json.",
        )


_RULES: tuple[Callable[[Study], Iterator[Flag]], ...] = (
    _without_map,
    _doubts,
    _area_jumps,
    _fast_edge,
    _residuals,
    _order,
    _restarts,
    _border,
    _drift,
    _distortion,
    _nan_pixels,
)
