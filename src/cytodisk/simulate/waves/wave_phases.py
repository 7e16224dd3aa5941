"""How the phase of a wave goes on: evenly, diffusing, or the other way round from some frame on."""

import numpy as np
from scipy.signal import lfilter

from cytodisk.arrays import ComplexArray, FloatArray


def running_phase(
    random: np.random.Generator, step: float, persistence: float, direction: FloatArray
) -> FloatArray:
    """Phase of a wave, which goes on by a step each frame and by a random one.

    Parameters
    ----------
    random : Generator
    step : float
        Mean step, in radians per frame.
    persistence : float
        Frames over which the mean of exp(i phase), each turned back by its mean step, falls to exp(-1);
        infinite: never.
    direction : ndarray of shape (T,) and dtype float
        1 or -1: which way the wave goes from the frame before to this one.

    Returns
    -------
    ndarray of shape (T,) and dtype float
        In radians, from a random one; not wrapped.
    """
    steps = step * direction + np.sqrt(2.0 / persistence) * random.normal(size=len(direction))
    steps[0] = random.uniform(-np.pi, np.pi)
    return np.asarray(np.cumsum(steps))


def directions(random: np.random.Generator, frames: int, first: int, reversals: int) -> FloatArray:
    """Direction of a wave in each frame, which turns at random frames; shape (T,), 1 or -1."""
    turns = 1 + random.permutation(frames - 1)[:reversals]
    sign = np.full(frames, float(first))
    for turn in turns:
        sign[turn:] *= -1.0
    return sign


def wandering(noise: ComplexArray, step: float, persistence: float) -> ComplexArray:
    """Complex series with the spectrum of a running wave's sector, each with a phase of its own.

    Parameters
    ----------
    noise : ndarray of shape (T, ...) and dtype complex
        White in time, of variance 1.
    step, persistence : float
        As for `running_phase`.

    Returns
    -------
    ndarray of shape (T, ...) and dtype complex
        Of variance 1. Its autocorrelation is exp(i step - 1 / persistence) to the power of the lag, as that
        of exp(i phase).
    """
    kept = np.exp(1j * step - 1.0 / persistence)
    driven = noise * np.sqrt(-np.expm1(-2.0 / persistence))  # 1 - |kept|², at least 0
    driven[0] = noise[0]
    return np.asarray(lfilter([1.0], [1.0, -kept], driven, axis=0))
