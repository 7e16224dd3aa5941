"""Arrays saved by NumPy, Cellpose's `_seg.npy` among them, and arrays that stand in any file uncompressed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.file_axes import file_axes
from cytodisk.images.formats.file_metadata import channel_names
from cytodisk.images.formats.npy import read_npy
from cytodisk.images.frame_file import Cut, FileChoice, FrameFile, as_channels_first
from cytodisk.images.reading import reading


def open_array(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a saved array without reading its numbers; see `cytodisk.images.frames.open_frames`."""
    array = read_npy(file)
    if array.ndim < 2 or not array.size:
        raise ReadError(f"{file} has shape {array.shape}: save an array of shape (H, W) or (frames, H, W)")
    if array.dtype.kind not in "biuf":
        raise ReadError(f"{file} has dtype {array.dtype}: save an array of numbers, labels as uint16")
    of_cellpose = file.name.lower().endswith("_seg.npy")
    said = ("Z" if of_cellpose and array.ndim == 3 else "Q" * (array.ndim - 2)) + "YX"
    known = file_axes(file, said, array.shape, unnamed, choice.axes)
    axes, shape = known.letters, known.shape
    channels = channel_names((), shape[axes.index("C")] if "C" in axes else 1)
    return FrameFile(
        file,
        axes,
        shape,
        array.dtype,
        channels,
        NpyFrames(file, axes, shape),
        evidence=known.evidence,
        said_by=known.said_by,
        doubt=known.doubt,
    )


@dataclass(frozen=True)
class NpyFrames:
    """Frames of a saved array.

    Attributes
    ----------
    path : Path
    axes : str
    shape : tuple of int
        Without axes of length 1 beside Y and X.
    """

    path: Path
    axes: str
    shape: tuple[int, ...]

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        whole = read_npy(self.path).reshape(self.shape)
        frame = np.array(whole.take(number, axis=self.axes.index("T")) if "T" in self.axes else whole)
        return as_channels_first(frame, self.axes)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None for a pickle."""
        array = read_npy(self.path)
        if not isinstance(array, np.memmap):
            return None
        order = "C" if array.flags.c_contiguous else "F"
        stored = StoredArray(self.path, array.dtype, int(array.offset), order)
        return ArrayFrames(stored, self.axes, self.shape).by_piece(number)


@dataclass(frozen=True)
class StoredArray:
    """An array as it stands in a file, uncompressed."""

    path: Path
    dtype: np.dtype[Any]
    offset: int
    order: Any


@dataclass(frozen=True)
class ArrayFrames:
    """Frames of an uncompressed array.

    Attributes
    ----------
    array : StoredArray
    axes : str
    shape : tuple of int
    """

    array: StoredArray
    axes: str
    shape: tuple[int, ...]

    def by_piece(self, number: int) -> tuple[Cut, int]:
        """How to cut pieces out of a frame."""
        return partial(self.cut, number), 1

    def cut(self, number: int, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        """Pixels (C, h, w) of some rows and columns of a frame."""
        place = {"C": slice(None), "Y": rows, "X": columns}
        order = self.axes.replace("T", "")
        with reading(self.array.path, f"frame {number}"):
            piece = self.mapped(number)[tuple(place[axis] for axis in order)]
            moved = as_channels_first(piece, order)
            return np.array(moved, dtype=piece.dtype.newbyteorder("="))

    def mapped(self, number: int) -> np.ndarray[Any, Any]:
        """A frame, not read yet; what is read of it is given back when it goes."""
        path, dtype, offset, order = self.array.path, self.array.dtype, self.array.offset, self.array.order
        if self.axes[0] == "T" and order == "C":  # the others may be missing in a file that is cut short
            shape = self.shape[1:]
            offset += number * math.prod(shape) * dtype.itemsize
            return np.memmap(path, dtype, "r", offset, shape)
        array = np.memmap(path, dtype, "r", offset, self.shape, order)
        frame: np.ndarray[Any, Any] = array[
            tuple(number if axis == "T" else slice(None) for axis in self.axes)
        ]
        return frame
