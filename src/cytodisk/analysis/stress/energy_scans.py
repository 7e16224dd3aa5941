"""Where the energy of two sets of series lies together: in a few frames, in an episode, towards one end.

All functions take energies of shape (T, …), of a movie and of its surrogates side by side.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray, IntArray

PULSE_FRAMES = 3
_AROUND = 9  # frames: a pulse has little beside it, an episode has
_WIDTHS = 12  # of episodes, from the shortest to half of the movie
_SHORTEST_EPISODE = 5  # frames
_STEEPEST = 2.0  # log of the spread at the end over that in the middle
_SLOPES = np.linspace(0.1, _STEEPEST, 20)


class Pulse(NamedTuple):
    """The run of three frames with the most joint energy.

    Attributes
    ----------
    share : ndarray of shape (…)
        Of the sum over all frames of the product of both energies, at the lag where it is largest.
    sharpness : ndarray of shape (…)
        That of the three frames over that of the nine around them.
    first, lag : ndarray of shape (…) and dtype int
        First frame of the run in `a`, and how much later it is in `b`.
    """

    share: FloatArray
    sharpness: FloatArray
    first: IntArray
    lag: IntArray


class Episode(NamedTuple):
    """The episode in which both have more energy than outside.

    Attributes
    ----------
    gain : ndarray of shape (…)
        Log-likelihood that it gains over a steady energy, per window; the smaller of both.
    ratio : ndarray of shape (…)
        Energy inside over that outside; the smaller of both.
    first, frames : ndarray of shape (…) and dtype int
    """

    gain: FloatArray
    ratio: FloatArray
    first: IntArray
    frames: IntArray


class Ramp(NamedTuple):
    """Energy of both that rises, or falls, from one end to the other.

    Attributes
    ----------
    gain : ndarray of shape (…)
        As of an episode.
    ratio : ndarray of shape (…)
        Energy of the later half over that of the earlier; of both the one nearer to 1. 1 if one rises and
        one falls.
    """

    gain: FloatArray
    ratio: FloatArray


def common_pulse(a: FloatArray, b: FloatArray, max_lag: int) -> Pulse:
    """The three frames with the most joint energy, at any lag."""
    frames, shape = len(a), a.shape[1:]
    share, sharpness = np.zeros((2, *shape))
    first, at = np.zeros((2, *shape), dtype=np.int64)
    for lag in range(-max_lag, max_lag + 1):
        start = max(0, -lag)
        joint = a[start : frames - max(0, lag)] * b[max(0, lag) : frames + min(0, lag)]
        runs = _runs(joint, PULSE_FRAMES)
        place = runs.argmax(axis=0)
        top = np.take_along_axis(runs, place[None], axis=0)[0]
        wide = np.pad(joint, [((_AROUND - PULSE_FRAMES) // 2,) * 2, *[(0, 0)] * len(shape)])
        around = np.take_along_axis(_runs(wide, _AROUND), place[None], axis=0)[0]
        # a lag with fewer pairs must not look more concentrated for that alone
        here = top / joint.sum(axis=0) * (len(joint) / frames)
        better = here > share
        share, sharpness = np.where(better, here, share), np.where(better, top / around, sharpness)
        first, at = np.where(better, place + start, first), np.where(better, lag, at)
    return Pulse(share, sharpness, first, at)


def restless_episode(a: FloatArray, b: FloatArray) -> Episode:
    """The stretch, up to half of the movie, that best tells more energy of both inside from less outside."""
    frames, shape = len(a), a.shape[1:]
    gain, ratio = np.zeros(shape), np.ones(shape)
    first, length = np.zeros((2, *shape), dtype=np.int64)
    longest = max(frames // 2, _SHORTEST_EPISODE)
    for width in np.unique(np.geomspace(_SHORTEST_EPISODE, longest, _WIDTHS).round().astype(int)):
        gains, ratios = zip(*(_inside(energy, int(width)) for energy in (a, b)), strict=True)
        gains_of_both, ratios_of_both = np.minimum(*gains), np.minimum(*ratios)
        place = gains_of_both.argmax(axis=0)[None]
        here = np.take_along_axis(gains_of_both, place, axis=0)[0]
        better = here > gain
        gain = np.where(better, here, gain)
        ratio = np.where(better, np.take_along_axis(ratios_of_both, place, axis=0)[0], ratio)
        first, length = np.where(better, place[0], first), np.where(better, width, length)
    return Episode(gain, ratio, first, length)


def variance_ramp(a: FloatArray, b: FloatArray) -> Ramp:
    """How well a spread that changes exponentially tells the energy of both, in the same direction."""
    time = np.linspace(-1.0, 1.0, len(a)).reshape(-1, *[1] * (a.ndim - 1))
    of_both = []
    for direction in (1.0, -1.0):
        gains = []
        for energy in (a, b):
            steady = np.log(energy.mean(axis=0))
            tried = [np.log((energy * np.exp(-2.0 * direction * s * time)).mean(axis=0)) for s in _SLOPES]
            gains.append(0.5 * len(a) * (steady - np.min(tried, axis=0)))
        of_both.append(np.minimum(*gains))
    half = len(a) // 2
    change = [np.log(energy[-half:].mean(axis=0) / energy[:half].mean(axis=0)) for energy in (a, b)]
    smaller = np.where(np.abs(change[0]) < np.abs(change[1]), change[0], change[1])
    together = np.sign(change[0]) == np.sign(change[1])
    return Ramp(np.maximum(np.max(of_both, axis=0), 0.0), np.where(together, np.exp(smaller), 1.0))


def _runs(values: FloatArray, width: int) -> FloatArray:
    """Sums over all runs of so many frames."""
    start = np.zeros((1, *values.shape[1:]))
    sums = np.concatenate([start, np.cumsum(values, axis=0)])
    return np.asarray(sums[width:] - sums[:-width])


def _inside(energy: FloatArray, width: int) -> tuple[FloatArray, FloatArray]:
    """Gain in log-likelihood, none if calmer inside, and ratio of energies, of all episodes of a width."""
    frames, total = len(energy), energy.sum(axis=0)
    inside = _runs(energy, width)
    outside = (total - inside) / (frames - width)
    inside = inside / width
    ratio = inside / np.maximum(outside, 1e-12)
    gain = 0.5 * (
        frames * np.log(total / frames)
        - width * np.log(inside)
        - (frames - width) * np.log(np.maximum(outside, 1e-12))
    )
    return np.where(ratio > 1.0, gain, 0.0), ratio
