"""How much power a wave has beyond what its mode and its period alone have.

Neighbours that are alike have much power in few modes, at all periods. Sectors that oscillate each by itself
have much power at one period, in all modes. A wave has more at one mode and one period than both explain.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray, IntArray

_FLOOR = 1e-3  # of the mean power at a frequency: modes with less count as if they had it
_PASSES = 2
_REWEIGHTED = 4  # least absolute deviations, by weights
_SLOPE_PRIOR = 4.0  # weight of a slope of 0, in values


@dataclass(frozen=True, eq=False)
class Background:
    """Power by group of waves and by frequency.

    Attributes
    ----------
    excess : ndarray of shape (K, C, R) and dtype float
        Natural logarithm of power over background.
    level, slope : ndarray of shape (G, R) and dtype float
        Of each group, over the logarithm of frequency less its mean: slow ones may be smoother.
    """

    excess: FloatArray
    level: FloatArray
    slope: FloatArray


def edge_groups(highest: int) -> list[IntArray]:
    """Columns of `wave_cells` that differ in their direction alone: mode 0, mode 1 both ways, …"""
    return [np.array([mode, mode + highest][: 2 if mode else 1]) for mode in range(highest + 1)]


def background(power: FloatArray, frequencies: FloatArray, groups: Sequence[IntArray]) -> Background:
    """What waves that differ in their direction alone have in common, and what all have at a frequency.

    Parameters
    ----------
    power : ndarray of shape (K, C, R) and dtype float
        Such as that of `wave_cells`.
    frequencies : ndarray of shape (K,) and dtype float
    groups : sequence of ndarray of dtype int
        Columns that differ in their direction alone.
    """
    floor = _FLOOR * power.mean(axis=1, keepdims=True) + np.finfo(np.float64).tiny
    logs = np.log(power + floor)
    abscissa = np.log(frequencies)
    abscissa = abscissa - abscissa.mean()
    level = np.zeros((len(groups), power.shape[2]))
    slope = np.zeros_like(level)
    for _ in range(_PASSES):
        if len(groups) > 1:
            logs -= np.median(logs, axis=1, keepdims=True)
        for group, cells in enumerate(groups):
            a, b = _robust_line(logs[:, cells], abscissa)
            logs[:, cells] -= (a + abscissa[:, None] * b)[:, None]
            level[group] += a
            slope[group] += b
    return Background(logs, level, slope)


def wave_scores(power: FloatArray, excess: FloatArray, groups: Sequence[IntArray]) -> FloatArray:
    """Share of all power that each wave carries, times the logarithm of its excess; below 0 counts as 0.

    Parameters
    ----------
    power, excess : ndarray of shape (K, C, R) and dtype float
        At the frequencies that are looked for.
    groups : sequence of ndarray of dtype int

    Returns
    -------
    ndarray of shape (K, C + groups of several, R) and dtype float
        Of each wave, then of all of a group together: standing waves.
    """
    share = power / power.sum(axis=(0, 1))
    several = [cells for cells in groups if len(cells) > 1]
    excesses, shares = [excess], [share]
    for cells in several:
        together = np.logaddexp.reduce(excess[:, cells], axis=1) - np.log(len(cells))
        excesses.append(together[:, None])
        shares.append(share[:, cells].sum(axis=1)[:, None])
    return np.asarray(np.concatenate(shares, axis=1) * np.maximum(np.concatenate(excesses, axis=1), 0.0))


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
