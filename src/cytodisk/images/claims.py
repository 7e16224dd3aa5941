"""What a file claims to hold, against its own size and free memory, before anything is allocated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.memory import free_bytes

_TIMES = {
    "none": 1.0,
    "packbits": 64.0,  # 128 bytes of two
    "zlib": 1032.0,  # 258 bytes of two bits
    "lzw": 4096.0,  # strings up to the length of the table, of 9 bits at least
}
_ANY = 1e6  # zstd, JPEG 2000 and their kind: nothing but the absurd is refused
_SMALL = 2**26  # bytes that are always there
_UNITS = ("bytes", "kB", "MB", "GB", "TB", "PB", "EB")


def check_claim(
    path: Path,
    shape: Sequence[int],
    dtype: np.dtype[Any],
    stored_bytes: int | None = None,
    codec: str = "none",
) -> None:
    """Raise if a file cannot hold the array that it says it holds.

    Parameters
    ----------
    path : Path
    shape : sequence of int
        What the file claims.
    dtype : numpy.dtype
    stored_bytes : int, optional
        How many of its bytes hold the array; by default all of them.
    codec : str
        How they are compressed: "none", "packbits", "zlib", "lzw"; any other word allows for more.

    Raises
    ------
    ReadError
        Not even perfect compression makes so much of so few bytes; or a size is below 1.
    """
    if min(shape, default=1) < 1:
        raise ReadError(f"{path} says it has shape {tuple(shape)}: it is damaged, copy it again")
    there = path.stat().st_size if stored_bytes is None else stored_bytes
    claimed = math.prod(shape) * dtype.itemsize
    if claimed > max(there, 1) * _TIMES.get(codec, _ANY):
        raise ReadError(
            f"{path} says it holds {' × '.join(map(str, shape))} pixels ({_size(claimed)}), but only "
            f"{_size(there)} are stored: it is cut short or damaged; copy it again, whole"
        )


def check_memory(path: Path, part: str, needed: int, remedy: str = "crop it, or save it in tiles") -> None:
    """Raise if a part of a file needs more memory than is free.

    Parameters
    ----------
    path : Path
    part : str
        As "frame 3".
    needed : int
        Bytes that reading it takes.
    remedy : str
        What to do, for the message.

    Raises
    ------
    ReadError
        More is needed than is free.
    """
    if needed <= _SMALL:
        return
    free = free_bytes()
    if needed > free:
        raise ReadError(
            f"{path}: {part} takes {_size(needed)} of memory, and {_size(free)} are free: {remedy}"
        )


def _size(count: float) -> str:
    """Bytes in words, as "3.6 GB"."""
    for unit in _UNITS[:-1]:
        if count < 1000:
            return f"{count:.3g} {unit}"
        count /= 1000
    return f"{count:.3g} {_UNITS[-1]}"
