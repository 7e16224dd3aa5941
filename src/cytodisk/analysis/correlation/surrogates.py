"""Surrogates: series as they might have been, had they nothing to do with the other signal."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from cytodisk.analysis.correlation.correlation_parameters import Null, NullParameters
from cytodisk.analysis.correlation.prepared_series import interpolated
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError

_ALL = slice(None)


class Change(Protocol):
    """Makes surrogates of a series (T,), shape (T, R): all of them, or some."""

    def __call__(self, series: FloatArray, which: slice = _ALL) -> FloatArray: ...


@dataclass(frozen=True)
class Surrogates:
    """Two ways to change series, each the same for all series it is given.

    Attributes
    ----------
    alone : Change
        For one series at a time: keeps its autocorrelation, also where there are few frames.
    together : Change
        For means over many series: keeps also how they correlate with each other at every lag, so that
        neighbours that move together, or waves that run along them, are not taken for independent.
    count : int
        How many there are; shifts are few in a short movie.
    """

    alone: Change
    together: Change
    count: int


def surrogates(null: Null, frames: int, count: int, seed: int, max_lag: int = 0) -> Surrogates:
    """Functions that make surrogates of series.

    Parameters
    ----------
    null : {"phase", "shift"}
        `phase_randomised` alone and `filtered_noise` together, or `circularly_shifted` for both.
    frames : int
    count : int
        Surrogates a series.
    seed : int
    max_lag : int
        Longest lag at which they will be correlated: shifts differ from 0 and from each other by more than
        twice that. Else what is true would come back at another lag, and the same would be counted often.

    Returns
    -------
    Surrogates

    Raises
    ------
    ParameterError
        An unknown null, no surrogates, a seed below 0, or too few frames to shift.
    """
    checked = NullParameters.of(null=null, seed=seed)
    count = whole_number("surrogates", count, 1)
    random = np.random.default_rng(checked.seed)
    if null == "shift":
        shifts = _shifts(frames, count, max_lag, random)

        def shifted(series: FloatArray, which: slice = _ALL) -> FloatArray:
            return circularly_shifted(series, shifts[which])

        return Surrogates(shifted, shifted, len(shifts))
    turns = np.exp(1j * random.uniform(0.0, 2.0 * np.pi, (frames + 1, count)))
    noise = np.fft.rfft(random.normal(size=(2 * frames, count)), axis=0)
    return Surrogates(
        lambda series, which=_ALL: phase_randomised(series, turns[:, which]),
        lambda series, which=_ALL: filtered_noise(series, noise[:, which]),
        count,
    )


def _shifts(frames: int, count: int, max_lag: int, random: np.random.Generator) -> IntArray:
    """Shifts of which no two, and none and no shift, share a lag."""
    least, most, apart = 2 * max_lag + 1, frames - 2 * max_lag - 1, 2 * max_lag + 1
    if most < least:
        raise ParameterError(
            f"null 'shift' needs at least {4 * max_lag + 2} frames at max_lag {max_lag}, got {frames}: "
            "pass a smaller max_lag, or null 'phase'"
        )
    first = least + random.integers((most - least) % apart + 1)
    return np.asarray(random.permutation(np.arange(first, most + 1, apart))[:count])


def phase_randomised(series: FloatArray, turns: NDArray[np.complex128]) -> FloatArray:
    """Series with the same spectrum, hence the same autocorrelation, and other phases.

    Parameters
    ----------
    series : ndarray of shape (T,) and dtype float
        Gaps are filled in linearly first, and are gaps again in the surrogates; what lies before the first
        and after the last value stays empty.
    turns : ndarray of shape (T + 1, R) and dtype complex
        Unit numbers by which the components are turned.

    Returns
    -------
    ndarray of shape (T, R) and dtype float

    Notes
    -----
    The spectrum is that of the series followed by its mirror image, of which the first half is kept. Without
    the mirror, the jump from the last value to the first enters the spectrum, and slow series come out
    significant twice as often as they should. The mirror knows no direction of time, so these surrogates of
    two series that follow each other do not: see `filtered_noise`.

    References
    ----------
    Theiler et al. (1992), doi:10.1016/0167-2789(92)90102-S.
    """
    found = np.full((len(series), turns.shape[1]), np.nan)
    present = np.flatnonzero(np.isfinite(series))
    if not present.size:
        return found
    known = slice(present[0], present[-1] + 1)
    whole = interpolated(series[known, None])[:, 0]
    frames = len(whole)
    centred = whole - whole.mean()
    spectrum = np.fft.rfft(np.concatenate([centred, centred[::-1]]))
    found[known] = np.fft.irfft(spectrum[:, None] * turns[: frames + 1], 2 * frames, axis=0)[:frames]
    found[~np.isfinite(series)] = np.nan
    return found


def filtered_noise(series: FloatArray, noise: NDArray[np.complex128]) -> FloatArray:
    """Common white noise, filtered by a series: what all series that share the noise have in common stays.

    Parameters
    ----------
    series : ndarray of shape (T,) and dtype float
        Gaps are filled in linearly first, and are gaps again in the surrogates; what lies before the first
        and after the last value counts as 0.
    noise : ndarray of shape (T + 1, R) and dtype complex
        Spectrum of 2 T values of white noise.

    Returns
    -------
    ndarray of shape (T, R) and dtype float

    Notes
    -----
    Two series x, y that filter the same noise have the covariances Σ x(t) y(t + lag) of the series
    themselves, at every lag and with its sign; zeros behind the series keep its ends apart. That holds beside
    their straight lines. Those stay lines, with one random sign for all series: what goes one way through the
    movie in all windows would else be taken for noise, and two signals that both do would seem coupled.

    References
    ----------
    Prichard & Theiler (1994), doi:10.1103/PhysRevLett.73.951, with random amplitudes.
    """
    found = np.full((len(series), noise.shape[1]), np.nan)
    present = np.isfinite(series)
    if not present.any():
        return found
    known = np.flatnonzero(present)
    span = slice(known[0], known[-1] + 1)
    whole = np.zeros(2 * len(series))
    filled = interpolated(series[span, None])[:, 0]
    line = _straight_line(filled)
    whole[span] = filled - filled.mean() - line
    turned = np.fft.rfft(whole)[:, None] * noise
    drawn = np.fft.irfft(turned, len(whole), axis=0)[: len(series)] / np.sqrt(len(filled))
    drawn[span] += line[:, None] * np.sign(noise[0].real)  # the spectrum has nothing there
    found[present] = drawn[present]
    return found


def _straight_line(series: FloatArray) -> FloatArray:
    """Straight line of least squares through a series, without its mean."""
    time = np.arange(len(series)) - 0.5 * (len(series) - 1)
    square = float(time @ time)
    return np.asarray(time * (float(time @ series) / square if square else 0.0))


def circularly_shifted(series: FloatArray, shifts: IntArray) -> FloatArray:
    """Series moved in time, what leaves at the end coming in at the start.

    Parameters
    ----------
    series : ndarray of shape (T,) and dtype float
        Gaps move along.
    shifts : ndarray of shape (R,) and dtype int
        In frames.

    Returns
    -------
    ndarray of shape (T, R) and dtype float
    """
    frames = len(series)
    return np.asarray(series[(np.arange(frames)[:, None] - shifts) % frames])
