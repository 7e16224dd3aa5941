"""`PlacedMask`: the box of a mask in its image, so that memory goes by the cell and not by the image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray


@dataclass(frozen=True, eq=False)
class PlacedMask:
    """The box of a mask, and where it lies in the image.

    Attributes
    ----------
    box : ndarray of shape (h, w) and dtype bool
        Holds all pixels of the cell.
    corner : (int, int)
        (row, column) of its first pixel in the image.
    image_shape : (int, int)
    """

    box: BoolArray
    corner: tuple[int, int]
    image_shape: tuple[int, int]

    @classmethod
    def of(
        cls, mask: BoolArray, corner: Sequence[int] = (0, 0), image_shape: Sequence[int] = ()
    ) -> PlacedMask:
        """The smallest box of a mask that holds some pixel, with pixels of its own.

        Parameters
        ----------
        mask : ndarray of shape (H, W) and dtype bool
        corner : (int, int)
            (row, column) of its first pixel in the image.
        image_shape : (int, int), optional
            By default that of the mask.
        """
        rows = np.flatnonzero(mask.any(axis=1))
        strip = mask[rows[0] : rows[-1] + 1]
        columns = np.flatnonzero(strip.any(axis=0))
        box = strip[:, columns[0] : columns[-1] + 1].copy()
        height, width = image_shape or mask.shape
        return cls(box, (int(corner[0] + rows[0]), int(corner[1] + columns[0])), (height, width))

    @property
    def whole(self) -> BoolArray:
        """The mask in its image, shape (H, W) and dtype bool; made anew each time."""
        mask = np.zeros(self.image_shape, dtype=bool)
        mask[self.slices] = self.box
        return mask

    @property
    def slices(self) -> tuple[slice, slice]:
        """Rows and columns of the box in the image."""
        (y, x), (height, width) = self.corner, self.box.shape
        return slice(y, y + height), slice(x, x + width)

    @property
    def pixels_yx(self) -> IntArray:
        """(row, column) in the image of each pixel of the cell, in row-major order, shape (P, 2)."""
        pixels: IntArray = np.argwhere(self.box) + np.array(self.corner)
        return pixels

    def beside(self, mask: BoolArray, corner: Sequence[int] = (0, 0)) -> PlacedMask:
        """What another mask has in the same box.

        Parameters
        ----------
        mask : ndarray of shape (H, W) and dtype bool
        corner : (int, int)
            (row, column) of its first pixel in the image.
        """
        y, x = self.corner[0] - corner[0], self.corner[1] - corner[1]
        height, width = self.box.shape
        return replace(self, box=mask[y : y + height, x : x + width].copy())

    def within(self, corner: tuple[int, int], image_shape: tuple[int, int]) -> PlacedMask:
        """The same mask in a larger image that its own was cut out of at a corner."""
        (y, x), (row, column) = self.corner, corner
        return PlacedMask(self.box, (y + row, x + column), image_shape)

    def cut_out_of(self, image: Any) -> Any:
        """The part of an image (…, H, W) that the box covers."""
        return image[(..., *self.slices)]

    def holds(self, points_yx: FloatArray) -> BoolArray:
        """Whether the pixel that each point of the image lies in is one of the mask, shape (N,).

        Parameters
        ----------
        points_yx : ndarray of shape (N, 2) and dtype float
            (row, column) in pixels; NaN lies in none.
        """
        found = np.zeros(len(points_yx), dtype=bool)
        known = np.isfinite(points_yx).all(axis=1)
        place = np.rint(points_yx[known]).astype(np.int64) - np.array(self.corner)
        within = ((place >= 0) & (place < self.box.shape)).all(axis=1)
        found[np.flatnonzero(known)[within]] = self.box[tuple(place[within].T)]
        return found

    def outside(self, other: PlacedMask) -> IntArray:
        """Pixels of this cell that are none of another one in the same image, shape (P, 2)."""
        left, (here, there) = self.box.copy(), self._shared(other)
        left[here] &= ~other.box[there]
        return replace(self, box=left).pixels_yx

    def touches(self, other: PlacedMask) -> bool:
        """Whether it shares a pixel with another mask in the same image."""
        here, there = self._shared(other)
        return bool((self.box[here] & other.box[there]).any())

    def _shared(self, other: PlacedMask) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
        """Rows and columns that two boxes in one image share, in this box and in the other."""
        sides = [
            (max(a.start, b.start), max(a.start, b.start, min(a.stop, b.stop)))
            for a, b in zip(self.slices, other.slices, strict=True)
        ]
        (top, bottom), (left, right) = sides
        here, there = (
            (slice(top - y, bottom - y), slice(left - x, right - x)) for y, x in (self.corner, other.corner)
        )
        return here, there
