"""Arrays saved by NumPy, Cellpose's `_seg.npy` among them, and arrays that stand in any file uncompressed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.chosen_channels import channel_names
from cytodisk.images.formats.npy import read_npy
from cytodisk.images.formats.projection import projected
from cytodisk.images.formats.stored_axes import stored_axes
from cytodisk.images.frame_file import Cut, FileChoice, FrameFile, as_channels_first
from cytodisk.images.reading import reading


def open_array(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a saved array without reading its numbers; see `cytodisk.images.frames.open_frames`."""
    array = read_npy(file)
    if array.ndim < 2 or not array.size:
        raise ReadError(f"{file} has shape {array.shape}: save an array of shape (H, W) or (frames, H, W)")
    if array.dtype.kind not in "biuf":
        raise ReadError(f"{file} has the type {array.dtype}: save an array of numbers, labels as uint16")
    of_cellpose = file.name.lower().endswith("_seg.npy")
    said = ("Z" if of_cellpose and array.ndim == 3 else "Q" * (array.ndim - 2)) + "YX"
    if array.ndim > 2 and array.shape[-1] == 1:  # no image is one pixel wide: it is the only channel
        said = "Q" * (array.ndim - 3) + "YXC"
    stored = stored_axes(file, said, array.shape, unnamed, choice)
    known = stored.known
    channels = channel_names((), known.shape[known.letters.index("C")] if "C" in known.letters else 1)
    return FrameFile(
        file,
        known.letters,
        known.shape,
        stored.pixel_type(array.dtype),
        channels,
        NpyFrames(file, stored.axes, stored.shape, stored.slices, stored.z),
        evidence=known.evidence,
        said_by=known.said_by,
        doubt=known.doubt,
        offers=stored.offers,
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
    slices : tuple of int
        The slices that are read of a z-stack.
    z : int, "max" or "mean"
        What is made of them.
    """

    path: Path
    axes: str
    shape: tuple[int, ...]
    slices: tuple[int, ...] = (0,)
    z: int | str = 0

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        whole = read_npy(self.path).reshape(self.shape)
        rest = self.axes.replace("T", "").replace("Z", "")
        taken = ({"T": number, "Z": z} for z in self.slices)
        planes = (
            np.array(whole[tuple(place.get(axis, slice(None)) for axis in self.axes)]) for place in taken
        )
        return as_channels_first(projected(planes, self.z), rest)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None for a pickle."""
        array = read_npy(self.path)
        if not isinstance(array, np.memmap) or len(self.slices) > 1:
            return None
        order = "C" if array.flags.c_contiguous else "F"
        stored = StoredArray(self.path, array.dtype, int(array.offset), order)
        return ArrayFrames(stored, self.axes, self.shape, self.slices[0]).by_piece(number)


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
        T, C, Z, Y and X.
    shape : tuple of int
    z : int
        The slice of a z-stack.
    """

    array: StoredArray
    axes: str
    shape: tuple[int, ...]
    z: int = 0

    def by_piece(self, number: int) -> tuple[Cut, int]:
        """How to cut pieces out of a frame."""
        return partial(self.cut, number), 1

    def cut(self, number: int, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        """Pixels (C, h, w) of some rows and columns of a frame."""
        place = {"C": slice(None), "Y": rows, "X": columns}
        order = self.axes.replace("T", "").replace("Z", "")
        with reading(self.array.path, f"frame {number}"):
            piece = self.mapped(number)[tuple(place[axis] for axis in order)]
            moved = as_channels_first(piece, order)
            return np.array(moved, dtype=piece.dtype.newbyteorder("="))

    def mapped(self, number: int) -> np.ndarray[Any, Any]:
        """A frame, not read yet; what is read of it is given back when it goes."""
        path, dtype, offset, order = self.array.path, self.array.dtype, self.array.offset, self.array.order
        axes, shape, taken = self.axes, self.shape, {"T": number, "Z": self.z}
        while (
            order == "C" and axes[0] in taken
        ):  # what stands after may be missing in a file that is cut short
            offset += taken[axes[0]] * math.prod(shape[1:]) * dtype.itemsize
            axes, shape = axes[1:], shape[1:]
        array = np.memmap(path, dtype, "r", offset, shape, order)
        frame: np.ndarray[Any, Any] = array[tuple(taken.get(axis, slice(None)) for axis in axes)]
        return frame
