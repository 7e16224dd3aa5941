"""QC flags of motion and of trends in time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag, counted, frames_of
from cytodisk.runs.qc_flags.signal_drift import signal_drifts
from cytodisk.store.study import Study

VELOCITY_SPREADS = 15.0
"""Edge velocities beyond so many robust standard deviations of the cell's own are flagged."""
SMALLEST_FAST_STEP_PX = 3.0
"""Motion of the edge in a frame, in px, that is never flagged."""

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
            places.append(Place(int(str(cell)), int(str(frame)), note, sector))
    if places:
        yield QCFlag(
            "velocity outliers",
            f"the edge leaps in {frames_of(study, len(places))}",
            f"A velocity more than {VELOCITY_SPREADS:g} times the cell's usual spread is nearly always a "
            "mask that lost or gained a piece between this frame and the next.",
            "Look at both frames; leave these sectors out of averages of velocity.",
            tuple(places),
        )


def drift(study: Study) -> Iterator[QCFlag]:
    drifts = signal_drifts(study) if study.is_movie else []
    if drifts:
        yield QCFlag(
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
