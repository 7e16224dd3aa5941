"""Springs around a closed curve: beads that slide along it and even out their distances."""

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray


def relaxed(places: FloatArray, length: float, stiffness: float) -> FloatArray:
    """Places of beads on a closed curve where springs between neighbours balance those that hold them.

    The minimum over a of Σ (aᵢ - places ᵢ)² + stiffness Σ (aᵢ₊₁ - aᵢ - length / n)².

    Parameters
    ----------
    places : ndarray of shape (n,) and dtype float
        Distances along the curve that the beads are held to, not decreasing through one turn.
    length : float
        Of the curve.
    stiffness : float
        Of the springs between neighbours over that of the others; infinite: all distances are equal.

    Returns
    -------
    ndarray of shape (n,) and dtype float
        Not decreasing through one turn, with the mean of `places`.
    """
    even = np.arange(len(places)) * (length / len(places))
    off = places - even
    if np.isinf(stiffness):
        return np.asarray(even + off.mean())
    waves = np.fft.rfft(off)
    bending = 2.0 - 2.0 * np.cos(2.0 * np.pi * np.arange(len(waves)) / len(places))
    smooth = np.fft.irfft(waves / (1.0 + stiffness * bending), len(places))
    return np.asarray(np.maximum.accumulate(even + smooth))


def relaxed_groups(places: FloatArray, joined: BoolArray, length: float, stiffness: float) -> FloatArray:
    """As `relaxed`, where some neighbours are joined: they are one bead, at the mean of their places.

    Parameters
    ----------
    places : ndarray of shape (n,) and dtype float
    joined : ndarray of shape (n,) and dtype bool
        Whether a bead is joined with the one before it; the first is not.
    length, stiffness : float
        As in `relaxed`.

    Returns
    -------
    ndarray of shape (n,) and dtype float
    """
    group = np.cumsum(~joined) - 1
    means = np.bincount(group, places) / np.bincount(group)
    return np.asarray(relaxed(means, length, stiffness)[group])
