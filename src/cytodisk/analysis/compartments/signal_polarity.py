"""How one-sided a signal is around the nucleus: the first harmonic of the cytoplasm's sectors."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from cytodisk.analysis.compartments.layer_sums import group_means
from cytodisk.arrays import FloatArray

_ABOVE_NOISE = 2.0
"""Pixels' spread alone gives a polarity of more than so many times its usual size in 2 % of cells."""


class SignalPolarity(NamedTuple):
    """First harmonic of the means of sectors.

    Attributes
    ----------
    size : float
        0 if all sectors are alike, 1 if one sector holds all.
    direction : float
        Angle in the disk, in degrees from sector 0 on; NaN without a direction.
    reason : str
        Why a number is missing; empty if none is.
    """

    size: float
    direction: float
    reason: str


def signal_polarity(mean: FloatArray, sd: FloatArray, n_pixels: FloatArray) -> SignalPolarity:
    """Polarity of a signal in the cytoplasm.

    Parameters
    ----------
    mean, sd, n_pixels : ndarray of shape (layers, sectors) and dtype float
        Of the windows of the cytoplasm, as `sample` gives them.

    Returns
    -------
    SignalPolarity
    """
    sectors = group_means(mean.T, n_pixels.T)
    total = sectors.mean.sum()
    if np.isnan(total):
        return SignalPolarity(np.nan, np.nan, "a sector has no number")
    if sectors.mean.min() < 0.0 or total <= 0.0:
        return SignalPolarity(np.nan, np.nan, "the mean of a sector is below 0, or all are 0")
    angles = 2.0 * np.pi * (np.arange(len(sectors.mean)) + 0.5) / len(sectors.mean)
    harmonic = np.sum(sectors.mean * np.exp(1j * angles)) / total
    known = np.isfinite(mean)
    spread = np.where(known, n_pixels * np.square(sd), 0.0).sum(axis=0) / np.square(sectors.pixels)
    by_chance = np.sqrt(spread.sum()) / total
    size = float(abs(harmonic))
    if size <= max(_ABOVE_NOISE * by_chance, 1e-9):
        return SignalPolarity(size, np.nan, "polarity within the noise of pixels: no direction")
    return SignalPolarity(size, float(np.degrees(np.angle(harmonic))), "")
