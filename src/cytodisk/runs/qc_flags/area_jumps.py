"""Leaps of a mask's area, told from growth and from the cell's own restlessness."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag, frames_of, mapped_rows
from cytodisk.store.study import Study

LARGEST_AREA_STEP = 0.05
"""Relative change of area from a frame to the next that is never flagged."""
AREA_STEP_SPREADS = 5.0
"""Changes beyond so many standard deviations of the cell's own about their trend are flagged."""

_NEAR = 3  # steps before and after that tell the trend of a step
_FEWEST_NEAR = 3
_BACK = 0.5  # of a leap that may be left when the next step has taken it back
_QUIET_SHARE = 0.4  # of steps that tell the spread: leaps are among the others
_QUIET_SDS = 0.5244  # standard deviations that so many of a normal distribution stay below


def area_jumps(study: Study) -> Iterator[QCFlag]:
    """Frames whose mask leaps."""
    if not study.is_movie:
        return
    places: list[Place] = []
    for cell, rows in mapped_rows(study).groupby("cell"):
        frame, area = rows["frame"].to_numpy(), rows["area"].to_numpy(dtype=np.float64)
        step = np.where(np.diff(frame) == 1, np.diff(np.log(area)), np.nan)
        places += [
            Place(int(str(cell)), int(frame[k + 1]), f"{np.expm1(step[k]):+.0%}".replace("-", "−"))
            for k in without_returns(leaps(step), step)
        ]
    if places:
        yield QCFlag(
            "area jumps",
            f"the mask's area jumps in {frames_of(study, len(places))}",
            "Cells do not gain or lose so much at once: the mask did. Windows and velocity are wrong there.",
            "Look at the mask; correct the segmentation or leave the frames out.",
            tuple(places),
        )


def leaps(step: FloatArray) -> list[int]:
    """Steps that neither the trend around them nor the spread of the others explains.

    A cell that grows by 3 % in each frame does not leap; one that grows by 3 % and then by 10 % does. The
    spread comes from the quietest steps alone, so that several leaps do not hide each other.

    Parameters
    ----------
    step : ndarray of shape (T - 1,) and dtype float
        Change of ln(area) from each frame to the next; NaN where a frame is missing.

    Returns
    -------
    list of int
    """
    off = np.abs(step - _trend(step))
    known = off[np.isfinite(off)]
    if not known.size:
        return []
    spread = float(np.quantile(known, _QUIET_SHARE)) / _QUIET_SDS
    bar = max(float(np.log1p(LARGEST_AREA_STEP)), AREA_STEP_SPREADS * spread)
    return [int(k) for k in np.flatnonzero(np.minimum(off, np.abs(step)) > bar)]


def without_returns(found: list[int], step: FloatArray) -> list[int]:
    """Leaps without those that take back the one before: the mask is right again then.

    Parameters
    ----------
    found : list of int
        Of `leaps`.
    step : ndarray of shape (T - 1,) and dtype float

    Returns
    -------
    list of int
    """
    own = step - _trend(step)
    kept: list[int] = []
    for k in found:
        after_leap = bool(kept) and kept[-1] == k - 1
        if not (after_leap and abs(own[k - 1] + own[k]) < _BACK * abs(own[k - 1])):
            kept.append(k)
    return kept


def _trend(step: FloatArray) -> FloatArray:
    """Median of the steps around each one, without itself; 0 where there are few."""
    trend = np.zeros(len(step))
    for k in range(len(step)):
        near = np.concatenate([step[max(0, k - _NEAR) : k], step[k + 1 : k + 1 + _NEAR]])
        near = near[np.isfinite(near)]
        if near.size >= _FEWEST_NEAR:
            trend[k] = np.median(near)
    return trend
