"""How bright a movie is against its own mean, as a slow curve in time: bleaching."""

from __future__ import annotations

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray, IntArray

_FEWEST = 20  # frames for a curve
_LEAST = 0.1  # of the mean level, below which a curve is not believed
_SMOOTH = 5  # frames of the moving median at the least


def brightness(pixels: FloatArray, expected: FloatArray) -> FloatArray:
    """Sum of pixels over the sum of what is expected at the same places, shape (C,).

    Parameters
    ----------
    pixels, expected : ndarray of shape (C, P) and dtype float
        Where either is NaN, neither counts.

    Returns
    -------
    ndarray of shape (C,) and dtype float
        NaN where nothing is above 0.
    """
    known = np.isfinite(pixels) & np.isfinite(expected)
    here, there = (np.where(known, values, 0.0).sum(axis=1) for values in (pixels, expected))
    return np.where(there > 0, here / np.where(there > 0, there, 1.0), np.nan)


def slow_level(frames: IntArray, ratio: FloatArray, max_lag: int) -> FloatArray:
    """Parabola in time through what a frame's brightness is against the mean.

    Parameters
    ----------
    frames : ndarray of shape (T,) and dtype int
    ratio : ndarray of shape (T, C) and dtype float
        Of `brightness`.
    max_lag : int
        In frames: a moving median over the lags to both sides takes out what is as fast as they, and flashes.

    Returns
    -------
    ndarray of shape (T, C) and dtype float
        With mean 1; 1 throughout where there are fewer than 20 frames, or no level above 0.
    """
    level = np.ones(ratio.shape)
    if len(frames) < _FEWEST:
        return level
    window = max(2 * max_lag + 1, _SMOOTH)
    smooth = pd.DataFrame(ratio).rolling(window, center=True, min_periods=1).median().to_numpy()
    time = (frames - frames.mean()) / max(np.ptp(frames), 1)
    for channel, values in enumerate(smooth.T):
        if not np.isfinite(values).all():
            continue
        curve = np.polyval(np.polyfit(time, values, 2), time)
        if curve.mean() > 0 and curve.min() >= _LEAST * curve.mean():
            level[:, channel] = curve / curve.mean()
    return level
