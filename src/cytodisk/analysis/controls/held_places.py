"""Places in the image that a cell holds, frame by frame, cut out of the image and packed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cytodisk.arrays import BoolArray, FloatArray


@dataclass(frozen=True, eq=False)
class HeldPlaces:
    """Masks of a cell in the part of the image that it ever holds, an eighth of a byte a pixel.

    Attributes
    ----------
    corner : (int, int)
        (row, column) of the part's first pixel in the image.
    shape : (int, int)
        (h, w) of the part.
    packed : dict of int to ndarray
        Bits of each frame's mask.
    """

    corner: tuple[int, int]
    shape: tuple[int, int]
    packed: dict[int, NDArray[np.uint8]]

    @classmethod
    def of(cls, masks: Any) -> HeldPlaces:
        """Take in masks.

        Parameters
        ----------
        masks : iterable of (int, ndarray of shape (H, W) and dtype bool)
            Number and mask of each frame, at least one; read one at a time.
        """
        crops = {frame: _cropped(mask) for frame, mask in masks}
        low = np.min([corner for corner, _, _ in crops.values()], axis=0)
        high = np.max([np.add(corner, shape) for corner, shape, _ in crops.values()], axis=0)
        whole = (int(high[0] - low[0]), int(high[1] - low[1]))
        packed = {}
        for frame, (corner, shape, bits) in crops.items():
            mask = np.zeros(whole, dtype=bool)
            row, column = np.subtract(corner, low)
            mask[row : row + shape[0], column : column + shape[1]] = _unpacked(bits, shape)
            packed[frame] = np.packbits(mask)
        return cls((int(low[0]), int(low[1])), whole, packed)

    def mask(self, frame: int) -> BoolArray:
        """Mask of a frame, shape (h, w)."""
        return _unpacked(self.packed[frame], self.shape)

    def cut(self, image: Any) -> FloatArray:
        """The part out of an image (C, H, W), shape (C, h, w)."""
        (row, column), (height, width) = self.corner, self.shape
        part = np.asarray(image)[:, row : row + height, column : column + width]
        return part.astype(np.float64)


def _cropped(mask: BoolArray) -> tuple[tuple[int, int], tuple[int, int], NDArray[np.uint8]]:
    rows, columns = (np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0))
    crop = mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    height, width = crop.shape
    return (int(rows[0]), int(columns[0])), (height, width), np.packbits(crop)


def _unpacked(bits: NDArray[np.uint8], shape: tuple[int, int]) -> BoolArray:
    return np.unpackbits(bits, count=shape[0] * shape[1]).reshape(shape).astype(bool)
