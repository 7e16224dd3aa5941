"""Red flags of tracking, of motion, and of trends in time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.pages.report.drift import signal_drifts
from cytodisk.pages.report.flag import Flag, Place, counted, frames_of, mapped_rows, places_of, words_in
from cytodisk.store.study import Study

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


def restarts(study: Study) -> Iterator[Flag]:
    if "restarted" not in study.cells:
        return
    rows = mapped_rows(study)[words_in(mapped_rows(study)["restarted"]) != ""]
    if len(rows):
        yield Flag(
            "tracking restarts",
            f"tracking started anew in {frames_of(study, len(rows))}",
            "A sector is the same place of the cell before and after only as far as the shape tells; "
            "velocity is unknown across the restart.",
            "Compare sectors within the stretches between restarts.",
            places_of(rows, lambda row: str(row["restarted"])),
        )


def residuals(study: Study) -> Iterator[Flag]:
    if "tracking_residual" not in study.cells:
        return
    pixel, unit = study.provenance.get("pixel_size_um") or 1.0, study.provenance.get("length_unit", "px")
    rows = mapped_rows(study)[mapped_rows(study)["tracking_residual"] > LARGEST_RESIDUAL_PX * pixel]
    if len(rows):
        yield Flag(
            "tracking residual",
            f"tracking is unsure in {frames_of(study, len(rows))}",
            f"Boundary points carried on and back again miss their start by more than "
            f"{LARGEST_RESIDUAL_PX * pixel:.3g} {unit}: sectors may have slid along the edge there.",
            "Look at the outlines before and after; a mask that lost or gained a piece is the usual cause.",
            places_of(rows, lambda row: f"{row['tracking_residual']:.3g} {unit}"),
        )


def order(study: Study) -> Iterator[Flag]:
    if "order_violations" not in study.cells:
        return
    rows = mapped_rows(study)[mapped_rows(study)["order_violations"] > 0]
    if len(rows):
        yield Flag(
            "order violations",
            f"boundary points changed their order in {frames_of(study, len(rows))}",
            "The tracker put neighbouring points past each other; they were put back in order, which moves "
            "them along the edge.",
            "Use --tracker matching, which keeps the order.",
            places_of(rows, lambda row: counted(int(row["order_violations"]), "point")),
        )


def area_jumps(study: Study) -> Iterator[Flag]:
    if not study.is_movie:
        return
    places: list[Place] = []
    for cell, rows in mapped_rows(study).groupby("cell"):
        time, area = rows["frame"].to_numpy(), np.log(rows["area"].to_numpy(dtype=np.float64))
        step = np.where(np.diff(time) == 1, np.diff(area), np.nan)
        bar = max(float(np.log1p(LARGEST_AREA_STEP)), AREA_STEP_SPREADS * _spread(step))
        at = np.flatnonzero(np.abs(step) > bar)
        places += [
            Place(int(str(cell)), int(time[k + 1]), f"{np.expm1(step[k]):+.0%}".replace("-", "−")) for k in at
        ]
    if places:
        yield Flag(
            "area jumps",
            f"the mask's area jumps in {frames_of(study, len(places))}",
            "Cells do not gain or lose so much at once: the mask did. Windows and velocity are wrong there.",
            "Look at the mask; correct the segmentation or leave the frames out.",
            tuple(places),
        )


def fast_edge(study: Study) -> Iterator[Flag]:
    if not study.is_movie:
        return
    unit, edge = study.provenance.get("velocity_unit", ""), study.edge
    pixel = (study.provenance.get("pixel_size_um") or 1.0) / (study.provenance.get("frame_interval_s") or 1.0)
    places: list[Place] = []
    for cell, rows in edge.groupby("cell"):
        speed = rows["velocity"].abs()
        bar = max(SMALLEST_FAST_STEP_PX * pixel, VELOCITY_SPREADS * _spread(rows["velocity"].to_numpy()))
        for time, fast in rows[speed > bar].groupby("frame"):
            top = fast.iloc[int(np.abs(fast["velocity"].to_numpy()).argmax())]
            sector = int(top["sector"])
            note = f"up to {top['velocity']:+.2g} {unit} in sector {sector}".replace("-", "−")
            places.append(Place(int(str(cell)), int(str(time)), note, sector))
    if places:
        yield Flag(
            "velocity outliers",
            f"the edge leaps in {frames_of(study, len(places))}",
            f"A velocity more than {VELOCITY_SPREADS:g} times the cell's usual spread is nearly always a "
            "mask that lost or gained a piece between this frame and the next.",
            "Look at both frames; leave these sectors out of averages of velocity.",
            tuple(places),
        )


def drift(study: Study) -> Iterator[Flag]:
    drifts = signal_drifts(study) if study.is_movie else []
    if drifts:
        yield Flag(
            "signal drift",
            f"the mean signal drifts in {counted(len({drift.cell for drift in drifts}), 'cell')}",
            "The whole cell fades (bleaching, focus) or brightens over the movie: correlations in time and "
            "comparisons of early with late frames feel it.",
            "Correct for bleaching before the run, or correlate with a trend taken out (--detrend).",
            tuple(Place(drift.cell, None, drift.words) for drift in drifts),
        )


def _spread(values: Any) -> float:
    """Robust standard deviation about 0 of the finite values; 0 if there are none."""
    finite = np.asarray(values, dtype=np.float64)
    finite = finite[np.isfinite(finite)]
    return float(_MAD_TO_SD * np.median(np.abs(finite))) if finite.size else 0.0
