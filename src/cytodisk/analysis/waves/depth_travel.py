"""How a wave runs from layer to layer: phase by depth, speed inwards."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import ComplexArray, FloatArray

_TRIED = 801
_QUARTER = 0.5 * np.pi  # phase over the whole depth below which a wave is at all depths at once


@dataclass(frozen=True, eq=False)
class DepthTravel:
    """How a wave runs inwards.

    Attributes
    ----------
    wave_number : float
        Phase per unit of depth in radians, positive where inner layers are later.
    direction : float
        From −1, all power runs outwards, to 1, all runs inwards.
    lag : ndarray of shape (L,) and dtype float
        Phase by which each layer is later than the first, in radians.
    slope : ndarray of shape (L,) and dtype float
        Phase per unit of depth at each layer; NaN where it is too small to be told from none.
    """

    wave_number: float
    direction: float
    lag: FloatArray
    slope: FloatArray


def depth_travel(up: ComplexArray, down: ComplexArray | None, depth: FloatArray) -> DepthTravel:
    """Phase of a wave by depth.

    Parameters
    ----------
    up : ndarray of shape (T, L) and dtype complex
        Amplitudes of what runs towards higher sectors, without its turning: of exp(−i ω t).
    down : ndarray of shape (T, L) and dtype complex, optional
        Of exp(+i ω t); not at mode 0, where it is the conjugate of the other.
    depth : ndarray of shape (L,) and dtype float
        They increase.
    """
    together = up.T @ up.conj()
    if down is not None:
        together = together + down.conj().T @ down
    whole = float(depth[-1] - depth[0])
    if len(depth) < 2 or not np.abs(together).max() > 0:
        return DepthTravel(0.0, 0.0, np.zeros(len(depth)), np.full(len(depth), np.nan))
    most = np.pi / float(np.median(np.diff(depth)))
    tried = np.linspace(-most, most, _TRIED)
    beams = _beam(together, depth, tried)
    best = int(np.argmax(beams))
    fine = np.linspace(tried[max(best - 1, 0)], tried[min(best + 1, _TRIED - 1)], 101)
    wave_number = float(fine[int(np.argmax(_beam(together, depth, fine)))])
    there, back = _beam(together, depth, np.array([wave_number, -wave_number]))
    direction = float(np.sign(wave_number) * (there - back) / (there + back))
    strongest = np.linalg.eigh(together)[1][:, -1]
    lag = np.unwrap(np.angle(strongest))
    slope = np.gradient(lag, depth)
    return DepthTravel(
        wave_number, direction, lag - lag[0], np.where(np.abs(slope) * whole >= _QUARTER, slope, np.nan)
    )


def _beam(together: ComplexArray, depth: FloatArray, wave_numbers: FloatArray) -> FloatArray:
    """Power of what runs with each of some wave numbers."""
    steered = np.exp(1j * np.outer(wave_numbers, depth))
    return np.asarray(np.einsum("kl,lm,km->k", steered.conj(), together, steered).real.clip(min=1e-300))
