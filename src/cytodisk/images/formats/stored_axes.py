"""Axes of a stored array that may be a z-stack, and which of its slices are read."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.images.file_axes import FileAxes, file_axes, long_axes
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.scenes import chosen_slice


@dataclass(frozen=True)
class StoredAxes:
    """Axes of a stored array that may have slices, and which of them are read.

    Attributes
    ----------
    known : FileAxes
        Those of its frames, without Z.
    axes : str
        Those of the array: T, C, Z, Y, X; without those of length 1 beside Y and X.
    shape : tuple of int
        Along `axes`.
    z : int, "max" or "mean"
        The slice that is read, or what is made of all.
    """

    known: FileAxes
    axes: str
    shape: tuple[int, ...]
    z: int | str = 0

    @property
    def depth(self) -> int:
        """How many slices there are."""
        return self.shape[self.axes.index("Z")] if "Z" in self.axes else 1

    @property
    def offers(self) -> tuple[str, ...]:
        """What there is to choose, as of a `FrameFile`."""
        return ("z",) if self.depth > 1 else ()

    @property
    def slices(self) -> tuple[int, ...]:
        """Numbers of the slices that are read."""
        return tuple(range(self.depth)) if isinstance(self.z, str) else (self.z,)

    def pixel_type(self, dtype: np.dtype[Any]) -> np.dtype[Any]:
        """Type of the pixels of a frame; a mean has fractions."""
        return np.dtype(np.float32) if self.z == "mean" else dtype


def stored_axes(file: Path, said: str, shape: Sequence[int], unnamed: str, choice: FileChoice) -> StoredAxes:
    """Axes of a stored array in the letters T, C, Z, Y, X, and which of its slices are read.

    Parameters
    ----------
    file : Path
        For messages.
    said, shape, unnamed
        As of `cytodisk.images.file_axes.file_axes`.
    choice : FileChoice
        Its axes and slice.

    Raises
    ------
    ReadError
        The axes are not those of a movie or an image, or there is no such slice.
    """
    pairs = long_axes(file, said, shape, choice.axes)
    letters = "".join(axis for axis, _ in pairs)
    if choice.z is None or "Z" not in letters:
        known = file_axes(file, said, shape, unnamed, choice.axes)
        return StoredAxes(known, known.letters, known.shape)
    place = letters.index("Z")
    _, depth = pairs.pop(place)
    rest, sizes_left = letters.replace("Z", ""), [size for _, size in pairs]
    known = file_axes(file, rest, sizes_left, unnamed, None if choice.axes is None else rest)
    axes, sizes = known.letters, known.shape
    return StoredAxes(
        known,
        axes[:place] + "Z" + axes[place:],
        (*sizes[:place], depth, *sizes[place:]),
        chosen_slice(file, depth, choice.z),
    )
