"""TIFF files of all kinds: plain, OME, ImageJ."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from cytodisk.errors import ReadError
from cytodisk.images.file_axes import file_axes
from cytodisk.images.formats.array_file import ArrayFrames, StoredArray
from cytodisk.images.formats.file_metadata import channel_names, imagej_scale, ome_metadata
from cytodisk.images.formats.tiff_pages import opened_tiff, whole_tiff
from cytodisk.images.formats.tiff_segments import TiffSegments
from cytodisk.images.frame_file import Cut, FileChoice, FrameFile, as_channels_first
from cytodisk.images.reading import reading
from cytodisk.scale import UNKNOWN


def open_tiff(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a TIFF without reading its pixels; see `cytodisk.images.frames.open_frames`."""
    with whole_tiff(file) as tiff:
        if len(tiff.series) > 1:
            raise ReadError(
                f"{file} holds {len(tiff.series)} separate images: save one alone, or all as one stack"
            )
        series = tiff.series[0]
        colour = series.keyframe.photometric == tifffile.PHOTOMETRIC.RGB
        said = series.axes.replace("S", "C") if colour else series.axes
        known = file_axes(file, said, series.shape, unnamed, choice.axes)
        axes, shape = known.letters, known.shape
        names: tuple[str, ...] = ()
        scale = UNKNOWN
        if tiff.is_ome and tiff.ome_metadata:
            scale, names = ome_metadata(file, tiff.ome_metadata)
        elif tiff.is_imagej and tiff.imagej_metadata:
            scale = imagej_scale(file, tiff)
    channels = channel_names(names, shape[axes.index("C")] if "C" in axes else 1)
    dtype = np.dtype(series.dtype)
    stored = TiffFrames(file, axes, shape, dtype)
    return FrameFile(
        file,
        axes,
        shape,
        dtype,
        channels,
        stored,
        scale,
        evidence=known.evidence,
        said_by=known.said_by,
        doubt=known.doubt,
    )


@dataclass(frozen=True)
class TiffFrames:
    """Frames of a TIFF.

    Attributes
    ----------
    path : Path
    axes : str
    shape : tuple of int
    dtype : numpy.dtype
        As those of its `FrameFile`.
    """

    path: Path
    axes: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        without = tuple(size for axis, size in zip(self.axes, self.shape, strict=True) if axis != "T")
        frames = math.prod(self.shape) // math.prod(without)
        with opened_tiff(self.path) as tiff:
            pages = len(tiff.series[0].pages) // frames
            if self.axes[0] == "T" and pages > 0 and pages * frames == len(tiff.series[0].pages):
                keys = list(range(number * pages, (number + 1) * pages))
                array = np.asarray(tiff.asarray(series=0, key=keys)).reshape(without)
                return as_channels_first(array, self.axes)
            whole = np.asarray(tiff.series[0].asarray()).reshape(self.shape)
        frame = whole.take(number, axis=self.axes.index("T")) if "T" in self.axes else whole
        return as_channels_first(frame, self.axes)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None where the layout is unusual."""
        if (array := self._uncompressed()) is not None:
            return ArrayFrames(array, self.axes, self.shape).by_piece(number)
        segments = TiffSegments.of(self.path, self.axes, self.shape, number)
        if segments is None:
            return None
        return partial(_cut_from_segments, segments, self.path, number), segments.height

    def _uncompressed(self) -> StoredArray | None:
        with opened_tiff(self.path) as tiff:
            series = tiff.series[0]
            if series.is_multifile or series.dataoffset is None:
                return None
            dtype = np.dtype(tiff.byteorder + np.dtype(series.dtype).char)
            return StoredArray(self.path, dtype, int(series.dataoffset), "C")


def _cut_from_segments(
    segments: TiffSegments, path: Path, number: int, rows: slice, columns: slice
) -> np.ndarray[Any, Any]:
    with reading(path, f"frame {number}"):
        return segments.cut(rows, columns)
