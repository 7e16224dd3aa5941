"""Frames of a TIFF: only the pages of a frame are read, whatever the order of the axes."""

from __future__ import annotations

import math
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from cytodisk.images.formats.array_file import ArrayFrames, StoredArray
from cytodisk.images.formats.projection import projected
from cytodisk.images.formats.tiff_pages import opened_member, opened_tiff, present_page
from cytodisk.images.formats.tiff_segments import TiffSegments
from cytodisk.images.frame_file import Cut, as_channels_first
from cytodisk.images.reading import reading


@dataclass(frozen=True)
class TiffFrames:
    """Frames of a TIFF.

    Attributes
    ----------
    path : Path
    series : int
        Number of the series.
    plain : bool
        Whether pages are taken as they stand.
    axes : str
        Of the series: T, C, Z, Y and X, each once; not those of length 1 beside Y and X.
    shape : tuple of int
    slices : tuple of int
        The slices that are read of a z-stack.
    z : int, "max" or "mean"
        What is made of them.
    """

    path: Path
    series: int
    plain: bool
    axes: str
    shape: tuple[int, ...]
    slices: tuple[int, ...] = (0,)
    z: int | str = 0

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        with opened_tiff(self.path, self.plain) as tiff:
            array = self._uncompressed(tiff, self.slices[0])
            if array is None:
                return projected((self._plane(tiff, number, z) for z in self.slices), self.z)
        everything = slice(None), slice(None)
        return projected((replace(array, z=z).cut(number, *everything) for z in self.slices), self.z)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None where the layout is unusual."""
        if len(self.slices) > 1:
            return None
        with opened_tiff(self.path, self.plain) as tiff:
            array = self._uncompressed(tiff, self.slices[0])
            pages, rest = self._pages_of(tiff, number, self.slices[0])
        if array is not None:
            return array.by_piece(number)
        sizes = dict(zip(self.axes, self.shape, strict=True))
        if rest != "YX" or len(pages) != sizes.get("C", 1):
            return None
        image_shape = sizes["Y"], sizes["X"]
        segments = TiffSegments.of(self.path, self.series, self.plain, pages, image_shape)
        if segments is None:
            return None
        return partial(_cut_from_segments, segments, self.path, number), segments.height

    def _pages_of(self, tiff: tifffile.TiffFile, number: int, z: int) -> tuple[tuple[int, ...], str]:
        """Pages with a frame's slice among those of the series, and the axes that lie within a page."""
        count = len(tiff.series[self.series].pages)
        lead = next((k for k in range(len(self.axes)) if math.prod(self.shape[:k]) == count), 0)
        taken = {"T": number, "Z": z}
        if lead == 0:
            return tuple(range(count)), self.axes
        numbers = np.arange(count).reshape(self.shape[:lead])
        found = numbers[tuple(taken.get(axis, slice(None)) for axis in self.axes[:lead])]
        return tuple(found.ravel().tolist()), self.axes[lead:]

    def _plane(self, tiff: tifffile.TiffFile, number: int, z: int) -> np.ndarray[Any, Any]:
        """Pixels (C, H, W) of a frame's slice."""
        pages, within = self._pages_of(tiff, number, z)
        lead = self.axes[: len(self.axes) - len(within)]
        taken = {"T": number, "Z": z}
        axes = _without(lead, taken) + within
        sizes = dict(zip(self.axes, self.shape, strict=True))
        with ExitStack() as members:
            for page in pages:
                members.enter_context(opened_member(present_page(self.path, tiff, self.series, page)))
            array = tiff.asarray(series=tiff.series[self.series], key=list(pages))
        array = np.asarray(array).reshape([sizes[axis] for axis in axes])
        array = array[tuple(taken.get(axis, slice(None)) for axis in axes)]
        return as_channels_first(array, _without(axes, taken))

    def _uncompressed(self, tiff: tifffile.TiffFile, z: int) -> ArrayFrames | None:
        series = tiff.series[self.series]
        if series.is_multifile or series.dataoffset is None:
            return None
        dtype = np.dtype(tiff.byteorder + np.dtype(series.dtype).char)
        stored = StoredArray(self.path, dtype, int(series.dataoffset), "C")
        return ArrayFrames(stored, self.axes, self.shape, z)


def _without(axes: str, taken: Mapping[str, int]) -> str:
    return "".join(axis for axis in axes if axis not in taken)


def _cut_from_segments(
    segments: TiffSegments, path: Path, number: int, rows: slice, columns: slice
) -> np.ndarray[Any, Any]:
    with reading(path, f"frame {number}"):
        return segments.cut(rows, columns)
