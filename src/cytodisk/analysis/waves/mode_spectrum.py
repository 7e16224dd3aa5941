"""Power of modes around the cell at each period, of what runs one way and of what runs the other.

Fits by least squares, so frames may lie anywhere in time.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import ComplexArray, FloatArray

_FEWEST_BINS = 20  # of the background: shorter movies look beyond the shortest period that is looked for


@dataclass(frozen=True, eq=False)
class Bands:
    """Frequencies, each as far from the next as the movie can tell.

    Attributes
    ----------
    frequencies : ndarray of shape (K,) and dtype float
        In 1/s.
    visible : int
        How many of them are looked for; the others serve the background.
    fits : ndarray of shape (2 K, T) and dtype complex
        Takes modes to the amplitudes of exp(−i ω t), then of exp(+i ω t).
    """

    frequencies: FloatArray
    visible: int
    fits: ComplexArray


def bands(seconds: FloatArray, shortest: float, longest: float, interval: float) -> Bands:
    """Frequencies of the periods that a movie can show, and what fits them.

    Parameters
    ----------
    seconds : ndarray of shape (T,) and dtype float
        Of the frames that are used.
    shortest, longest : float
        Periods in seconds.
    interval : float
        Seconds between frames.
    """
    duration = float(seconds[-1] - seconds[0] + interval)
    low, high = 1.0 / longest, 1.0 / shortest
    visible = int(np.floor((high - low) * duration + 1e-9)) + 1
    step = (high - low) / (visible - 1) if visible > 1 else 1.0 / duration
    most = max(int((0.45 / interval - low) / step) + 1, visible)
    frequencies = low + step * np.arange(min(max(visible, _FEWEST_BINS), most))
    middle = seconds - 0.5 * (seconds[0] + seconds[-1])
    taper = np.sin(np.pi * (seconds - seconds[0] + 0.5 * interval) / duration)
    fits = np.stack([pair_fit(middle, float(frequency), taper)[0] for frequency in frequencies], axis=1)
    return Bands(np.asarray(frequencies, dtype=np.float64), visible, fits.reshape(-1, len(seconds)))


def pair_fit(
    seconds: FloatArray, frequency: float, taper: FloatArray | None = None
) -> tuple[ComplexArray, ComplexArray]:
    """What fits exp(−i ω t) and exp(+i ω t) beside a constant and a straight line.

    Parameters
    ----------
    seconds : ndarray of shape (T,) and dtype float
        Around 0.
    frequency : float
        In 1/s.
    taper : ndarray of shape (T,) and dtype float, optional
        By which residuals are weighted: less of a strong period then leaks into others.

    Returns
    -------
    fit : ndarray of shape (2, T) and dtype complex
    design : ndarray of shape (T, 4) and dtype complex
        Constant, line, and the two.
    """
    turn = np.exp(-2j * np.pi * frequency * seconds)
    line = seconds / (np.abs(seconds).max() or 1.0)
    design = np.column_stack([np.ones_like(turn), line, turn, turn.conj()])
    weighted = design if taper is None else design * taper[:, None]
    fit = np.linalg.pinv(weighted)[2:] * (1.0 if taper is None else taper)
    return np.asarray(fit, dtype=np.complex128), np.asarray(design, dtype=np.complex128)


def wave_cells(modes: ComplexArray, found: Bands) -> FloatArray:
    """Variance that each wave carries: by frequency, and by mode and direction.

    Parameters
    ----------
    modes : ndarray of shape (T, M + 1, R) and dtype complex
    found : Bands

    Returns
    -------
    ndarray of shape (K, 2 M + 1, R) and dtype float
        Mode 0; modes 1 to M that run towards higher sectors; modes 1 to M that run towards lower ones.
    """
    frames, count, movies = modes.shape
    fitted = found.fits @ modes.reshape(frames, -1)
    power = 2.0 * np.abs(fitted.reshape(2, -1, count, movies)) ** 2
    return np.concatenate([power[0], power[1, :, 1:]], axis=1)


def refined_frequency(
    mode: ComplexArray, seconds: FloatArray, start: float, step: float, within: tuple[float, float]
) -> float:
    """Frequency near a start at which a pair of waves explains most of a mode.

    Parameters
    ----------
    mode : ndarray of shape (T,) or (T, R) and dtype complex
        Columns are explained together.
    seconds : ndarray of shape (T,) and dtype float
    start, step : float
        Looked for within a step of the start.
    within : tuple of float
        And between these.
    """
    columns = mode.reshape(len(mode), -1)
    middle = seconds - 0.5 * (seconds[0] + seconds[-1])
    low, high = max(start - step, within[0]), min(start + step, within[1])
    for _ in range(3):
        tried = np.linspace(low, high, 17)
        explained = [_explained(columns, middle, frequency) for frequency in tried]
        best = int(np.argmax(explained))
        low, high = tried[max(best - 1, 0)], tried[min(best + 1, 16)]
    return float(tried[best])


def _explained(columns: ComplexArray, middle: FloatArray, frequency: float) -> float:
    orthonormal = np.linalg.qr(pair_fit(middle, frequency)[1])[0]
    return float((np.abs(orthonormal.conj().T @ columns) ** 2).sum())
