"""Frames in which a nucleus leaps within its cell, or its area does: of a movie."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.runs.qc_flags.area_jumps import area_steps, leaps, without_returns
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag, frames_of, mapped_rows
from cytodisk.runs.qc_flags.remedy import without_frames
from cytodisk.store.study import Study

LARGEST_NUCLEUS_STEP = 0.25
"""Relative change of a nucleus' area from a frame to the next that is never flagged."""

_COLUMNS = ("nucleus_area", "nucleus_offset", "nucleus_direction")


def nucleus_jumps(study: Study) -> Iterator[QCFlag]:
    """Frames whose nucleus is by more than its radius elsewhere in the cell, or of quite another area."""
    rows = mapped_rows(study)
    if not study.is_movie or not {*_COLUMNS} <= set(rows):
        return
    places: list[Place] = []
    rows = rows[rows["nucleus_area"].notna()]
    for cell in rows["cell"].unique():
        own = rows[rows["cell"] == cell]
        frame = own["frame"].to_numpy()
        area = own["nucleus_area"].to_numpy(dtype=np.float64)
        moved = position_leaps(frame, _away_from_cell(own), np.sqrt(area / np.pi))
        step = area_steps(frame, area)
        grown = [
            k for k in without_returns(leaps(step), step) if abs(step[k]) > np.log1p(LARGEST_NUCLEUS_STEP)
        ]
        notes = {k: f"area {np.expm1(step[k]):+.0%}".replace("-", "−") for k in grown}
        notes |= {k: f"moves by {size:.1f} of its radius" for k, size in moved.items()}
        places += [Place(int(cell), int(frame[k + 1]), notes[k], None, int(frame[k])) for k in sorted(notes)]
    if places:
        yield QCFlag(
            "nucleus jumps",
            f"the nucleus jumps in {frames_of(study, len(places))}",
            "A nucleus does not get so far in its cell, or gain or lose so much, at once: its mask did, or "
            "the frames are of other times or cells than those of the masks. Windows of both compartments "
            "are wrong there.",
            "Look at both nuclei, and correct the wrong one." + without_frames(study, places),
            tuple(places),
        )


def position_leaps(frame: IntArray, away: FloatArray, radius: FloatArray) -> dict[int, float]:
    """Steps by which a nucleus moves farther in its cell than its radius.

    A step that takes back the one before is none: the mask is right again then.

    Parameters
    ----------
    frame : ndarray of shape (T,) and dtype int
    away : ndarray of shape (T, 2) and dtype float
        From the centroid of the cell to that of the nucleus.
    radius : ndarray of shape (T,) and dtype float
        Of a disk of the nucleus' area.

    Returns
    -------
    dict of int to float
        By the step's number, how far it goes, in radii.
    """
    found: dict[int, float] = {}
    for k in np.flatnonzero(np.diff(frame) == 1):
        least = float(min(radius[k : k + 2]))
        size = float(np.hypot(*(away[k + 1] - away[k]))) / least
        back = k - 1 in found and np.hypot(*(away[k + 1] - away[k - 1])) < min(radius[k - 1], radius[k + 1])
        if size > 1.0 and not back:
            found[int(k)] = size
    return found


def _away_from_cell(rows: pd.DataFrame) -> FloatArray:
    """From the cell's centroid to the nucleus', shape (T, 2); 0 where it has no direction."""
    towards = np.radians(rows["nucleus_direction"].fillna(0.0).to_numpy(dtype=np.float64))
    offset = np.where(rows["nucleus_direction"].isna(), 0.0, rows["nucleus_offset"])
    return np.asarray(-offset[:, None] * np.column_stack([np.sin(towards), np.cos(towards)]))
