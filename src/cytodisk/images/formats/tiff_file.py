"""TIFF files of all kinds: plain, OME, ImageJ."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import tifffile

from cytodisk.errors import ReadError
from cytodisk.images.changed_frames import changed_file
from cytodisk.images.chosen_channels import channel_names
from cytodisk.images.claims import check_claim
from cytodisk.images.formats.picture_file import PALETTE
from cytodisk.images.formats.stored_axes import stored_axes
from cytodisk.images.formats.tiff_frames import TiffFrames
from cytodisk.images.formats.tiff_pages import opened_tiff, whole_tiff
from cytodisk.images.formats.tiff_scale import tiff_says
from cytodisk.images.formats.tiff_segments import segment_shape
from cytodisk.images.formats.tiff_series import TiffSeries, chosen_series
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.short_lists import shortened

_LARGEST_SEGMENT = 2**31  # bytes of a strip or tile, decoded: more than 40 000 × 40 000 labels of one byte
_CODECS = {1: "none", 5: "lzw", 8: "zlib", 32946: "zlib", 32773: "packbits"}
_LOSSY = (6, 7, 33007, 34892)  # kinds of JPEG
_LOSS = (
    "its pixels are stored with loss (JPEG): edges and values are not those of the microscope; save it anew "
    "from the raw file, without JPEG",
)


def open_tiff(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a TIFF without reading its pixels; see `cytodisk.images.frames.open_frames`."""
    with whole_tiff(file) as (tiff, logged):
        found = chosen_series(file, tiff, logged, choice.scene)
        says = tiff_says(file, tiff, found.image)
    with opened_tiff(file, found.plain) as tiff:
        series = tiff.series[found.number]
        _check_claims(file, tiff, series)
        colour = series.keyframe.photometric == tifffile.PHOTOMETRIC.RGB
        said = found.axes.replace("S", "C") if colour else found.axes
        stored = stored_axes(file, said, found.shape, unnamed, choice)
        known, axes, shape = stored.known, stored.axes, stored.shape
        frames, gaps = _frames_there(found, series, axes, shape)
        dtype = np.dtype(series.dtype)
        remarks: tuple[str, ...] = _LOSS if series.keyframe.compression in _LOSSY else ()
        remarks += (PALETTE,) if series.keyframe.photometric == tifffile.PHOTOMETRIC.PALETTE else ()
        black = _is_black_on_white(series.keyframe)
    sizes = [frames if axis == "T" else size for axis, size in zip(known.letters, known.shape, strict=True)]
    opened = FrameFile(
        file,
        known.letters,
        tuple(sizes),
        stored.pixel_type(dtype),
        channel_names(says.channels, sizes[known.letters.index("C")] if "C" in known.letters else 1),
        TiffFrames(file, found.number, found.plain, axes, shape, stored.slices, stored.z),
        says.scale,
        tuple(dict.fromkeys([*found.notes, *says.notes, *gaps, *remarks])),
        "; ".join(filter(None, [known.evidence, found.evidence])),
        known.said_by,
        known.doubt,
        (("scene",) if found.of > 1 else ()) + stored.offers,
    )
    return changed_file(opened, "inverted") if black else opened  # of one bit, 0 is white there


def _is_black_on_white(page: Any) -> bool:
    """Whether 1 means black on pages of one bit; tifffile says so of all that it writes, and means True."""
    meant = page.photometric == tifffile.PHOTOMETRIC.MINISWHITE and page.bitspersample == 1
    return bool(meant and page.software != "tifffile.py")


def _frames_there(
    found: TiffSeries, series: Any, axes: str, shape: Sequence[int]
) -> tuple[int, tuple[str, ...]]:
    """How many frames there are up to the last that is in a file, and notes on what is missing."""
    frames = shape[axes.index("T")] if "T" in axes else 1
    absent = np.array([page is None for page in series._pages], dtype=bool)
    notes: list[str] = []
    if found.image is not None and found.image.missing:
        names = shortened(found.image.missing, 5)
        notes.append(
            f"files of its set are missing ({names}): frames in them cannot be read; put them beside it"
        )
    if not absent.any():
        return frames, tuple(notes)
    lead = next((k for k in range(len(axes)) if math.prod(shape[:k]) == len(absent)), 0)
    if "T" not in axes[:lead]:
        return frames, tuple(notes)
    by_frame = np.moveaxis(absent.reshape(shape[:lead]), axes.index("T"), 0).reshape(frames, -1)
    there = int(np.flatnonzero(~by_frame.all(axis=1)).max()) + 1
    if by_frame[:there].any() and not notes:
        lost = ", ".join(map(str, np.flatnonzero(by_frame[:there].any(axis=1))[:10]))
        notes.append(f"pages are missing, so that these frames cannot be read: {lost}; copy the file again")
    if there < frames and not (found.image is not None and found.image.missing):
        notes.append(
            f"its metadata claim {frames} frames, {there} are in the file: the movie was stopped, or the "
            f"file cut; the first {there} are read; copy the file again if there should be more"
        )
        frames = there
    return frames, tuple(notes)


def _check_claims(file: Path, tiff: tifffile.TiffFile, series: Any) -> None:
    """Compare what a series claims with the bytes that are stored, before anything is allocated."""
    page, dtype = series.keyframe, np.dtype(series.dtype)
    if min(page.shape, default=0) < 1 or len(series.shape) < 2:
        raise ReadError(f"{file} has pages of shape {page.shape}: it is damaged; copy it again")
    if series.dataoffset is not None and not series.is_multifile:
        check_claim(file, series.shape, dtype, tiff.filehandle.size - int(series.dataoffset))
        return
    codec = _CODECS.get(int(page.compression), "")
    height, width = segment_shape(page)
    needed = math.ceil(page.imagelength / max(height, 1)) * math.ceil(page.imagewidth / max(width, 1))
    counts = page.databytecounts
    if len(counts) < needed:
        raise ReadError(
            f"{file} claims {needed} strips or tiles a page and lists {len(counts)}: it is damaged; copy it "
            "again"
        )
    if all(counts):  # strips that are left out hold nothing
        bits = math.prod(page.shape) * max(1, int(page.bitspersample)) / 8
        check_claim(file, (max(1, int(bits)),), np.dtype(np.uint8), sum(counts), codec)
    pixels = min(height, page.imagelength) * min(width, page.imagewidth)
    if pixels * dtype.itemsize > _LARGEST_SEGMENT:
        raise ReadError(
            f"{file} is compressed in one piece of {page.imagelength} × {page.imagewidth} pixels, which can "
            "only be read whole: save it again in tiles (tifffile: tile=(512, 512)), or uncompressed"
        )
