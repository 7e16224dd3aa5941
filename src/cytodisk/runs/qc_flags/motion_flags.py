"""QC flags of motion and of trends in time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.number_words import counted, rounded
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag, frames_of, mapped_rows, places_of
from cytodisk.runs.qc_flags.remedy import correlate_again, run_again, without_frames
from cytodisk.runs.qc_flags.signal_drift import signal_drifts
from cytodisk.store.study import Study

VELOCITY_SPREADS = 15.0
"""Edge velocities beyond so many robust standard deviations of the cell's own are flagged."""
SMALLEST_FAST_STEP_PX = 3.0
"""Motion of the edge in a frame, in px, that is never flagged."""

SWEPT_SHARE = 1.25
"""Area that the edge may sweep, over area won and lost."""
SWEPT_REACH_PX = 0.1
"""Area that it may sweep besides, in px for each px of perimeter: the pixels of a mask make so much."""

_MAD_TO_SD = 1.4826  # of a normal distribution


def fast_edge(study: Study) -> Iterator[QCFlag]:
    if not study.is_movie:
        return
    scale = study.scale
    places: list[Place] = []
    for cell, rows in study.edge.groupby("cell"):
        speed = rows["velocity"].abs()
        bar = max(
            scale.velocity(SMALLEST_FAST_STEP_PX), VELOCITY_SPREADS * _spread(rows["velocity"].to_numpy())
        )
        for frame, fast in rows[speed > bar].groupby("frame"):
            top = fast.iloc[int(np.abs(fast["velocity"].to_numpy()).argmax())]
            sector = int(top["sector"])
            note = f"up to {top['velocity']:+.2g} {scale.velocity_unit} in sector {sector}".replace("-", "−")
            places.append(Place(int(str(cell)), int(str(frame)), note, sector, int(str(frame)) + 1))
    if places:
        yield QCFlag(
            "velocity outliers",
            f"the edge leaps in {frames_of(study, len(places))}",
            f"A velocity more than {VELOCITY_SPREADS:g} times the cell's usual spread is nearly always a "
            "mask that lost or gained a piece between this frame and the next.",
            "Look at both masks, and correct the wrong one." + without_frames(study, places, after=1),
            tuple(places),
        )


def edge_mismatch(study: Study) -> Iterator[QCFlag]:
    """Frames in which the pieces of the edge sweep more area than the cell won and lost."""
    if not study.is_movie or "swept_area" not in study.cells:
        return
    changed = study.edge.groupby(["cell", "frame"])[["protruded_area", "retracted_area"]].sum().sum(axis=1)
    rows = mapped_rows(study)
    before = pd.MultiIndex.from_arrays([rows["cell"], rows["frame"] - 1])
    allowed = SWEPT_SHARE * changed.reindex(before).to_numpy()
    allowed += study.scale.length(SWEPT_REACH_PX) * rows["perimeter"].to_numpy()
    swept = rows["swept_area"].to_numpy(dtype=np.float64)
    rows = rows[swept > allowed]
    if len(rows):
        yield QCFlag(
            "edge mismatch",
            f"the edge may be matched to the wrong place in {frames_of(study, len(rows))}",
            "Pieces of the edge sweep clearly more area on their way from the frame before than the cell won "
            "and lost: some go to the wrong piece of edge. Velocities there are too large, and sectors may "
            "have slid.",
            "Look at the outlines of both frames: is a mask wrong there? If the cell moves far between "
            "frames, take them more often; if it was turned wrongly: "
            + run_again(study, "not_registered", registration=False),
            places_of(rows, lambda row: f"{rounded(row['swept_area'])} {study.scale.area_unit} swept"),
        )


def drift(study: Study) -> Iterator[QCFlag]:
    drifts = signal_drifts(study) if study.is_movie else []
    if drifts:
        yield QCFlag(
            "signal drift",
            f"the mean signal drifts in {counted(len({drift.cell for drift in drifts}), 'cell')}",
            "The whole cell fades (bleaching, focus) or brightens over the movie: correlations in time and "
            "comparisons of early with late frames feel it.",
            "Correct for bleaching before the run, or correlate with a trend taken out: "
            + correlate_again(study, (drifts[0].channel, "velocity"), "without_trend", detrend="linear"),
            tuple(Place(drift.cell, None, drift.words) for drift in drifts),
        )


def _spread(values: Any) -> float:
    """Robust standard deviation about 0 of the finite values; 0 if there are none."""
    finite = np.asarray(values, dtype=np.float64)
    finite = finite[np.isfinite(finite)]
    return float(_MAD_TO_SD * np.median(np.abs(finite))) if finite.size else 0.0
