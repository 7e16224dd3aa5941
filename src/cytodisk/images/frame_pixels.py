"""Pixels of one frame of an image file, piece by piece, so that memory does not grow with the frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from cytodisk.images.frame_file import Cut, FrameFile
from cytodisk.images.reading import reading

WHOLE_BYTES = 2**25
"""A frame up to this size is read as a whole."""

_STRIP_PX = 2**20  # pixels that are looked at together


@dataclass(frozen=True, eq=False)
class FramePixels:
    """A frame that gives its pixels by piece.

    Attributes
    ----------
    shape : (int, int, int)
        (C, H, W).
    dtype : numpy.dtype
    cut : callable
        Gives the pixels of some rows and columns, shape (C, h, w). Raises `ReadError` where the file is
        damaged.
    rows_together : int
        Rows that lie together in the file.
    is_whole : bool
        Whether the frame is in memory.
    """

    shape: tuple[int, int, int]
    dtype: np.dtype[Any]
    cut: Cut
    rows_together: int = 1
    is_whole: bool = True

    @property
    def image_shape(self) -> tuple[int, int]:
        """(H, W)."""
        return self.shape[1], self.shape[2]

    def strips(self) -> Iterator[tuple[int, np.ndarray[Any, Any]]]:
        """Number of the first row, and pixels (h, W) of the first channel, strip after strip."""
        height, width = self.image_shape
        rows = max(1, _STRIP_PX // width)
        # Where the file has them in larger pieces than a strip, a piece is kept from one strip to the next.
        step = rows if rows < self.rows_together else rows // self.rows_together * self.rows_together
        for first in range(0, height, step):
            yield first, self.cut(slice(first, min(first + step, height)), slice(0, width))[0]


def frame_pixels(file: FrameFile, number: int) -> FramePixels:
    """Open a frame for reading by piece.

    A small frame is read at once, and so is one that is stored as one piece: PNG, a `_seg.npy`, a TIFF whose
    layout is unusual.

    Parameters
    ----------
    file : FrameFile
    number : int
        From 0.

    Returns
    -------
    FramePixels

    Raises
    ------
    ReadError
        The frame is damaged.
    """
    height, width = file.image_shape
    shape = (len(file.channels) if "C" in file.axes else 1, height, width)
    if np.prod(shape) * file.dtype.itemsize > WHOLE_BYTES:
        with reading(file.path, f"frame {number}"):
            by_piece = file.stored.by_piece(number)
        if by_piece is not None:
            return FramePixels(shape, file.dtype, *by_piece, is_whole=False)
    return whole_pixels(file.frame(number))


def whole_pixels(frame: np.ndarray[Any, Any]) -> FramePixels:
    """A frame (C, H, W) in memory."""
    channels, height, width = frame.shape
    return FramePixels((channels, height, width), frame.dtype, partial(_cut_from_memory, frame))


def _cut_from_memory(frame: np.ndarray[Any, Any], rows: slice, columns: slice) -> np.ndarray[Any, Any]:
    return frame[:, rows, columns]
