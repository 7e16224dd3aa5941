"""Links between signals in words: what predicts what."""

from __future__ import annotations

import math
from typing import Any

import pandas as pd

from cytodisk.analysis.correlation.jitter_mark import JITTERING_SHARE
from cytodisk.runs.channel_names import VELOCITIES, shown_name

SURE_FRAMES = 60
"""Frames below which r = 0.3 is often missed, by `benchmarks/prediction_calibration.py --only frames`.

With 24 sectors whose neighbours are alike it is found in half of the cells of 45 frames, in 7 of 10 of 60,
and in 9 of 10 of 90.
"""

_EDGE = {"velocity": "edge velocity", "velocity_cell_frame": "edge velocity (cell frame)"}


def signal_words(name: str) -> str:
    """A signal in a sentence, as "Rac1", "signal 'edge'" or "edge velocity"."""
    if name in _EDGE:
        return _EDGE[name]
    shown = shown_name(name)
    return f"signal '{shown}'" if shown.islower() and " " not in shown else shown


def prediction_name(source: str = "", target: str = "", name: str = "") -> str:
    """Words for a prediction, as an item of `Study.predictions`: "Rac1 and velocity (early frames)"."""
    words = f"{shown_name(source)} and {shown_name(target)}" if source else "network"
    return f"{words} ({name})" if name else words


def less_error(gain: float) -> str:
    """A gain as the share by which the error of the prediction is smaller, as "4.2 % less error"."""
    share = 100.0 * (1.0 - math.exp(-gain))
    return f"{share:.2g} % less error" if share < 10.0 else f"{share:.0f} % less error"


def jitters(row: Any) -> bool:
    """Whether masks of a cell jitter, by its row in the table of cells; False where that is not known."""
    step, share = (pd.to_numeric(row[name]) for name in ("jitter", "velocity_jitter"))
    return bool(abs(step) > 0 or share >= JITTERING_SHARE)


def is_of_velocity(link: Any) -> bool:
    """Whether source or target of a link is a velocity of the edge."""
    return link["source"] in VELOCITIES or link["target"] in VELOCITIES


def effect_words(source: str, target: str, effect: float, turns: int = 0) -> str:
    """Whether more source is followed by more or less target, as "more Rac1 is followed by protrusion".

    Parameters
    ----------
    source, target : str
    effect : float
    turns : int
        The sign at first, where it changes with the lag; else 0. Coefficients stand beside the target's own
        past: where that goes on by itself, what only ends has the other sign, too.
    """
    more = (turns or effect) > 0
    words = f"{_begin(source)} is followed by {_what_follows(target, more)}"
    if not turns:
        return words
    other = _what_follows(target, not more)
    return f"{words} at first (later coefficients have the other sign: it ends, or turns to {other})"


def _begin(source: str) -> str:
    return "protrusion" if source in VELOCITIES else f"more {signal_words(source)}"


def _what_follows(target: str, more: bool) -> str:
    if target in VELOCITIES:
        return "protrusion" if more else "retraction"
    return f"{'more' if more else 'less'} {signal_words(target)}"
