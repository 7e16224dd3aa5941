"""How much power a wave has beyond what its mode and its period alone have.

Neighbours that are alike have much power in few modes, at all periods. Sectors that oscillate each by itself
have much power at one period, in all modes. A wave has more at one mode and one period than both explain.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray

_FLOOR = 1e-3  # of the mean power at a frequency: modes with less count as if they had it
_PASSES = 2
_REWEIGHTED = 4  # least absolute deviations, by weights
_SLOPE_PRIOR = 4.0  # weight of a slope of 0, in values


@dataclass(frozen=True, eq=False)
class Background:
    """Power by mode and by frequency.

    Attributes
    ----------
    excess : ndarray of shape (K, C, R) and dtype float
        Natural logarithm of power over background.
    level, slope : ndarray of shape (M + 1, R) and dtype float
        Of each mode, over the logarithm of frequency less its mean: slow ones may be smoother than fast ones.
    """

    excess: FloatArray
    level: FloatArray
    slope: FloatArray


def background(power: FloatArray, frequencies: FloatArray) -> Background:
    """What modes and frequencies explain.

    Parameters
    ----------
    power : ndarray of shape (K, C, R) and dtype float
        Of `wave_cells`.
    frequencies : ndarray of shape (K,) and dtype float
    """
    floor = _FLOOR * power.mean(axis=1, keepdims=True) + np.finfo(np.float64).tiny
    logs = np.log(power + floor)
    modes = (power.shape[1] - 1) // 2
    abscissa = np.log(frequencies)
    abscissa = abscissa - abscissa.mean()
    level = np.zeros((modes + 1, power.shape[2]))
    slope = np.zeros_like(level)
    for _ in range(_PASSES):
        if modes:
            logs -= np.median(logs, axis=1, keepdims=True)
        for mode in range(modes + 1):
            cells = [mode, mode + modes][: 2 if mode else 1]
            a, b = _robust_line(logs[:, cells], abscissa)
            logs[:, cells] -= (a + abscissa[:, None] * b)[:, None]
            level[mode] += a
            slope[mode] += b
    return Background(logs, level, slope)


def wave_scores(power: FloatArray, excess: FloatArray, variance: FloatArray, visible: int) -> FloatArray:
    """Share of the variance that each wave carries, times the logarithm of its excess; below 0 counts as 0.

    Parameters
    ----------
    power, excess : ndarray of shape (K, 2 M + 1, R) and dtype float
    variance : ndarray of shape (R,) and dtype float
        Of all sectors through time.
    visible : int
        How many frequencies are looked for.

    Returns
    -------
    ndarray of shape (visible, 3 M + 1, R) and dtype float
        Of each wave, then of both directions of modes 1 to M together: standing waves.
    """
    share, excess = power[:visible] / variance, excess[:visible]
    modes = (power.shape[1] - 1) // 2
    up, down = slice(1, modes + 1), slice(modes + 1, None)
    both = np.logaddexp(excess[:, up], excess[:, down]) - np.log(2.0)
    shares = np.concatenate([share, share[:, up] + share[:, down]], axis=1)
    return np.asarray(shares * np.maximum(np.concatenate([excess, both], axis=1), 0.0))


def with_sums(power: FloatArray, sums: FloatArray) -> FloatArray:
    """Power of surrogates (K, C, R), at each frequency with the sum (K,) over waves that the movie has."""
    return np.asarray(power * (sums[:, None, None] / power.sum(axis=1, keepdims=True)))


def _robust_line(values: FloatArray, abscissa: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Level and slope of least absolute deviations through values (K, C, R), each of shape (R,)."""
    x = abscissa[:, None, None]
    level = np.median(values, axis=(0, 1))
    slope = np.zeros_like(level)
    for _ in range(_REWEIGHTED):
        weight = 1.0 / np.maximum(np.abs(values - level - x * slope), 0.1)
        total = weight.sum(axis=(0, 1))
        mean_x, mean = (weight * x).sum(axis=(0, 1)) / total, (weight * values).sum(axis=(0, 1)) / total
        square = (weight * (x - mean_x) ** 2).sum(axis=(0, 1))
        slope = (weight * (x - mean_x) * (values - mean)).sum(axis=(0, 1)) / (square + _SLOPE_PRIOR)
        level = mean - slope * mean_x
    return level, slope
