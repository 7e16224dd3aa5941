"""Differences and effect sizes of two groups, with their intervals."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from scipy.special import gammaln, nctdtrinc
from scipy.stats import chi2, t

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.population.exchange.column_moments import column_moments
from cytodisk.population.ratios import ratio

CONFIDENCE = 0.95
_ROUNDING = 1e-26  # of the squares of values: what is left of a variance of 0
_FAR = 1000.0  # score from which on its spread is that of the sd alone, within 3e-4; else it takes hours


Effects: TypeAlias = dict[str, FloatArray]
"""By name an array of shape (windows,), NaN where there is none.

control, treated: means of the units. difference, difference_low, difference_high: treated minus control, and
its interval by Student's t (Welch's for groups, of pairs where paired). effect_size, low, high: Hedges' g and
its interval from the noncentral t distribution; in pairs over the standard deviation of the two conditions,
so that it can be compared with that of groups. n_control, n_treated: units with a value.
"""

_NAMES = (
    "control",
    "treated",
    "difference",
    "difference_low",
    "difference_high",
    "effect_size",
    "low",
    "high",
    "n_control",
    "n_treated",
)


def group_effects(values: FloatArray, treated: BoolArray) -> Effects:
    """Effects of two groups of units.

    Parameters
    ----------
    values : ndarray of shape (units, windows) and dtype float64
        NaN where a unit has no value.
    treated : ndarray of shape (units,) and dtype bool

    Returns
    -------
    dict of str to ndarray
        See `Effects`. Hedges (1981), doi:10.3102/10769986006002107; interval: Steiger & Fouladi (1997).
    """
    (m0, v0, n0), (m1, v1, n1) = (_moments(values, group) for group in (~treated, treated))
    enough = (n0 > 0) & (n1 > 0)
    difference = np.where(enough, m1 - m0, np.nan)
    e0, e1 = ratio(v0, n0, n0 > 1), ratio(v1, n1, n1 > 1)
    error = e0 + e1
    with np.errstate(invalid="ignore", divide="ignore"):
        degrees = error**2 / (e0**2 / (n0 - 1) + e1**2 / (n1 - 1))
        half = t.ppf(0.5 + CONFIDENCE / 2, degrees) * np.sqrt(error)
        own = n0 + n1 - 2
        squares = np.where(n0 > 1, v0 * (n0 - 1), 0.0) + np.where(n1 > 1, v1 * (n1 - 1), 0.0)
        spread = np.sqrt(squares / own)
        worth = np.sqrt(n0 * n1 / (n0 + n1))
        per_score = 1.0 / worth
    scale = np.where(enough & (own > 0) & (spread > 0), spread, np.nan)
    g, low, high = _hedges(difference / scale * worth, own, per_score)
    return _effects(m0, m1, difference, difference - half, difference + half, g, low, high, n0, n1)


def pair_effects(control: FloatArray, treated: FloatArray) -> Effects:
    """Effects in pairs of units.

    Parameters
    ----------
    control, treated : ndarray of shape (pairs, windows) and dtype float64

    Returns
    -------
    dict of str to ndarray
        See `Effects`. Interval of the effect size: Algina & Keselman (2003), doi:10.1177/0013164403256358; an
        approximation, which is a little too short with few pairs.
    """
    both = np.isfinite(control) & np.isfinite(treated)
    first, second = np.where(both, control, np.nan), np.where(both, treated, np.nan)
    (m0, v0, n), (m1, v1, _), (difference, variance, _) = map(_moments, (first, second, second - first))
    with np.errstate(invalid="ignore", divide="ignore"):
        error = np.sqrt(variance / n)
        half = t.ppf(0.5 + CONFIDENCE / 2, n - 1) * error
        spread = np.sqrt((v0 + v1) / 2.0)
        score = np.where((error > 0) & (spread > 0), difference / error, np.nan)
        g, low, high = _hedges(score, n - 1, error / spread)
    return _effects(m0, m1, difference, difference - half, difference + half, g, low, high, n, n)


def mean_effects(values: FloatArray) -> Effects:
    """Mean of units against 0: as pairs whose control is 0.

    Parameters
    ----------
    values : ndarray of shape (units, windows) and dtype float64

    Returns
    -------
    dict of str to ndarray
        See `Effects`. The effect size is the mean over the standard deviation of the units.
    """
    mean, variance, n = _moments(values)
    with np.errstate(invalid="ignore", divide="ignore"):
        error = np.sqrt(variance / n)
        half = t.ppf(0.5 + CONFIDENCE / 2, n - 1) * error
        g, low, high = _hedges(np.where(error > 0, mean / error, np.nan), n - 1, 1.0 / np.sqrt(n))
    return _effects(np.zeros_like(mean), mean, mean, mean - half, mean + half, g, low, high, n, n)


def _effects(*arrays: FloatArray) -> Effects:
    return dict(zip(_NAMES, arrays, strict=True))


def bias_factor(degrees: FloatArray) -> FloatArray:
    """Hedges' factor Γ(m/2) / (√(m/2) Γ((m - 1)/2)), which takes the bias out of d; NaN for m < 2.

    Parameters
    ----------
    degrees : ndarray of float64

    Returns
    -------
    ndarray of float64
    """
    m = np.where(degrees > 1, degrees, np.nan)
    found: FloatArray = np.exp(gammaln(m / 2) - gammaln((m - 1) / 2) - 0.5 * np.log(m / 2))
    return found


def _hedges(score: FloatArray, degrees: FloatArray, per_score: FloatArray) -> tuple[FloatArray, ...]:
    """g and the ends of its interval, from the score t and the effect that a score of 1 stands for."""
    usable = np.isfinite(score) & (degrees > 0)
    factor = bias_factor(np.asarray(degrees, dtype=np.float64))
    ends = [np.full(score.shape, np.nan) for _ in range(2)]
    tails = (0.5 + CONFIDENCE / 2, 0.5 - CONFIDENCE / 2)
    far = usable & (np.abs(score) > _FAR)
    near = usable & ~far
    for end, tail in zip(ends, tails, strict=True):
        end[near] = nctdtrinc(degrees[near], tail, score[near])
        quantile = chi2.ppf(np.where(score[far] > 0, 1.0 - tail, tail), degrees[far])
        end[far] = score[far] * np.sqrt(quantile / degrees[far])
    return (score * per_score * factor, *(end * per_score * factor for end in ends))


def _moments(
    values: FloatArray, chosen: BoolArray | None = None
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Mean, variance and number of the values in each column; NaN where there are too few.

    What rounding leaves of a variance of 0 is 0: an effect size over it would be any number.
    """
    found = column_moments(values, chosen)
    varies = ~(found.squares <= _ROUNDING * found.raw_squares)
    return found.mean, np.where(varies, found.variance, found.variance * 0.0), found.count
