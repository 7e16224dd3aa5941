"""What speaks against a correlation, as the second half of a sentence."""

from __future__ import annotations

from collections.abc import Sequence

from cytodisk.analysis.stress.stress_marks import (
    COMMON_PULSE,
    HEAVY_TAILS,
    RESTLESS_EPISODE,
    STEADY_OSCILLATION,
    VARIANCE_CHANGE,
)
from cytodisk.runs.correlate.verdict import (
    DRIFTING,
    GEOMETRY_UNTESTED,
    JITTER,
    JITTER_UNKNOWN,
    RESTARTED,
    JudgedPeak,
)
from cytodisk.runs.findings.finding import listed
from cytodisk.runs.findings.layer_names import numbers_words
from cytodisk.runs.predict.prediction_verdict import WEAKER
from cytodisk.runs.qc_flags.qc_flag import QCFlag

_KINDS = ("layer", "cluster")
_DOUBTS = {
    JITTER: "masks that jitter make a correlation at this lag by themselves",
    JITTER_UNKNOWN: "there are too few frames to see whether masks that jitter made it",
    GEOMETRY_UNTESTED: "what the motion of the cell alone would give was not tested",
    DRIFTING: "the level of many series drifts, and two trends correlate whatever they come from",
    RESTARTED: "tracking started anew, so that sectors need not be the same places throughout",
    COMMON_PULSE: "a single pulse of the whole cell may have made it",
    RESTLESS_EPISODE: "a single restless episode may have made it",
    VARIANCE_CHANGE: "the fluctuations grow or shrink in the movie, which makes p too small",
    STEADY_OSCILLATION: "two steady oscillations always agree at some lag",
    HEAVY_TAILS: "a few extreme values may have made it",
    WEAKER: "it is the weaker of both directions, and noise of measurement alone may make it",
}
_BEARING = (
    "unreadable frames",
    "area jumps",
    "implausible scale",
    "velocity outliers",
    "edge mismatch",
    "tracking residual",
    "order violations",
    "tracking restarts",
    "interior restarts",
    "coarse outline",
    "saturated signal",
    "clipped signal",
    "signal drift",
)
"""QC flags of a run that bear on what moves, and on its signal in time."""

_BEARING_ON_CELLS = (
    "flagged masks",
    "implausible scale",
    "saturated signal",
    "clipped signal",
    "small windows",
    "strong distortion",
    "background",
)


def doubt_words(doubts: Sequence[str]) -> str:
    """Doubts of `judged_peaks` as the second half of a sentence.

    Parameters
    ----------
    doubts : sequence of str
        As "jitter"; one that has no words of its own stands as it is, as "without geometry not known".
    """
    own = [_DOUBTS.get(doubt, f"its size {doubt.replace(' not', ' is not')}") for doubt in doubts]
    return ", and ".join(own)


def doubted_words(peaks: Sequence[JudgedPeak], without: str) -> str:
    """Layers and clusters with what speaks against them, as "layers 1–3 (jitter)".

    Parameters
    ----------
    peaks : sequence of JudgedPeak
    without : str
        Of `without_words`.

    Returns
    -------
    str
    """
    groups: dict[str, list[JudgedPeak]] = {}
    for peak in peaks:
        why = ", ".join([*peak.doubts, *[f"not {without}"] * peak.lost])
        groups.setdefault(why, []).append(peak)
    return listed([f"{_names(alike)} ({why})" for why, alike in groups.items()])


def _names(peaks: Sequence[JudgedPeak]) -> str:
    numbers = {kind: [int(peak.row[kind]) for peak in peaks if peak.kind == kind] for kind in _KINDS}
    return ", ".join(numbers_words(kind, numbers[kind]) for kind in _KINDS if numbers[kind])


def bearing_flags(flags: Sequence[QCFlag], cell: int | None = None) -> list[str]:
    """Names of the QC flags of a run that bear on its numbers.

    Parameters
    ----------
    flags : sequence of QCFlag
    cell : int, optional
        Of a movie, the cell that is told of: only its flags, and those that bear on motion and time. Without
        it, those that bear on single cells.
    """
    names = _BEARING_ON_CELLS if cell is None else _BEARING
    told = [
        flag.name
        for flag in flags
        if flag.name in names
        and (cell is None or not flag.places or any(place.cell == cell for place in flag.places))
    ]
    return list(dict.fromkeys(told))
