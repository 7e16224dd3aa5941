"""Waves around the cell and inwards at once: power by waves around, by waves in depth, and by direction."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cytodisk.analysis.waves.mode_spectrum import Bands
from cytodisk.arrays import ComplexArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class DepthWaves:
    """The waves that modes around the cell and layers can show.

    Attributes
    ----------
    around : ndarray of shape (C,) and dtype int
        Waves around the cell.
    direction : ndarray of shape (C,) and dtype int
        1 towards higher sectors, −1 towards lower ones; 1 at mode 0.
    inwards : ndarray of shape (C,) and dtype int
        Waves from the first layer to the last, positive inwards.
    """

    around: IntArray
    direction: IntArray
    inwards: IntArray

    @classmethod
    def of(cls, highest: int, layers: int) -> DepthWaves:
        """All of them, in the order in which `depth_cells` has them."""
        number = np.fft.fftfreq(layers, 1.0 / layers).round().astype(np.int64)
        up = [(mode, 1, one) for mode in range(highest + 1) for one in number]
        down = [(mode, -1, -one) for mode in range(1, highest + 1) for one in number]
        around, direction, inwards = np.array(up + down, dtype=np.int64).T
        return cls(around, direction, inwards)

    def groups(self) -> list[IntArray]:
        """Those that differ in their directions alone."""
        depth = np.abs(self.inwards)
        keys = np.stack([self.around, depth], axis=1)
        return [np.flatnonzero((keys == key).all(axis=1)) for key in np.unique(keys, axis=0)]

    def group_keys(self) -> IntArray:
        """Waves around and in depth of each group, shape (G, 2)."""
        return np.asarray(np.unique(np.stack([self.around, np.abs(self.inwards)], axis=1), axis=0))


def depth_cells(modes: ComplexArray, found: Bands) -> FloatArray:
    """Variance that each wave carries.

    Parameters
    ----------
    modes : ndarray of shape (T, M + 1, L, R) and dtype complex
        Modes around the cell in each layer.
    found : Bands

    Returns
    -------
    ndarray of shape (K, C, R) and dtype float
        By frequency and wave, as `DepthWaves` lists them.
    """
    frames, count, layers, movies = modes.shape
    fitted = (found.fits @ modes.reshape(frames, -1)).reshape(2, -1, count, layers, movies)
    up = np.fft.fft(fitted[0], axis=2) / layers
    down = np.fft.fft(fitted[1, :, 1:], axis=2) / layers
    power = [2.0 * np.abs(one) ** 2 for one in (up, down)]
    return np.concatenate([one.reshape(len(one), -1, movies) for one in power], axis=1)
