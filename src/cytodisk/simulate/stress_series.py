"""Independent series that fool a correlation all the same: their statistics change, repeat or leap."""

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from scipy.special import ndtr, stdtrit

from cytodisk.arrays import FloatArray

StressKind = Literal["pulse", "restless", "rising", "steady", "heavy tails"]
STRESS_KINDS: tuple[StressKind, ...] = get_args(StressKind)

PULSE_FRAMES, PULSE_HEIGHT = 3, 4.5  # standard deviations
EPISODE_SHARE, EPISODE_GAIN = 0.1, 3.0  # of the frames; of the standard deviation
RISE = 4.0  # times the first standard deviation at the end
STEADY_PERIOD, STEADY_SHARE = 10.0, 0.5  # frames; of the variance
TAILS = 2.5  # degrees of freedom of Student's t


def stressed(
    kind: StressKind, seed: int, series: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Make stressed series of independent ones, at the same frames in all.

    Parameters
    ----------
    kind : str
        One of `STRESS_KINDS`.
    seed : int
        Draws when a pulse or an episode comes.
    series : two ndarrays of shape (T, ...) and dtype float
        Activity and velocity, of variance 1.

    Returns
    -------
    two ndarrays
        In the shapes of `series`.
    """
    frames = len(series[0])
    share = np.random.default_rng([seed, 9]).uniform()
    activity, velocity = (_STRESSES[kind](values, frames, share) for values in series)
    return activity, velocity


def _pulse(values: FloatArray, frames: int, share: float) -> FloatArray:
    length = min(PULSE_FRAMES, frames)
    first = int(share * (frames - length + 1))
    pulse = np.zeros(frames)
    pulse[first : first + length] = PULSE_HEIGHT
    return values + _down(pulse, values)


def _restless(values: FloatArray, frames: int, share: float) -> FloatArray:
    length = max(1, round(EPISODE_SHARE * frames))
    first = int(share * (frames - length + 1))
    gain = np.ones(frames)
    gain[first : first + length] = EPISODE_GAIN
    return values * _down(gain, values)


def _rising(values: FloatArray, frames: int, share: float) -> FloatArray:
    return values * _down(np.linspace(1.0, RISE, frames), values)


def _steady(values: FloatArray, frames: int, share: float) -> FloatArray:
    """Oscillators of one period. Noise of the last and first frame gives phases as smooth as the series."""
    turn = np.asarray(2.0 * np.pi / STEADY_PERIOD * np.arange(float(frames)))
    phase = np.arctan2(values[-1], values[0])
    wave = np.sqrt(2.0) * np.cos(_down(turn, values) + phase)
    return np.asarray(np.sqrt(STEADY_SHARE) * wave + np.sqrt(1.0 - STEADY_SHARE) * values)


def _heavy(values: FloatArray, frames: int, share: float) -> FloatArray:
    """Gaussian numbers to those of Student's t at the same quantile, scaled to variance 1."""
    tails = stdtrit(TAILS, ndtr(values))
    return np.asarray(tails * np.sqrt((TAILS - 2.0) / TAILS))


_STRESSES: dict[StressKind, Callable[[FloatArray, int, float], FloatArray]] = {
    "pulse": _pulse,
    "restless": _restless,
    "rising": _rising,
    "steady": _steady,
    "heavy tails": _heavy,
}


def _down(line: FloatArray, values: FloatArray) -> FloatArray:
    return line.reshape(-1, *[1] * (values.ndim - 1))
