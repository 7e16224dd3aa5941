"""Energy of many series through time: how much they vary in each frame, one outlier not counting for all."""

from __future__ import annotations

import warnings

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray

_NORMAL = 1.4826  # of the median absolute deviation
_CAP = 9.0  # square of three standard deviations
_SHORTEST_MEDIAN, _SHARE_OF_MOVIE = 9, 0.25  # frames, and of all frames: of the moving median


def without_slow_changes(series: FloatArray) -> FloatArray:
    """Series minus their moving median over a quarter of the movie, so that trends do not count as energy.

    Parameters
    ----------
    series : ndarray of shape (T, W) and dtype float
        NaN stays NaN.

    Returns
    -------
    ndarray of shape (T, W) and dtype float
    """
    frames = max(_SHORTEST_MEDIAN, int(_SHARE_OF_MOVIE * len(series)))
    rolling = pd.DataFrame(series).rolling(frames, center=True, min_periods=max(3, frames // 3))
    return np.asarray(series - rolling.median().to_numpy(dtype=np.float64))


def capped_energy(series: FloatArray) -> FloatArray:
    """Mean over windows of the squares of series in units of their robust spread, each at most 9.

    Parameters
    ----------
    series : ndarray of shape (T, W, …) and dtype float
        NaN is left out.

    Returns
    -------
    ndarray of shape (T, …) and dtype float
        1 where no window has a value, the energy of any frame.
    """
    with warnings.catch_warnings(), np.errstate(invalid="ignore", divide="ignore"):
        warnings.simplefilter("ignore", RuntimeWarning)  # frames and windows without any value
        away = series - np.nanmedian(series, axis=0)
        spread = _NORMAL * np.nanmedian(np.abs(away), axis=0)
        spread = np.where(spread > 0, spread, np.nanstd(away, axis=0))
        energy = np.nanmean(np.minimum((away / spread) ** 2, _CAP), axis=1)
        energy /= np.nanmean(energy, axis=0)
    return np.asarray(np.where(np.isfinite(energy), energy, 1.0))


def kurtosis(series: FloatArray) -> FloatArray:
    """Mean over windows of the fourth moment over the squared second: 3 of a normal distribution.

    Parameters
    ----------
    series : ndarray of shape (T, W, …) and dtype float
        NaN is left out.

    Returns
    -------
    ndarray of shape (…) and dtype float
    """
    with warnings.catch_warnings(), np.errstate(invalid="ignore", divide="ignore"):
        warnings.simplefilter("ignore", RuntimeWarning)
        square = (series - np.nanmean(series, axis=0)) ** 2
        each = np.nanmean(square**2, axis=0) / np.nanmean(square, axis=0) ** 2
        return np.asarray(np.nanmean(each, axis=0))
