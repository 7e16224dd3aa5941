"""Outlines of cells, as files of several formats hold them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.scale import UNKNOWN, Scale

_NAMES_SHOWN = 3


@dataclass(frozen=True, eq=False)
class Outline:
    """The outline of one cell in one frame.

    Attributes
    ----------
    rings : tuple of ndarray of shape (N, 2) and dtype float
        Closed polygons, (row, column) in pixels, pixel centres at integers; a ring within a ring is a hole.
    name : str
    frame, slice : int or None
        From 0; None where the file says none.
    track : int or None
        Label of the cell in all frames, where the file knows it.
    """

    rings: tuple[FloatArray, ...]
    name: str
    frame: int | None = None
    slice: int | None = None
    track: int | None = None

    @cached_property
    def box(self) -> FloatArray:
        """((least row, column), (greatest row, column)), shape (2, 2)."""
        points = np.concatenate(self.rings)
        return np.stack([points.min(axis=0), points.max(axis=0)])


@dataclass(frozen=True, eq=False)
class OutlineSet:
    """All outlines of a file.

    Attributes
    ----------
    outlines : tuple of Outline
        In the order of the file.
    remarks : tuple of str
        What of the file was left out, in words.
    image_shape : (int, int), or None
        (H, W) of their image, where the file says it.
    n_frames : int or None
        Frames of their image, where the file says it.
    scale : Scale
    """

    outlines: tuple[Outline, ...]
    remarks: tuple[str, ...] = ()
    image_shape: tuple[int, int] | None = None
    n_frames: int | None = None
    scale: Scale = UNKNOWN


@dataclass(frozen=True, eq=False)
class FrameOutlines:
    """The outlines of one frame; of those that overlap, the one that stands first has the pixels.

    Attributes
    ----------
    labels : tuple of int
    outlines : tuple of Outline
    """

    labels: tuple[int, ...]
    outlines: tuple[Outline, ...]

    @cached_property
    def boxes(self) -> FloatArray:
        """Those of the outlines, shape (N, 2, 2)."""
        return np.stack([one.box for one in self.outlines])


@dataclass(frozen=True, eq=False)
class PlacedOutlines:
    """Outlines in the frames of an image, each with its label.

    Attributes
    ----------
    frames : dict of int to FrameOutlines
        By frame; those without an outline are left out.
    n_frames : int
        1 for a single image.
    image_shape : (int, int)
    remarks : tuple of str
        What was left out, or decided, in words.
    evidence : str
        How frames and size are known.
    """

    frames: dict[int, FrameOutlines]
    n_frames: int
    image_shape: tuple[int, int]
    remarks: tuple[str, ...]
    evidence: str

    @cached_property
    def dtype(self) -> np.dtype[Any]:
        """The smallest that holds all labels."""
        greatest = max((max(frame.labels) for frame in self.frames.values()), default=0)
        return np.dtype(np.uint16 if greatest < 2**16 else np.uint32 if greatest < 2**32 else np.int64)


def names_of(outlines: Sequence[Outline]) -> str:
    """The first names of some outlines, in words."""
    shown = ", ".join(one.name for one in outlines[:_NAMES_SHOWN])
    return f"{shown}, …" if len(outlines) > _NAMES_SHOWN else shown
