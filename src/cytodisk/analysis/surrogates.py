"""Surrogates: series as they might have been, had they nothing to do with the other signal.

All series of a study are changed together, by the same random phases or the same shift, so that what
neighbouring sectors have in common stays as it was.
"""

from __future__ import annotations

from typing import Literal, Protocol, get_args

import numpy as np
from numpy.typing import NDArray

from cytodisk.analysis.parameters import whole_number
from cytodisk.analysis.series import interpolated
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import ParameterError

Null = Literal["phase", "shift"]
_ALL = slice(None)


class Surrogates(Protocol):
    """Makes surrogates of a series (T,), shape (T, R): all of them, or some."""

    def __call__(self, series: FloatArray, which: slice = _ALL) -> FloatArray: ...


def surrogates(null: Null, frames: int, count: int, seed: int) -> Surrogates:
    """A function that makes surrogates of a series, the same way for each series it is given.

    Parameters
    ----------
    null : {"phase", "shift"}
        See `phase_randomised` and `circularly_shifted`.
    frames : int
    count : int
        Surrogates a series.
    seed : int

    Returns
    -------
    Surrogates
        Takes a series (T,), gives (T, count), NaN where there are no values; with a slice, those alone.

    Raises
    ------
    ParameterError
        An unknown null, no surrogates, a seed below 0, or too few frames to shift.
    """
    check_null(null)
    count = whole_number("surrogates", count, 1)
    random = np.random.default_rng(whole_number("seed", seed, 0))
    if null == "phase":
        turns = np.exp(1j * random.uniform(0.0, 2.0 * np.pi, (frames + 1, count)))
        return lambda series, which=_ALL: phase_randomised(series, turns[:, which])
    if frames < 2:
        raise ParameterError(f"null 'shift' needs at least 2 frames, got {frames}")
    shifts = random.integers(1, frames, count)
    return lambda series, which=_ALL: circularly_shifted(series, shifts[which])


def check_null(null: str) -> None:
    """Raise ParameterError unless there are such surrogates."""
    if null not in get_args(Null):
        raise ParameterError(f"null must be one of {', '.join(get_args(Null))}, got {null!r}")


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
    significant twice as often as they should.

    References
    ----------
    Theiler et al. (1992), doi:10.1016/0167-2789(92)90102-S; Prichard & Theiler (1994), same phases for all
    series, doi:10.1103/PhysRevLett.73.951.
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
