"""An image file as a sequence of frames, whatever its format."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol, TypeAlias

import numpy as np

from cytodisk.images.claims import check_memory
from cytodisk.images.file_axes import Said
from cytodisk.images.reading import reading
from cytodisk.scale import UNKNOWN, Scale

Cut: TypeAlias = Callable[[slice, slice], np.ndarray[Any, Any]]


class StoredFrames(Protocol):
    """How a format gives the frames of a file; can be sent to other processes, so it holds no open file."""

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W); whatever a decoder raises is turned into a `ReadError`."""
        ...

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces (C, h, w) out of a frame, and how many rows lie together in the file.

        None where the frame is stored as one piece, so that it must be read whole.
        """
        ...


@dataclass(frozen=True)
class FileChoice:
    """What a user says of a file that holds more than one movie, or does not say what its axes are.

    Attributes
    ----------
    axes : str or None
        One letter an axis of the file's array (T, C, Z, Y, X); overrules what the file says.
    scene : str or None
        Number from 0, or name, of a scene (position, series, image) of the file.
    z : str or None
        Number from 0 of a slice of a z-stack, or "max" or "mean" for a projection.
    channels : tuple of str, or None
        Names, or numbers from 0, of the channels to take, in this order; `open_frames` takes them out of
        any format, which reads all.
    like : (int, int, int), or None
        (frames, H, W) of the image that goes with a file of outlines, which does not say it.
    """

    axes: str | None = None
    scene: str | None = None
    z: str | None = None
    channels: tuple[str, ...] | None = None
    like: tuple[int, int, int] | None = None


NO_CHOICE = FileChoice()


@dataclass(frozen=True)
class FrameFile:
    """An image file as a sequence of frames, each (channel, y, x).

    Attributes
    ----------
    path : Path
    axes : str
        Axes of the file as understood, one letter each: T frames, C channels, Y, X.
    shape : tuple of int
        Along `axes`.
    dtype : numpy.dtype
    channels : tuple of str
        Names; a format that knows none calls them "0", "1", …, and `open_frames` after the file.
    stored : StoredFrames
        Reads its pixels.
    scale : Scale
        What the metadata says of it.
    notes : tuple of str
        What was found wrong with its metadata, and what is not known for that, in words.
    evidence : str
        How its axes are known, in words, as "axes TYX by its metadata"; empty for a plain image.
    said_by : {"user", "file", "nobody"}
        Who named its axes; where nobody did, they are a guess.
    doubt : str
        What speaks against a guess, in words that end with the remedy; empty if nothing does.
    offers : tuple of str
        What a user has to choose in it: "scene" and "z", where there are several.
    unnamed : bool
        The file has no names for its channels: they are called after it.
    files : tuple of Path
        The files that it consists of, where `path` is a folder or a pattern; one a frame.
    """

    path: Path
    axes: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    channels: tuple[str, ...]
    stored: StoredFrames
    scale: Scale = UNKNOWN
    notes: tuple[str, ...] = ()
    evidence: str = ""
    said_by: Said = "file"
    doubt: str = ""
    offers: tuple[str, ...] = ()
    unnamed: bool = False
    files: tuple[Path, ...] = ()

    @property
    def n_frames(self) -> int:
        """Frames in the file, 1 for a single image."""
        return self.shape[self.axes.index("T")] if "T" in self.axes else 1

    @property
    def image_shape(self) -> tuple[int, int]:
        """(H, W) of a frame."""
        return self.shape[self.axes.index("Y")], self.shape[self.axes.index("X")]

    def frame(self, number: int) -> np.ndarray[Any, Any]:
        """Read one frame.

        Parameters
        ----------
        number : int
            From 0.

        Returns
        -------
        ndarray of shape (C, H, W)

        Raises
        ------
        ReadError
            This frame of the file is damaged.
        """
        height, width = self.image_shape
        pixels = height * width * (len(self.channels) if "C" in self.axes else 1)
        check_memory(self.path, f"frame {number}", pixels * self.dtype.itemsize)
        with reading(self.path, f"frame {number}"):
            return self.stored.read(number)


def as_channels_first(array: np.ndarray[Any, Any], axes: str) -> np.ndarray[Any, Any]:
    """A frame, or a piece of one, with axes (C, Y, X).

    Parameters
    ----------
    array : ndarray
    axes : str
        One letter each, Y, X and perhaps C, in any order; a T among them is left out.
    """
    rest = axes.replace("T", "")
    moved = array.transpose([rest.index(axis) for axis in "CYX" if axis in rest])
    return moved if "C" in rest else moved[None]
