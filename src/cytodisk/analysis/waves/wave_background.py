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
_PASSES = 6
_MOST = 4.0  # power over background of which no more counts: waves hardly move it, noise has so much in 2 %
_USUAL = 1.0 - np.exp(-_MOST)  # mean of what counts, in noise
_SLOPE_PRIOR = 4.0  # weight of a slope of 0, in values
_STEP = 1.0  # of slopes, at most


@dataclass(frozen=True, eq=False)
class Background:
    """Power by group of waves and by frequency.

    Attributes
    ----------
    excess : ndarray of shape (K, C, R) and dtype float
        Natural logarithm of power over background.
    usual : ndarray of shape (K, C, R) and dtype float
        The background.
    level, slope : ndarray of shape (G, R) and dtype float
        Of each group less the mean of all, over the logarithm of frequency less its mean: slow ones may be
        smoother.
    """

    excess: FloatArray
    usual: FloatArray
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
    column = np.empty(power.shape[1], dtype=np.int64)
    for group, cells in enumerate(groups):
        column[cells] = group
    level = np.stack([logs[:, cells].mean(axis=(0, 1)) for cells in groups])
    slope = np.zeros_like(level)
    shared = np.zeros((len(logs), power.shape[2]))  # of one group alone, nothing is
    if len(groups) > 1:
        shared = (logs - level[column]).mean(axis=1)
    x = abscissa[:, None]
    for _ in range(_PASSES):
        if len(groups) > 1:
            shared += np.log(_counted(logs, shared, level, slope, x, column).mean(axis=1))
        counted = _counted(logs, shared, level, slope, x, column)
        for group, cells in enumerate(groups):
            level[group] += np.log(counted[:, cells].mean(axis=(0, 1)))
        counted = _counted(logs, shared, level, slope, x, column)
        for group, cells in enumerate(groups):
            pull = ((counted[:, cells] - 1.0).sum(axis=1) * x).sum(axis=0) - _SLOPE_PRIOR * slope[group]
            step = pull / (len(cells) * (x**2).sum() + _SLOPE_PRIOR)
            slope[group] += np.clip(step, -_STEP, _STEP)
        if len(groups) > 1:
            for one, by in ((level, np.ones_like(x)), (slope, x)):
                shared += by * one.mean(axis=0)
                one -= one.mean(axis=0)
    expected = shared[:, None] + level[column] + x[:, None] * slope[column]
    return Background(logs - expected, np.exp(expected), level, slope)


def _counted(
    logs: FloatArray,
    shared: FloatArray,
    level: FloatArray,
    slope: FloatArray,
    x: FloatArray,
    column: IntArray,
) -> FloatArray:
    """Power over background, as far as it counts, in units of what noise has."""
    excess = logs - shared[:, None] - level[column] - x[:, None] * slope[column]
    return np.asarray(np.exp(np.minimum(excess, np.log(_MOST))) / _USUAL)


def wave_scores(usual: FloatArray, excess: FloatArray, groups: Sequence[IntArray]) -> FloatArray:
    """Share of all power that each wave carries, times the logarithm of its excess; below 0 counts as 0.

    Parameters
    ----------
    usual : ndarray of shape (K, C, R or 1) and dtype float
        Background at the frequencies that are looked for.
    excess : ndarray of shape (K, C, R) and dtype float
        Of the movies there.
    groups : sequence of ndarray of dtype int

    Returns
    -------
    ndarray of shape (K, C + groups of several, R) and dtype float
        Of each wave, then of all of a group together: standing waves.
    """
    power = usual * np.exp(excess)
    share = power / power.sum(axis=(0, 1))
    several = [cells for cells in groups if len(cells) > 1]
    excesses, shares = [excess], [share]
    for cells in several:
        together = np.logaddexp.reduce(excess[:, cells], axis=1) - np.log(len(cells))
        excesses.append(together[:, None])
        shares.append(share[:, cells].sum(axis=1)[:, None])
    return np.asarray(np.concatenate(shares, axis=1) * np.maximum(np.concatenate(excesses, axis=1), 0.0))
