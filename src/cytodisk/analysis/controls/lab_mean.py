"""Mean over time of an image in the lab, at each place over the frames in which the cell holds it."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray

FEWEST_AT_A_PLACE = 3
"""Frames of which a mean is made at the least: of fewer, it is mostly noise."""


class LabMean:
    """Running sums of images, from which frames can be taken out again.

    Parameters
    ----------
    channels : int
    shape : (int, int)
    """

    def __init__(self, channels: int, shape: tuple[int, int]):
        self._total, self._count = np.zeros((2, channels, *shape))

    def add(self, image: FloatArray, mask: BoolArray) -> None:
        """Count a frame in, at the places that the cell holds; NaN is no value.

        Parameters
        ----------
        image : ndarray of shape (C, h, w) and dtype float
        mask : ndarray of shape (h, w) and dtype bool
        """
        known = mask & np.isfinite(image)
        self._total += np.where(known, image, 0.0)
        self._count += known

    def remove(self, image: FloatArray, mask: BoolArray) -> None:
        """Take a frame out that was counted in."""
        known = mask & np.isfinite(image)
        self._total -= np.where(known, image, 0.0)
        self._count -= known

    def at(self, mask: BoolArray) -> FloatArray:
        """Mean at the places of a mask, in rows, shape (C, pixels).

        NaN where the frames that are counted hold a place fewer than `FEWEST_AT_A_PLACE` times.
        """
        total, count = self._total[:, mask], self._count[:, mask]
        return np.where(count >= FEWEST_AT_A_PLACE, total / np.maximum(count, 1.0), np.nan)
