"""A period at which two sets of series both oscillate steadily."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.special import fdtrc

from cytodisk.analysis.correlation.prepared_series import interpolated
from cytodisk.arrays import FloatArray

_FEWEST_CYCLES = 4.0  # in the movie: fewer are no steady oscillation
_SHORTEST_PERIOD = 2.2  # frames
_NEAR, _FAR = 3, 7  # bins to both sides whose median is the background of a line
_BESIDE = (2, 3)  # bins to each side where a band still has its power, and a line under a Hann window none


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
    p : float
        Probability that noise with a smooth spectrum has so narrow a peak there, of both the larger.
    """

    prominence: float
    share: float
    period: float
    p: float


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

    Notes
    -----
    Series that hang together around the cell are few series, whatever their number, and the mean of few
    spectra keeps the peaks that chance gives to each. So the peak is compared with the two bins beyond its
    own on each side, of which the stronger counts. The ratio of both follows an F distribution by the number
    of series that are independent: once the line is taken out, the square of the sum over the sum of squares
    of the eigenvalues of their correlations.
    """
    frames = len(a)
    spectra = [_spectrum(series) for series in (a, b)]
    found = [_lines(power) for power in spectra]
    frequency = np.fft.rfftfreq(frames)
    known = (frequency >= (_FEWEST_CYCLES - 0.5) / frames) & (frequency <= 1.0 / _SHORTEST_PERIOD)
    if not known.any():
        return SharedLine(0.0, 0.0, np.nan, 1.0)
    prominence, share = (np.minimum(one, other) for one, other in zip(*found, strict=True))
    place = int(np.where(known, prominence, 0.0).argmax())
    p = max(_chance(series, power, place) for series, power in zip((a, b), spectra, strict=True))
    return SharedLine(float(prominence[place]), float(share[place]), float(1.0 / frequency[place]), p)


def _chance(series: FloatArray, power: FloatArray, place: int) -> float:
    """Probability that a smooth spectrum has a peak so far above both of its sides."""
    near, far = _BESIDE
    sides = power[max(place - far, 1) : place - near + 1], power[place + near : place + far + 1]
    beside = max(float(side.mean()) if side.size else 0.0 for side in sides)
    count = _independent(series, place)
    # two degrees of freedom a bin and series; the stronger side has two bins
    return float(fdtrc(2.0 * count, 4.0 * count, power[place] / max(beside, 1e-12)))


def _independent(series: FloatArray, place: int) -> float:
    """How many series are worth as much, apart from the bin of a line and its two neighbours."""
    values = interpolated(series)
    turns = (
        2.0 * np.pi * np.outer(np.arange(len(values)), np.arange(max(place - 1, 0), place + 2)) / len(values)
    )
    basis, _ = np.linalg.qr(np.concatenate([np.ones((len(values), 1)), np.cos(turns), np.sin(turns)], axis=1))
    values = values - basis @ (basis.T @ values)
    values = values / np.maximum(values.std(axis=0), 1e-12)
    eigenvalues = np.linalg.svd(values, compute_uv=False) ** 2
    return float(eigenvalues.sum() ** 2 / max((eigenvalues**2).sum(), 1e-12))


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
