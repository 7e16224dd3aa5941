"""Compressed TIFF files by strip or tile."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from cytodisk.images.claims import check_memory
from cytodisk.images.formats.tiff_pages import opened_member, opened_tiff, present_page

_KEPT_BYTES = 2**26  # of decoded segments, so that cells side by side do not decode them twice
_COPIES = 3  # of a segment, while it is decoded
_WITH_TABLES = (6, 7, 34892, 33007)  # compressions whose segments need more than themselves: kinds of JPEG


@dataclass(eq=False)
class TiffSegments:
    """A frame in strips or tiles, each decoded when a piece of it is needed.

    Attributes
    ----------
    path : Path
    series : int
        Number of the series.
    plain : bool
        As of `tiff_opened`.
    pages : tuple of int
        Pages of the frame among those of the series, one a channel.
    shape : (int, int, int)
        (C, H, W).
    dtype : numpy.dtype
    height, width : int
        Of a strip or tile.
    """

    path: Path
    series: int
    plain: bool
    pages: tuple[int, ...]
    shape: tuple[int, int, int]
    dtype: np.dtype[Any]
    height: int
    width: int
    _kept: OrderedDict[tuple[int, int], np.ndarray[Any, Any]] = field(default_factory=OrderedDict)
    _kept_bytes: int = 0

    @classmethod
    def of(
        cls, path: Path, series: int, plain: bool, pages: tuple[int, ...], image_shape: tuple[int, int]
    ) -> TiffSegments | None:
        """The segments of a frame; None where its layout is unusual, so that it must be read whole."""
        with opened_tiff(path, plain) as tiff:
            page: Any = tiff.series[series].keyframe
            dtype = np.dtype(tiff.series[series].dtype)
            if page.shape != image_shape or page.compression in _WITH_TABLES:
                return None
            tall, wide = segment_shape(page)
        height, width = image_shape
        shape = len(pages), height, width
        return cls(path, series, plain, pages, shape, dtype, min(tall, height), min(wide, width))

    @property
    def across(self) -> int:
        """Segments side by side; as many are always kept, so that strips of a frame decode none twice."""
        return -(-self.shape[2] // self.width)

    def cut(self, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        """Pixels of some rows and columns of all channels, shape (C, h, w)."""
        out = np.empty((len(self.pages), rows.stop - rows.start, columns.stop - columns.start), self.dtype)
        check_memory(
            self.path,
            "a strip or tile",
            _COPIES * self.height * self.width * self.dtype.itemsize,
            "save it again in tiles",
        )
        with opened_tiff(self.path, self.plain) as tiff:
            for channel, page in enumerate(self.pages):
                for down in range(rows.start // self.height, -(-rows.stop // self.height)):
                    for right in range(columns.start // self.width, -(-columns.stop // self.width)):
                        segment = self._segment(tiff, page, down * self.across + right)
                        corner = down * self.height, right * self.width
                        _copy(segment, corner, out[channel], (rows.start, columns.start))
        return out

    def _segment(self, tiff: tifffile.TiffFile, page: int, index: int) -> np.ndarray[Any, Any]:
        if (page, index) in self._kept:
            self._kept.move_to_end((page, index))
            return self._kept[page, index]
        segment = self._decoded(tiff, page, index)
        self._kept[page, index] = segment
        self._kept_bytes += segment.nbytes
        while self._kept_bytes > _KEPT_BYTES and len(self._kept) > self.across:
            self._kept_bytes -= self._kept.popitem(last=False)[1].nbytes
        return segment

    def _decoded(self, tiff: tifffile.TiffFile, page: int, index: int) -> np.ndarray[Any, Any]:
        found = present_page(self.path, tiff, self.series, page)
        start, size = found.dataoffsets[index], found.databytecounts[index]
        content = None
        if size:
            with opened_member(found) as file:
                file.seek(start)
                content = file.read(size)
            if len(content) < size:
                raise ValueError(f"segment {index} has {len(content)} of {size} bytes")
        decoded, _, shape = found.keyframe.decode(content, index)
        if decoded is None:  # nothing stored
            return np.full(shape[1:3], found.keyframe.nodata, self.dtype)
        return np.asarray(decoded[0, : shape[1], : shape[2], 0])


def segment_shape(page: Any) -> tuple[int, int]:
    """Height and width of the strips or tiles of a page."""
    return (page.tilelength, page.tilewidth) if page.is_tiled else (page.rowsperstrip, page.imagewidth)


def _copy(
    segment: np.ndarray[Any, Any],
    corner: tuple[int, int],
    out: np.ndarray[Any, Any],
    out_corner: tuple[int, int],
) -> None:
    """Copy what a segment and a piece share; their corners are (row, column) in the frame."""
    start = [max(one, other) for one, other in zip(corner, out_corner, strict=True)]
    stop = [
        min(one + size, other + wanted)
        for one, size, other, wanted in zip(corner, segment.shape, out_corner, out.shape, strict=True)
    ]
    here, there = (
        tuple(slice(a - first, b - first) for a, b, first in zip(start, stop, place, strict=True))
        for place in (corner, out_corner)
    )
    out[there] = segment[here]
