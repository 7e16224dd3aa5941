"""Settings of a correlation, read for drawing: what it used of a movie, and words for how it was made."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, IntArray

_FEWEST_FRAMES = 10  # at a lag, unless the user asks for others


def settings_words(settings: Mapping[str, Any]) -> list[str]:
    """How a correlation was made, as far as it was not as usual.

    Parameters
    ----------
    settings : dict
        `settings` of a study's correlation.

    Returns
    -------
    list of str
        Such as "linear detrending" and "without lags −1, 0"; empty for the defaults.
    """
    facts = [f"“{settings['name']}”"] if settings.get("name") else []
    if settings.get("statistic", "pearson") != "pearson":
        facts.append("Spearman (ranks)")
    facts += detrending(settings)
    if settings.get("difference"):
        facts.append("differences between frames")
    if skipped := settings.get("skip_lags"):
        lags = ", ".join(f"{lag:g}" for lag in skipped).replace("-", "−")
        facts.append(f"without lag{'s' * (len(skipped) > 1)} {lags}")
    facts += scope_words(settings)
    if settings.get("rule", "nearest") != "nearest":
        facts.append("largest peak")
    if settings.get("null", "phase") != "phase":
        facts.append("surrogates by circular shift")
    if settings.get("surrogates") == 0:
        facts.append("no surrogates")
    if settings.get("geometry") is False:
        facts.append("geometry was not tested")
    if settings.get("min_pairs", _FEWEST_FRAMES) != _FEWEST_FRAMES:
        facts.append(f"{settings['min_pairs']} or more frames at a lag")
    return facts


def detrending(settings: Mapping[str, Any]) -> list[str]:
    """Words for the detrending; none for none."""
    kind = settings.get("detrend", "none")
    if kind == "none":
        return []
    frames = settings.get("detrend_frames")
    return [f"{kind} detrending" + (f" ({frames} frames)" if kind == "median" and frames else "")]


def scope_words(settings: Mapping[str, Any]) -> list[str]:
    """Words for the sectors and frames used; none for all."""
    words = {"sectors": "only sectors", "frames": "only frames", "without_frames": "without frames"}
    facts = []
    for name, what in words.items():
        parts = [f"{low}–{high}" if low != high else f"{low}" for low, high in _ranges(settings, name)]
        if parts:
            facts.append(f"{what} {', '.join(parts)}")
    return facts


def used_windows(settings: Mapping[str, Any], first: int, frames: int, sectors: int) -> BoolArray:
    """Which frames and sectors of a movie a correlation used.

    Parameters
    ----------
    settings : dict
        `settings` of a study's correlation.
    first : int
        Number of the cell's first frame.
    frames, sectors : int
        Numbers of frames and sectors of the cell.

    Returns
    -------
    ndarray of shape (frames, sectors) and dtype bool
    """
    times, places = np.arange(first, first + frames), np.arange(sectors)
    used = _within(times, _ranges(settings, "frames"))[:, None] & _within(
        places, _ranges(settings, "sectors")
    )
    if left_out := _ranges(settings, "without_frames"):
        used &= ~_within(times, left_out)[:, None]
    return used


def _within(numbers: IntArray, ranges: list[tuple[int, int]]) -> BoolArray:
    """Which numbers are in any range, where there are ranges; one may go around the end, as 50 to 5."""
    inside = np.full(numbers.shape, not ranges)
    for low, high in ranges:
        after, before = numbers >= low, numbers <= high
        inside |= (after & before) if low <= high else (after | before)
    return inside


def _ranges(settings: Mapping[str, Any], name: str) -> list[tuple[int, int]]:
    """First and last of what was chosen: one pair for sectors and frames, runs of numbers else."""
    chosen = [int(one) for one in settings.get(name) or []]
    if name != "without_frames":
        return [(chosen[0], chosen[1])] if chosen else []
    numbers = sorted(set(chosen))
    breaks = [k + 1 for k, (here, there) in enumerate(pairwise(numbers)) if there != here + 1]
    parts = [numbers[low:high] for low, high in pairwise([0, *breaks, len(numbers)])]
    return [(part[0], part[-1]) for part in parts if part]
