"""Error of the edge velocity, from how the velocity of a movie jitters."""

from __future__ import annotations

import numpy as np
from scipy.optimize import nnls

from cytodisk.arrays import FloatArray

_LAGS = 8
_STEPS_TO_TELL = 15  # steps between frames from which jitter is told from real changes of velocity
_CLEAN_PX = 0.11  # error in a short sector that the pixels of a mask make, were it right to the pixel
_CLEAN_REACH_PX = 12.0  # length of edge over which that error averages out
_OUTLIER_SPREADS = 5.0
_MAD_TO_SD = 1.4826  # of a normal distribution
_FEWEST_SECTORS = 4  # from which pairs of neighbours tell over what length of edge the error averages out
_FEWEST_SERIES = 24  # that longer and longer stretches of neighbours may be made of
_REACHES = (0.05, 20.0)  # of the shortest and longest stretches' mean length: first and last that is tried
_STEP = 1.5  # from one that is tried to the next


def velocity_error(
    displacement_px: FloatArray, length_px: FloatArray, stretches_px: FloatArray | None = None
) -> FloatArray:
    """Standard deviation of the displacement of each sector's edge between frames, from the movie itself.

    An error of one outline makes the edge leap and come back: the displacement to that frame is too large by
    as much as the one from it is too small. Lags of the autocovariance show it, pooled over sectors; what
    velocity has that lasts from frame to frame is told from it. The error of a mask that is right to the
    pixel comes on top.

    Parameters
    ----------
    displacement_px : ndarray of shape (T, S) and dtype float
        Mean outward displacement by step between frames, and sector; NaN where there is none.
    length_px : ndarray of shape (T, S) and dtype float
        Length of each sector's edge.
    stretches_px : ndarray of shape (T, 2, F) and dtype float, optional
        Swept area and length of short stretches of the same edge, from which jitter is told; NaN where there
        are none. By default the sectors.

    Returns
    -------
    ndarray of shape (T, S) and dtype float
        NaN where the displacement is. If no two steps follow one another, nothing is known of jitter: it is
        the error of a mask that is right to the pixel, a lower bound.

    Notes
    -----
    With outline errors e that are independent from frame to frame, the displacement is v + e(t + 1) − e(t).
    Its first differences have the autocovariance 6, −4, 1, 0, … times var(e), plus that of the differences of
    v. The latter is fitted, with weights of at least 0, by those of processes that last: their correlation
    decays exponentially, to no less than half in a step, or as a Gaussian, or they are velocities of an edge
    whose position is such a Gaussian process, so that it comes back. With fewer than 15 steps they cannot be
    told apart: all change of velocity from one step to the next is counted as error, an upper bound.

    Errors of neighbouring sectors may be alike or not, so that the error falls with the sector's length or
    does not. The variance of jitter is taken to be v / (1 + length / reach), with the reach at which
    stretches and 2, 4, 8 … neighbours together have v as alike as can be. A few long sectors tell neither v
    nor reach: stretches that are short and many do, whatever the sectors.
    """
    if stretches_px is None:
        variance, reach = _by_length(displacement_px * length_px, length_px)
    else:
        variance, reach = _by_length(stretches_px[:, 0], stretches_px[:, 1])
    if not np.isfinite(variance):
        variance = 0.0
    with np.errstate(invalid="ignore", divide="ignore"):
        jitter = variance / (1.0 + length_px / reach)
        clean = _CLEAN_PX**2 / (1.0 + length_px / _CLEAN_REACH_PX)
        return np.where(np.isfinite(displacement_px), np.sqrt(jitter + clean), np.nan)


def error_is(displacement: FloatArray) -> str:
    """What the error of velocity is in a movie, in words: "at least" or "at most" so much, or empty.

    Parameters
    ----------
    displacement : ndarray of shape (T, S) and dtype float
        By step and sector, in any unit.

    Returns
    -------
    str
    """
    if not np.isfinite(np.diff(displacement, axis=0)).any():
        return "at least"
    return "at most" if _few_steps(displacement) else ""


def _few_steps(displacement: FloatArray) -> bool:
    return int(np.isfinite(displacement).any(axis=1).sum()) < _STEPS_TO_TELL


def _by_length(swept: FloatArray, length: FloatArray) -> tuple[float, float]:
    """Variance of jitter in a very short stretch, and length over which it averages out (may be infinite)."""
    held = np.where(np.isfinite(swept) & (length > 0.0), length, np.nan)
    plain = jitter_variance(swept / held)
    if not plain > 0.0 or swept.shape[1] < _FEWEST_SECTORS:
        return plain, np.inf
    merged = [(swept / held, held), _merged(swept, held, 2)]
    while swept.shape[1] >= _FEWEST_SERIES * 2 ** len(merged):
        merged.append(_merged(swept, held, 2 ** len(merged)))
    low, high = _REACHES[0], _REACHES[1] * 2 ** (len(merged) - 1)
    tried = np.geomspace(low, high, round(np.log(high / low) / np.log(_STEP))) * float(np.nanmean(held))
    best, found = np.inf, (plain, np.inf)
    for reach in np.append(tried, np.inf):
        each = [jitter_variance(away * np.sqrt(1.0 + long / reach)) for away, long in merged]
        unlike = float(np.std(np.log(each))) if min(each) > 0.0 else np.inf
        if unlike < best:
            best, found = unlike, (each[0], float(reach))
    return found


def _merged(swept: FloatArray, length: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Displacement and length of so many neighbours together; NaN where one of them is."""
    whole = swept.shape[1] // count * count
    areas, lengths = (each[:, :whole].reshape(len(each), -1, count).sum(axis=2) for each in (swept, length))
    return areas / lengths, lengths


def jitter_variance(displacement: FloatArray) -> float:
    """Variance that errors e of the outline give displacements, that of e(t + 1) − e(t).

    Parameters
    ----------
    displacement : ndarray of shape (T, S) and dtype float
        By step and sector, in any unit.

    Returns
    -------
    float
        NaN if no two steps follow one another; an upper bound in fewer than 15 steps.
    """
    change = np.diff(displacement, axis=0)
    finite = change[np.isfinite(change)]
    if not finite.size:
        return float("nan")
    spread = _OUTLIER_SPREADS * _MAD_TO_SD * float(np.median(np.abs(finite)))
    if spread > 0.0:
        change = np.clip(change, -spread, spread)
    if _few_steps(displacement):
        return float(np.nanmean(change**2)) / 3.0
    found, weights = _autocovariance(change)
    fitted, _ = nnls(weights[:, None] * _AUTOCOVARIANCES[: len(found)], weights * found)
    return 2.0 * float(fitted[0])


def _autocovariance(change: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean product at each lag, and the root of its share of pairs, up to the last lag that has any."""
    found, pairs = [], []
    for lag in range(min(_LAGS, len(change) - 1) + 1):
        product = change[lag:] * change[: len(change) - lag]
        finite = np.isfinite(product)
        if not finite.any():
            break
        found.append(float(product[finite].mean()))
        pairs.append(int(finite.sum()))
    return np.array(found), np.sqrt(np.array(pairs) / pairs[0])


def _differenced(covariance: FloatArray) -> FloatArray:
    """Autocovariance of first differences, at one lag less."""
    before = np.concatenate([covariance[1:2], covariance])
    return np.asarray(2.0 * covariance[:-1] - before[: len(covariance) - 1] - covariance[1:])


def _autocovariances() -> FloatArray:
    """One column for jitter, then those of velocities that last, shape (lags, columns)."""
    lags = np.arange(_LAGS + 2, dtype=np.float64)
    jitter = np.where(lags == 0, 2.0, np.where(lags == 1, -1.0, 0.0))
    exponential = [share**lags for share in (0.5, 0.7, 0.9)]
    gaussian = [np.exp(-0.5 * (lags / width) ** 2) for width in (1.5, 2.0, 3.0, 5.0, 8.0, 16.0)]
    returning = [
        (1.0 - (lags / width) ** 2) * np.exp(-0.5 * (lags / width) ** 2)
        for width in (1.5, 2.0, 3.0, 4.0, 6.0, 10.0)
    ]
    every = (jitter, *exponential, *gaussian, *returning)
    return np.column_stack([_differenced(each) for each in every])


_AUTOCOVARIANCES = _autocovariances()
