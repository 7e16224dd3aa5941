"""Frames of a file that are changed when they are read: pieces numbered, values made whole, or inverted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Literal, TypeAlias

import numpy as np
from scipy import ndimage

from cytodisk.images.frame_file import Cut, FrameFile, StoredFrames

Change: TypeAlias = Literal["numbered", "whole", "inverted", "class 1", "class 2"]

_DTYPES: dict[str, type] = {
    "numbered": np.int32,
    "whole": np.int64,
    "inverted": bool,
    "class 1": bool,
    "class 2": bool,
}
_EIGHT = np.ones((3, 3), dtype=bool)


def changed_file(file: FrameFile, change: Change) -> FrameFile:
    """The same file with other values.

    Parameters
    ----------
    file : FrameFile
    change : {"numbered", "whole", "inverted", "class 1", "class 2"}
        Pieces (8-connected) of what is not 0 get the numbers 1, 2, …; whole numbers that are stored as floats
        become integers; True and False change places; or the mask is where the value is 1, or 2.
    """
    return replace(file, dtype=np.dtype(_DTYPES[change]), stored=ChangedFrames(file.stored, change))


@dataclass(frozen=True)
class ChangedFrames:
    """Frames whose values change when they are read.

    Attributes
    ----------
    stored : StoredFrames
    change : {"numbered", "whole", "inverted", "class 1", "class 2"}
    """

    stored: StoredFrames
    change: Change

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        return _CHANGES[self.change](self.stored.read(number))

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None for numbers, which go by the whole frame."""
        found = None if self.change == "numbered" else self.stored.by_piece(number)
        return None if found is None else (partial(_cut, found[0], self.change), found[1])


def _cut(cut: Cut, change: Change, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
    return _CHANGES[change](cut(rows, columns))


def _numbered(frame: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    return np.stack([ndimage.label(plane != 0, structure=_EIGHT)[0] for plane in frame]).astype(np.int32)


_CHANGES: dict[str, Callable[[np.ndarray[Any, Any]], np.ndarray[Any, Any]]] = {
    "numbered": _numbered,
    "whole": lambda frame: frame.astype(np.int64),
    "inverted": np.logical_not,
    "class 1": lambda frame: frame == 1,
    "class 2": lambda frame: frame == 2,
}
