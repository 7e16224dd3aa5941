"""A period at which two sets of series both oscillate steadily."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.analysis.correlation.prepared_series import interpolated
from cytodisk.arrays import FloatArray

_FEWEST_CYCLES = 4.0  # in the movie: fewer are no steady oscillation
_SHORTEST_PERIOD = 2.2  # frames
_NEAR, _FAR = 3, 7  # bins to both sides whose median is the background of a line


class SharedLine(NamedTuple):
    """The line of both spectra that stands out most.

    Attributes
    ----------
    prominence : float
        Power at its peak over that beside it; of both spectra the smaller.
    share : float
        Of the variance that lies in it, the smaller of both.
    period : float
        In frames.
    """

    prominence: float
    share: float
    period: float


def shared_line(a: FloatArray, b: FloatArray) -> SharedLine:
    """The most prominent line that the mean spectra of two sets of series share.

    Parameters
    ----------
    a, b : ndarray of shape (T, W) and dtype float
        NaN is filled in linearly.

    Returns
    -------
    SharedLine
        Periods from 2.2 frames to a quarter of the movie.
    """
    frames = len(a)
    found = [_lines(_spectrum(series)) for series in (a, b)]
    frequency = np.fft.rfftfreq(frames)
    known = (frequency >= (_FEWEST_CYCLES - 0.5) / frames) & (frequency <= 1.0 / _SHORTEST_PERIOD)
    if not known.any():
        return SharedLine(0.0, 0.0, np.nan)
    prominence, share = (np.minimum(one, other) for one, other in zip(*found, strict=True))
    place = int(np.where(known, prominence, 0.0).argmax())
    return SharedLine(float(prominence[place]), float(share[place]), float(1.0 / frequency[place]))


def _spectrum(series: FloatArray) -> FloatArray:
    """Mean power by frequency of series without their parabola, each of variance 1, under a Hann window."""
    values = interpolated(series)
    time = np.linspace(-1.0, 1.0, len(values))
    basis, _ = np.linalg.qr(np.stack([np.ones_like(time), time, time**2], axis=1))
    values = values - basis @ (basis.T @ values)
    values = values / np.maximum(values.std(axis=0), 1e-12)
    taper = np.hanning(len(values) + 2)[1:-1, None]
    return np.asarray((np.abs(np.fft.rfft(values * taper, axis=0)) ** 2).mean(axis=1))


def _lines(power: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Prominence of each frequency, and share of the variance in it and its two neighbours."""
    share = np.convolve(power, np.ones(3), "same") / power.sum()
    padded = np.pad(power, _FAR, constant_values=np.nan)
    padded[_FAR] = np.nan  # the mean was taken out
    beside = np.lib.stride_tricks.sliding_window_view(padded, 2 * _FAR + 1)
    lower, upper = beside[:, : _FAR + 1 - _NEAR], beside[:, _FAR + _NEAR :]
    medians = [_median(side) for side in (lower, upper)]
    return power / np.maximum(np.maximum(*medians), 1e-12), share


def _median(values: FloatArray) -> FloatArray:
    """Median along the last axis of what is there; 0 where there is nothing."""
    known = [row[np.isfinite(row)] for row in values]
    return np.array([np.median(row) if row.size else 0.0 for row in known])
