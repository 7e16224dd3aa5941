"""How much a source varies in each sector and around each frame: what surrogates keep in its place."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.ndimage import gaussian_filter1d

from cytodisk.arrays import BoolArray, FloatArray

_LEAST = 0.01  # of the mean: what is all but still would be blown up beyond measure


@dataclass(frozen=True, eq=False)
class Scales:
    """Scale of a source at frame t and sector s: `frames[t] * sectors[s]`.

    Attributes
    ----------
    frames : ndarray of shape (T,) and dtype float
        Changes slowly, so that it is the same for all lags of a row.
    sectors : ndarray of shape (S,) and dtype float
    """

    frames: FloatArray
    sectors: FloatArray

    @classmethod
    def of(cls, source: FloatArray, known: BoolArray, width: float) -> Scales:
        """Mean magnitude by sector, and around each frame.

        Parameters
        ----------
        source : ndarray of shape (T, S) and dtype float
            Mean 0 in each sector, and 0 where it is not known.
        known : ndarray of shape (T, S) and dtype bool
        width : float
            Standard deviation of the window around a frame, in frames.
        """
        size = np.where(known, np.abs(source), 0.0)
        sectors = _floored(size.sum(axis=0), known.sum(axis=0))
        by_frame = (size / sectors).sum(axis=1), known.sum(axis=1).astype(np.float64)
        smooth = [gaussian_filter1d(one, width, mode="constant", truncate=3.0) for one in by_frame]
        return cls(_floored(smooth[0], smooth[1]), sectors)

    @classmethod
    def alike(cls, frames: int, sectors: int) -> Scales:
        """1 everywhere."""
        return cls(np.ones(frames), np.ones(sectors))

    @property
    def table(self) -> FloatArray:
        """Of every frame and sector, shape (T, S)."""
        return self.frames[:, None] * self.sectors


def _floored(total: FloatArray, weight: FloatArray) -> FloatArray:
    """Totals over weights, the mean where nothing is known, and never next to nothing; 1 if all is 0."""
    there = weight > 1e-6 * max(float(weight.max()), 1e-300)
    means = np.where(there, total / np.where(there, weight, 1.0), np.nan)
    mean = float(np.nanmean(means)) if there.any() else 0.0
    if mean <= 0:
        return np.ones(len(total))
    return np.asarray(np.maximum(np.nan_to_num(means, nan=mean), _LEAST * mean))
