"""Leaps and flicker of a mask's area, told from growth and from the cell's own restlessness."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.number_words import counted
from cytodisk.runs.qc_flags.qc_flag import Place, QCFlag, frames_of, mapped_rows
from cytodisk.runs.qc_flags.remedy import without_frames
from cytodisk.store.study import Study

LARGEST_AREA_STEP = 0.05
"""Relative change of area from a frame to the next that is never flagged."""
AREA_STEP_SPREADS = 5.0
"""Changes beyond so many standard deviations of the cell's own about their trend are flagged."""

JUMP_MEANING = (
    "Cells do not gain or lose so much at once: the mask did. Windows and velocity are wrong there."
)
JUMP_ADVICE = "Look at both masks, and correct the wrong one."

_LARGEST_OWN = np.log1p(0.25)  # step off the trend that the cell's own spread may explain
_FEW_STEPS = 3  # that tell no spread
_LARGEST_OF_FEW = np.log1p(0.1)
_FLICKER_SHARE = 0.25  # of steps that are large in a mask that flickers
_FLICKER_MEMORY = -0.25  # correlation of neighbouring steps: −0.5 if each frame has an error of its own
_CHANCE_SDS = 1.65  # that this correlation is below 0 by, at least
_NEAR = 3  # steps before and after that tell the trend of a step
_BACK = 0.5  # of a leap that may be left when the next step has taken it back
_QUIET_SHARE = 0.4  # of steps that tell the spread: leaps are among the others
_QUIET_SDS = 0.5244  # standard deviations that so many of a normal distribution stay below


def area_jumps(study: Study) -> Iterator[QCFlag]:
    """Frames whose mask leaps: of a movie, or of a stack of masks that plainly is one."""
    places: list[Place] = []
    flickering: list[tuple[float, str]] = []
    for cell, frame, area in _series(study):
        step = area_steps(frame, area)
        if not study.is_movie and not follows_one_cell(step):
            continue
        found = leaps(step)
        if flickers(step):
            size = float(np.expm1(np.median(np.abs(step[found]))))
            steps = int(np.isfinite(step).sum())
            flickering.append(
                (size, f"by ±{size:.0%} in {len(found)} of {counted(steps, 'step')} of cell {cell[0]}")
            )
        else:
            found = without_returns(found, step)
        places += [
            Place(
                int(cell[k + 1]),
                int(frame[k + 1]),
                f"{np.expm1(step[k]):+.0%}".replace("-", "−"),
                None,
                int(frame[k]),
            )
            for k in found
        ]
    if places:
        flicker = f"; it flickers from frame to frame, {max(flickering)[1]}" if flickering else ""
        yield QCFlag(
            "area jumps",
            f"the mask's area jumps in {frames_of(study, len(places))}{flicker}",
            JUMP_MEANING,
            JUMP_ADVICE + (without_frames(study, places) if study.is_movie else ""),
            tuple(places),
        )


def _series(study: Study) -> Iterator[tuple[IntArray, IntArray, FloatArray]]:
    """Cells, frames and areas of one cell each; without tracking, of one label of a file."""
    rows = mapped_rows(study)
    by = ["cell"] if study.is_movie else ["source", "label"]
    if not {*by} <= set(rows):
        return
    fewest = 1 if study.is_movie else _FEW_STEPS + 1  # most images have one frame and thousands of cells
    groups = rows.groupby(by).indices.values()
    cell, frame = rows["cell"].to_numpy(), rows["frame"].to_numpy()
    area = rows["area"].to_numpy(dtype=np.float64)
    if "excluded_px" in rows:  # a hole that comes or goes is no jump of the edge
        area = area + study.scale.area(rows["excluded_px"].fillna(0).to_numpy(dtype=np.float64))
    for one in groups:
        if len(one) >= fewest and len(np.unique(frame[one])) == len(one):
            yield cell[one], frame[one], area[one]


def area_steps(frame: IntArray, area: FloatArray) -> FloatArray:
    """Change of ln(area) from each frame to the next; NaN where a frame is missing, shape (T - 1,)."""
    return np.where(np.diff(frame) == 1, np.diff(np.log(area)), np.nan)


def follows_one_cell(step: FloatArray) -> bool:
    """Whether masks that nobody calls a movie are of one cell through time: most steps of area are small.

    Parameters
    ----------
    step : ndarray of shape (T - 1,) and dtype float
        Of `area_steps`.
    """
    known = np.abs(step[np.isfinite(step)])
    return bool(known.size >= _FEW_STEPS and np.median(known) <= np.log1p(LARGEST_AREA_STEP))


def leaps(step: FloatArray) -> list[int]:
    """Steps that neither the trend around them nor the spread of the others explains.

    A cell that grows by 3 % in each frame does not leap; one that grows by 3 % and then by 10 % does. The
    spread comes from the quietest steps alone, so that several leaps do not hide each other. It explains no
    step above 25 %, and none above 5 % in a mask that flickers. Three steps or fewer tell no spread: those
    above 10 % are leaps.

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
    least = float(np.log1p(LARGEST_AREA_STEP))
    if known.size <= _FEW_STEPS:
        bar = _LARGEST_OF_FEW
    elif flickers(step):
        bar = least
    else:
        spread = float(np.quantile(known, _QUIET_SHARE)) / _QUIET_SDS
        bar = min(max(least, AREA_STEP_SPREADS * spread), _LARGEST_OWN)
    return [int(k) for k in np.flatnonzero(np.minimum(off, np.abs(step)) > bar)]


def flickers(step: FloatArray) -> bool:
    """Whether the area goes up and down from frame to frame again and again, as segmentation does.

    A large share of the steps is above 5 %, and a step is followed by one of the opposite sign. In a cell
    that grows, pulses or protrudes, steps that follow one another are alike.

    Parameters
    ----------
    step : ndarray of shape (T - 1,) and dtype float
        Change of ln(area) from each frame to the next; NaN where a frame is missing.

    Returns
    -------
    bool
    """
    known = np.isfinite(step)
    if known.sum() <= _FEW_STEPS:
        return False
    change = step - np.mean(step[known])
    large = np.abs(change[known]) > np.log1p(LARGEST_AREA_STEP)
    product = change[1:] * change[:-1]
    product = product[np.isfinite(product)]
    if large.mean() < _FLICKER_SHARE or not product.size:
        return False
    memory = float(product.mean() / np.mean(change[known] ** 2))
    return memory < min(_FLICKER_MEMORY, -_CHANCE_SDS / float(np.sqrt(product.size)))


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
    """Median of the steps around each one, without itself; 0 where there is none."""
    trend = np.zeros(len(step))
    for k in range(len(step)):
        near = np.concatenate([step[max(0, k - _NEAR) : k], step[k + 1 : k + 1 + _NEAR]])
        near = near[np.isfinite(near)]
        if near.size:
            trend[k] = np.median(near)
    return trend
