"""Pixels of one frame of an image file, piece by piece, so that memory does not grow with the frame."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from cytodisk.images.frames import FrameFile, reading
from cytodisk.images.npy import read_npy
from cytodisk.images.tiff_pages import opened_tiff
from cytodisk.images.tiff_segments import TiffSegments

WHOLE_BYTES = 2**25
"""A frame up to this size is read as a whole."""

_STRIP_PX = 2**20  # pixels that are looked at together

Cut: TypeAlias = Callable[[slice, slice], np.ndarray[Any, Any]]


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
            cut, rows_together = _cut_from_file(file, number)
        if cut is not None:
            return FramePixels(shape, file.dtype, cut, rows_together, is_whole=False)
    return whole_pixels(file.frame(number))


def whole_pixels(frame: np.ndarray[Any, Any]) -> FramePixels:
    """A frame (C, H, W) in memory."""
    channels, height, width = frame.shape
    return FramePixels((channels, height, width), frame.dtype, partial(_cut_from_memory, frame))


def _cut_from_memory(frame: np.ndarray[Any, Any], rows: slice, columns: slice) -> np.ndarray[Any, Any]:
    return frame[:, rows, columns]


def _cut_from_file(file: FrameFile, number: int) -> tuple[Cut | None, int]:
    """How to cut pieces out of a frame, and how many rows lie together; None if it must be read whole."""
    array = _Stored.of(file)
    if array is not None:
        return partial(_cut_from_array, array, file, number), 1
    segments = TiffSegments.of(file, number) if file.path.suffix.lower() in (".tif", ".tiff") else None
    if segments is None:
        return None, 1
    return partial(_cut_from_segments, segments, file, number), segments.height


@dataclass(frozen=True)
class _Stored:
    """An array as it stands in a file, uncompressed."""

    path: Path
    dtype: np.dtype[Any]
    offset: int
    order: Any

    @classmethod
    def of(cls, file: FrameFile) -> _Stored | None:
        suffix = file.path.suffix.lower()
        if suffix == ".npy":
            array = read_npy(file.path)
            if not isinstance(array, np.memmap):
                return None
            order = "C" if array.flags.c_contiguous else "F"
            return cls(file.path, array.dtype, int(array.offset), order)
        if suffix not in (".tif", ".tiff"):
            return None
        with opened_tiff(file.path) as tiff:
            series = tiff.series[0]
            if series.is_multifile or series.dataoffset is None:
                return None
            dtype = np.dtype(tiff.byteorder + np.dtype(series.dtype).char)
            return cls(file.path, dtype, int(series.dataoffset), "C")

    def mapped(self, file: FrameFile, number: int) -> np.ndarray[Any, Any]:
        """A frame, not read yet; what is read of it is given back when it goes."""
        shape, offset = file.shape, self.offset
        if file.axes[0] == "T" and self.order == "C":  # the others may be missing in a file that is cut short
            shape = file.shape[1:]
            offset += number * math.prod(shape) * self.dtype.itemsize
            return np.memmap(self.path, self.dtype, "r", offset, shape)
        array = np.memmap(self.path, self.dtype, "r", offset, shape, self.order)
        frame: np.ndarray[Any, Any] = array[
            tuple(number if axis == "T" else slice(None) for axis in file.axes)
        ]
        return frame


def _cut_from_array(
    array: _Stored, file: FrameFile, number: int, rows: slice, columns: slice
) -> np.ndarray[Any, Any]:
    place = {"C": slice(None), "Y": rows, "X": columns}
    order = [axis for axis in file.axes if axis != "T"]
    with reading(file.path, f"frame {number}"):
        piece = array.mapped(file, number)[tuple(place[axis] for axis in order)]
        moved = piece.transpose([order.index(axis) for axis in "CYX" if axis in order])
        return np.array(moved if "C" in order else moved[None], dtype=piece.dtype.newbyteorder("="))


def _cut_from_segments(
    segments: TiffSegments, file: FrameFile, number: int, rows: slice, columns: slice
) -> np.ndarray[Any, Any]:
    with reading(file.path, f"frame {number}"):
        return segments.cut(rows, columns)
