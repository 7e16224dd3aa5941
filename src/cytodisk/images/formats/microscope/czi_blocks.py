"""Blocks of pixels of a CZI file, as its list of blocks describes them."""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.claims import check_claim

_JPEG, _LZW, _JPEG_XR, _ZSTD, _ZSTD_SHUFFLED = 1, 2, 4, 5, 6
_CODECS = {0: "none", _LZW: "lzw"}
_HEADER = struct.Struct("<16sqqiiq")  # kind, two sizes of the segment; sizes of metadata, attachment, pixels
_ENTRY_BYTES, _AXIS_BYTES, _LEAST_BYTES = 32, 20, 256


@dataclass(frozen=True)
class Block:
    """A block of pixels: a plane, or a tile of one.

    Attributes
    ----------
    axes : mapping of str to (int, int, int)
        Start, size and stored size along each axis.
    dtype : numpy.dtype
    samples : int
        1, or 3 or 4 for a colour image.
    compression : int
        As numbered in the file.
    position : int
        Of its segment, in bytes from the start of the file.
    """

    axes: Mapping[str, tuple[int, int, int]]
    dtype: np.dtype[Any]
    samples: int
    compression: int
    position: int

    @classmethod
    def of(cls, entry: Any) -> Self:
        """From an entry of the list of blocks, as czifile gives it.

        Parameters
        ----------
        entry : czifile.DirectoryEntryDV or czifile.CziDirectoryEntryDV
            The first until 2019, for Python 3.11, the second from 2026 on.
        """
        if hasattr(entry, "dimension_entries"):
            axes = {e.dimension: (e.start, e.size, e.stored_size) for e in entry.dimension_entries}
            base, samples = np.dtype(entry.dtype).base, math.prod(np.dtype(entry.dtype).shape)
        else:
            sizes = zip(entry.start, entry.shape, entry.stored_shape, strict=True)
            axes = {axis: place for axis, place in zip(entry.dims, sizes, strict=True) if axis != "S"}
            for axis, index in (("S", entry.scene_index), ("M", entry.mosaic_index)):
                if index >= 0:
                    axes[axis] = (index, 1, 1)
            base, samples = np.dtype(entry.pixel_type.dtype), int(entry.pixel_type.samples)
        return cls(axes, base, samples, int(entry.compression), int(entry.file_position))

    def start(self, axis: str) -> int:
        """Where it starts along an axis; 0 along one that it does not have."""
        return self.axes.get(axis, (0, 1, 1))[0]

    def size(self, axis: str) -> int:
        """Its size along an axis; 1 along one that it does not have."""
        return self.axes.get(axis, (0, 1, 1))[1]

    @property
    def is_whole(self) -> bool:
        """Whether it is stored pixel by pixel, not as a smaller picture for looking at it from afar."""
        return all(size == stored for _, size, stored in self.axes.values())


def block_pixels(block: Block, opened: BinaryIO) -> np.ndarray[Any, Any]:
    """Pixels (H, W, samples) of a block; colours as red, green, blue.

    Parameters
    ----------
    block : Block
    opened : binary file
        The CZI file.

    Raises
    ------
    ReadError
        The file holds no such block, or it is compressed in an unknown way.
    """
    import imagecodecs

    shape = block.size("Y"), block.size("X"), block.samples
    data = _stored(block, opened)
    check_claim(Path(opened.name), shape, block.dtype, len(data), _CODECS.get(block.compression, "other"))
    if block.compression in (_JPEG, _JPEG_XR):
        decode = imagecodecs.jpeg8_decode if block.compression == _JPEG else imagecodecs.jpegxr_decode
        return np.asarray(decode(data)).reshape(shape)
    if block.compression == _LZW:
        data = bytes(imagecodecs.lzw_decode(data))
    elif block.compression in (_ZSTD, _ZSTD_SHUFFLED):
        data = _zstd(data, block.compression, math.prod(shape) * block.dtype.itemsize)
    elif block.compression:
        raise ReadError(
            f"{opened.name} is compressed in a way of its camera (number {block.compression}): save it with "
            "another compression in ZEN"
        )
    pixels = np.frombuffer(data, block.dtype, math.prod(shape)).reshape(shape)
    return pixels if block.samples == 1 else pixels[..., [2, 1, 0, 3][: block.samples]]


def _stored(block: Block, opened: BinaryIO) -> bytes:
    opened.seek(block.position)
    kind, _, _, metadata_bytes, _, pixel_bytes = _HEADER.unpack(opened.read(_HEADER.size))
    if not kind.startswith(b"ZISRAWSUBBLOCK"):
        raise ReadError(f"{opened.name} is damaged: there is no block of pixels at byte {block.position}")
    entry = _HEADER.size - 32 + _ENTRY_BYTES + _AXIS_BYTES * len(block.axes)
    start = block.position + 32 + max(entry, _LEAST_BYTES) + metadata_bytes
    end = opened.seek(0, 2)
    if not 0 <= start <= start + pixel_bytes <= end:
        raise ReadError(f"{opened.name} is cut short: a block of pixels ends after the end of the file")
    opened.seek(start)
    return opened.read(pixel_bytes)


def _zstd(data: bytes, compression: int, size: int) -> bytes:
    """What Zstandard compressed; its second way may hold the low bytes first, then the high bytes."""
    import imagecodecs

    shuffled = False
    if compression == _ZSTD_SHUFFLED:
        header = data[0]
        shuffled = header >= 3 and data[1] == 1 and bool(data[2] & 1)
        data = data[header:]
    plain = bytes(imagecodecs.zstd_decode(data, out=size))
    return np.frombuffer(plain, np.uint8).reshape(2, -1).T.tobytes() if shuffled else plain
