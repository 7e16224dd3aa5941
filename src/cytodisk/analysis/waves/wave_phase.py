"""Phase of a wave through time: of each sector, and of the mode that runs."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import ComplexArray, FloatArray

_WINDOW = 0.5  # periods; standard deviation of the window in which a phase is measured
_REACH = 4.0  # standard deviations beyond which it counts for nothing
_KEPT = np.exp(-1.0)


def demodulated(series: ComplexArray | FloatArray, seconds: FloatArray, frequency: float) -> ComplexArray:
    """Amplitude and phase of one period in series, frame by frame.

    Parameters
    ----------
    series : ndarray of shape (T, N), dtype float or complex
        NaN is left out.
    seconds : ndarray of shape (T,) and dtype float
    frequency : float
        In 1/s; negative for what turns the other way.

    Returns
    -------
    ndarray of shape (T, N) and dtype complex
        A cos(ω t + φ) has A exp(i (ω t + φ)); of complex series A exp(i ω t) has 2 A exp(i ω t). The window
        is a Gaussian with half a period as standard deviation; NaN where half of its weight has no values.
    """
    known = np.isfinite(series)
    with np.errstate(invalid="ignore"):
        centred = np.where(known, series - _means(series, known), 0.0)
    apart = (seconds - seconds[:, None]) * abs(frequency) / _WINDOW
    window = np.where(np.abs(apart) < _REACH, np.exp(-0.5 * apart**2), 0.0)
    back = np.exp(-2j * np.pi * frequency * seconds)
    weight = window @ known
    found = 2.0 * (window @ (centred * back[:, None])) * back.conj()[:, None]
    enough = weight >= 0.5 * window.sum(axis=1, keepdims=True)
    return np.asarray(np.where(enough, found / np.where(weight > 0, weight, 1.0), np.nan))


def pair_amplitudes(mode: ComplexArray, seconds: FloatArray, frequency: float) -> ComplexArray:
    """Amplitudes (T, 2) of what runs towards higher and towards lower sectors, without its turning.

    Parameters
    ----------
    mode : ndarray of shape (T,) and dtype complex
    seconds : ndarray of shape (T,) and dtype float
    frequency : float
        In 1/s.
    """
    turn = np.exp(2j * np.pi * frequency * seconds)
    up = demodulated(mode[:, None], seconds, -frequency)[:, 0] * turn
    down = demodulated(mode[:, None], seconds, frequency)[:, 0] * turn.conj()
    return np.stack([up, down], axis=1)


def mode_field(
    pair: ComplexArray, seconds: FloatArray, frequency: float, mode: int, angles: FloatArray
) -> ComplexArray:
    """The wave of one mode at every sector, as amplitude and phase.

    Parameters
    ----------
    pair : ndarray of shape (T, 2) and dtype complex
        Of `pair_amplitudes`.
    seconds : ndarray of shape (T,) and dtype float
    frequency : float
        In 1/s.
    mode : int
    angles : ndarray of shape (T, S) and dtype float
        Middles of the sectors, of `sector_angles`.

    Returns
    -------
    ndarray of shape (T, S) and dtype complex
        Its real part is the wave.
    """
    turn = np.exp(2j * np.pi * frequency * seconds)[:, None]
    place = np.exp(1j * mode * angles)
    down = pair[:, 1:] * turn * place
    return np.asarray(down + pair[:, :1].conj() * turn * place.conj() if mode else down)


def travel_direction(pair: ComplexArray) -> float:
    """From −1, all runs towards lower sectors, to 1, all towards higher ones; 0 stands."""
    up, down = (np.abs(pair) ** 2).sum(axis=0)
    return float((up - down) / (up + down)) if up + down else 0.0


def persistence(pair: ComplexArray, seconds: FloatArray, interval: float) -> float:
    """Time over which amplitudes keep their phase and direction, in seconds.

    Parameters
    ----------
    pair : ndarray of shape (T, 2) and dtype complex
        Of `pair_amplitudes`.
    seconds : ndarray of shape (T,) and dtype float
    interval : float
        Seconds between frames.

    Returns
    -------
    float
        The shortest time after which their correlation with themselves is below 1 / e; the whole duration
        where it never is.
    """
    duration = float(seconds[-1] - seconds[0] + interval)
    apart = np.round((seconds - seconds[:, None]) / interval).astype(np.int64)
    product = pair.conj() @ pair.T
    size = (np.abs(pair) ** 2).sum(axis=1)
    ahead = apart >= 0
    lag = apart[ahead]
    both = np.bincount(lag, product[ahead].real) + 1j * np.bincount(lag, product[ahead].imag)
    first = np.bincount(lag, np.broadcast_to(size[:, None], apart.shape)[ahead])
    second = np.bincount(lag, np.broadcast_to(size, apart.shape)[ahead])
    scale = np.sqrt(first * second)
    kept = np.abs(both) / np.where(scale > 0, scale, 1.0)
    lost = np.flatnonzero((kept < _KEPT) & (np.bincount(lag) > 0))
    return float(lost[0] * interval) if lost.size else duration


def _means(series: ComplexArray | FloatArray, known: np.ndarray) -> np.ndarray:
    total = np.where(known, series, 0.0).sum(axis=0)
    return np.asarray(total / np.maximum(known.sum(axis=0), 1))
