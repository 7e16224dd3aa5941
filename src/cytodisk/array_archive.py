"""Arrays out of an `.npz` file, each of the kind and shape that is asked for, or an error that names it."""

from __future__ import annotations

import math
import os
import re
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import ReadError
from cytodisk.memory import free_bytes
from cytodisk.reading_files import reading_file

_MAGIC = b"\x93NUMPY\x01\x00"
_HEADER = re.compile(
    rb"\{'descr': '([<>|=]?[biufU][0-9]{1,9})', 'fortran_order': (False|True), "
    rb"'shape': \(([0-9, ]{0,99})\), \} *\n"
)
_MOST_SHRUNK = 1100  # times; deflate makes nothing smaller than that
_KINDS = {"f": "numbers", "iu": "whole numbers", "b": "True and False", "U": "text"}
_SHARE_OF_FREE = 0.5


class ArrayArchive:
    """An `.npz` file that is open for reading.

    Parameters
    ----------
    path : path-like
    archive : zipfile.ZipFile
    remedy : str
        What to do where the file is damaged.
    """

    def __init__(self, path: str | os.PathLike[str], archive: zipfile.ZipFile, remedy: str):
        self._path = path
        self._archive = archive
        self._remedy = remedy
        self._entries = archive.NameToInfo

    @property
    def names(self) -> tuple[str, ...]:
        """Names of its arrays."""
        return tuple(name.removesuffix(".npy") for name in self._entries)

    def floats(self, name: str, shape: Sequence[int | None], *, low: float, high: float) -> FloatArray:
        """An array of finite numbers within bounds.

        Parameters
        ----------
        name : str
        shape : sequence of int or None
            None for any length.
        low, high : float
            Both counted.

        Returns
        -------
        ndarray of that shape and dtype float

        Raises
        ------
        ReadError
            It is missing, or has another kind, shape or other values.
        """
        array = self._array(name, "f", shape)
        self._check_range(name, array, low, high)
        return np.asarray(array, dtype=np.float64)

    def numbers(self, name: str, shape: Sequence[int | None]) -> FloatArray:
        """An array of numbers, which may be NaN; otherwise as `floats`."""
        return np.asarray(self._array(name, "f", shape), dtype=np.float64)

    def integers(self, name: str, shape: Sequence[int | None], *, least: int, most: int) -> IntArray:
        """An array of whole numbers within bounds, dtype int64; otherwise as `floats`."""
        array = self._array(name, "iu", shape)
        self._check_range(name, array, least, most)
        return np.asarray(array, dtype=np.int64)

    def truths(self, name: str, shape: Sequence[int | None], *, most: Sequence[int]) -> BoolArray:
        """An array of True and False, along each axis at most so long; otherwise as `floats`."""
        array = self._array(name, "b", shape, most)
        self._check_range(name, array.view(np.uint8), 0, 1)  # other bytes are neither True nor False
        return array

    def texts(self, name: str, shape: Sequence[int | None] = ()) -> list[str]:
        """Texts of an array; of one text alone, a list of it. Otherwise as `floats`."""
        array = self._array(name, "U", shape)
        codes = np.ascontiguousarray(array).reshape(-1).view(np.uint32)
        if codes.size and int(codes.max()) > 0x10FFFF:
            raise self.fault(name, "holds what is no letter")
        return [str(text) for text in array.reshape(-1)]

    def fault(self, name: str, words: str) -> ReadError:
        """What to raise where an array is not as it must be."""
        return ReadError(f"{self._path}: {name} {words}: {self._remedy}")

    def _array(
        self, name: str, kinds: str, shape: Sequence[int | None], most: Sequence[int] = ()
    ) -> np.ndarray[Any, Any]:
        entry = self._entries.get(f"{name}.npy")
        if entry is None:
            raise self.fault(name, "is missing")
        with self._archive.open(entry) as file:
            head = file.read(10)
            found = _HEADER.fullmatch(file.read(int.from_bytes(head[8:], "little")))
            if not head.startswith(_MAGIC) or found is None:
                raise self.fault(name, "is no array of numbers or text")
            dtype, given = np.dtype(found[1].decode()), tuple(map(int, found[3].replace(b",", b" ").split()))
            self._check_kind(name, dtype, kinds)
            self._check_shape(name, given, shape, most)
            n_bytes = math.prod(given) * dtype.itemsize
            if n_bytes != entry.file_size - len(head) - len(found[0]):
                raise self.fault(name, f"has shape {given}, and another number of bytes")
            self._check_claim(name, n_bytes, entry.compress_size)
            content = bytearray(file.read())  # not read-only, for which kernels would be compiled anew
        if len(content) != n_bytes:
            raise self.fault(name, "is cut short")
        array = np.frombuffer(content, dtype).reshape(given, order="F" if found[2] == b"True" else "C")
        return array if dtype.isnative else array.astype(dtype.newbyteorder("="))

    def _check_kind(self, name: str, dtype: np.dtype[Any], kinds: str) -> None:
        if dtype.kind not in kinds:
            raise self.fault(name, f"has dtype {dtype}, not {_KINDS[kinds]}")

    def _check_shape(
        self, name: str, given: Sequence[int], shape: Sequence[int | None], most: Sequence[int]
    ) -> None:
        pairs = zip(given, shape, strict=False)
        if len(given) != len(shape) or any(b not in (None, a) for a, b in pairs):
            words = " × ".join("any number" if one is None else str(one) for one in shape) or "one value"
            raise self.fault(name, f"has shape {tuple(given)}, not {words}")
        if any(a > b for a, b in zip(given, most, strict=False)):
            raise self.fault(name, f"has shape {tuple(given)}, where at most {tuple(most)} can be")

    def _check_claim(self, name: str, n_bytes: int, stored: int) -> None:
        if n_bytes > _MOST_SHRUNK * (stored + 1):
            raise self.fault(name, f"claims {n_bytes} bytes out of {stored}, which no file can hold")
        if n_bytes > 10**8 and n_bytes > _SHARE_OF_FREE * free_bytes():
            raise self.fault(name, f"asks for {n_bytes / 1e9:.1f} GB, more than half of the free memory")

    def _check_range(self, name: str, array: np.ndarray[Any, Any], low: float, high: float) -> None:
        if array.size and not (array.min() >= low and array.max() <= high):
            wrong = array[~((array >= low) & (array <= high))].reshape(-1)[0]
            raise self.fault(name, f"has {wrong!s}, where {low:g} to {high:g} can be")


@contextmanager
def reading_arrays(path: str | os.PathLike[str], what: str, remedy: str) -> Iterator[ArrayArchive]:
    """Open an `.npz` file; what is wrong with it becomes a `ReadError`.

    Parameters
    ----------
    path : path-like
    what, remedy : str
        See `cytodisk.reading_files.reading_file`.
    """
    with reading_file(path, what, remedy):
        if not Path(path).is_file() and Path(path).exists():
            raise ReadError(f"{path} is no file: {remedy}")  # a pipe would keep whoever opens it waiting
        with Path(path).open("rb") as stream, zipfile.ZipFile(stream) as archive:
            yield ArrayArchive(path, archive, remedy)
