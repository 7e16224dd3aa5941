"""Mean profile of an image by depth below the cell's edge, over all frames of a movie."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.depth import depth_of

_PER_PIXEL = 2  # bins of depth


class DepthProfile:
    """Sums of images by depth.

    Parameters
    ----------
    channels : int
    deepest_px : int
        No pixel lies deeper than that.
    """

    def __init__(self, channels: int, deepest_px: int):
        self._sums = np.zeros((channels, 3, _PER_PIXEL * deepest_px + 2))  # values, depths, pixels

    def add(self, image: FloatArray, mask: BoolArray) -> None:
        """Count a frame in; NaN is no value.

        Parameters
        ----------
        image : ndarray of shape (C, h, w) and dtype float
        mask : ndarray of shape (h, w) and dtype bool
        """
        depth = pixel_depths(mask)
        bins = np.rint(_PER_PIXEL * depth).astype(np.int64)
        length = self._sums.shape[-1]
        for sums, values in zip(self._sums, image[:, mask], strict=True):
            known = np.isfinite(values)
            rows = values[known], depth[known], np.ones(int(known.sum()))
            for row, weights in zip(sums, rows, strict=True):
                row += np.bincount(bins[known], weights, minlength=length)

    def at(self, mask: BoolArray) -> FloatArray:
        """Mean at the depth of each pixel of a mask, in rows, shape (C, pixels).

        Interpolated between the bins; NaN for a channel without a value.
        """
        depth = pixel_depths(mask)
        found = np.full((len(self._sums), len(depth)), np.nan)
        for row, (total, depths, count) in zip(found, self._sums, strict=True):
            held = count > 0
            if held.any():
                row[:] = np.interp(depth, depths[held] / count[held], total[held] / count[held])
        return found


def pixel_depths(mask: BoolArray) -> FloatArray:
    """Distance of each mask pixel, in rows, to the nearest pixel outside, shape (pixels,)."""
    return np.asarray(depth_of(np.pad(mask, 1))[1:-1, 1:-1][mask])
