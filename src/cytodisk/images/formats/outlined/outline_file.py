"""Files of outlines as label images: each outline is a cell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.geometry.even_odd import pixels_inside
from cytodisk.images.formats.outlined.outline_faults import doubts_about
from cytodisk.images.formats.outlined.outline_places import place_outlines
from cytodisk.images.formats.outlined.outline_set import OutlineSet, PlacedOutlines
from cytodisk.images.frame_file import Cut, FileChoice, FrameFile
from cytodisk.images.reading import reading

_KEPT = 4  # files whose outlines are kept


def open_outlines(path: Path, read: Callable[[Path], OutlineSet], choice: FileChoice) -> FrameFile:
    """Outlines as label images that are drawn when they are read.

    Parameters
    ----------
    path : Path
    read : callable
        Reads the outlines of a file.
    choice : FileChoice
        Its slice, and the size of the image that goes with the file.

    Returns
    -------
    FrameFile

    Raises
    ------
    ReadError
        The file holds no outline that can be used.
    """
    if choice.axes is not None:
        raise ReadError(f"{path} holds outlines, which have no axes: take the axes out (--axes)")
    frames = OutlineFrames(path, read, choice)
    placed, scale = frames.placed()
    axes: str = "YX"
    shape: tuple[int, ...] = placed.image_shape
    if placed.n_frames > 1:
        axes, shape = "TYX", (placed.n_frames, *placed.image_shape)
    notes = (*placed.remarks, *doubts_about(placed))
    if choice.like is None and "box around" in placed.evidence:
        notes = (*notes, f"{placed.evidence.split('; ')[-1]}; pass the image that goes with it (--signal)")
    return FrameFile(
        path, axes, shape, placed.dtype, ("0",), frames, scale, notes=notes, evidence=placed.evidence
    )


@dataclass(frozen=True)
class OutlineFrames:
    """Label images of the outlines of a file.

    Attributes
    ----------
    path : Path
    reader : callable
        Reads the outlines of a file.
    choice : FileChoice
    """

    path: Path
    reader: Callable[[Path], OutlineSet]
    choice: FileChoice

    def placed(self) -> tuple[PlacedOutlines, Any]:
        """The outlines by frame, and their scale; read anew if the file has changed."""
        state = self.path.stat()
        return _placed(self, state.st_mtime_ns, state.st_size)

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Labels of a frame, shape (1, H, W)."""
        height, width = self.placed()[0].image_shape
        return self._cut(number, slice(0, height), slice(0, width))

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to draw a piece of a frame."""
        return partial(self._cut_of_file, number), 1

    def _cut_of_file(self, number: int, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        with reading(self.path, f"frame {number}"):
            return self._cut(number, rows, columns)

    def _cut(self, number: int, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        placed, _ = self.placed()
        drawn = np.zeros((1, rows.stop - rows.start, columns.stop - columns.start), placed.dtype)
        frame = placed.frames.get(number)
        if frame is None:
            return drawn
        first = np.ceil(frame.boxes[:, 0]).clip([rows.start, columns.start])
        after = (np.floor(frame.boxes[:, 1]) + 1).clip(max=[rows.stop, columns.stop])
        reached = np.flatnonzero((first < after).all(axis=1))
        for place in reached[::-1]:  # the one that stands first is on top
            (top, left), (bottom, right) = first[place].astype(int), after[place].astype(int)
            inside = pixels_inside(frame.outlines[place].rings, slice(top, bottom), slice(left, right))
            piece = drawn[
                0, top - rows.start : bottom - rows.start, left - columns.start : right - columns.start
            ]
            piece[inside] = frame.labels[place]
        return drawn


@lru_cache(maxsize=_KEPT)
def _placed(frames: OutlineFrames, changed_ns: int, size: int) -> tuple[PlacedOutlines, Any]:
    with reading(frames.path, "its outlines"):
        found = frames.reader(frames.path)
    return place_outlines(frames.path, found, frames.choice), found.scale
