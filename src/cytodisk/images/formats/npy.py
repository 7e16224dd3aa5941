"""Read `.npy` files, Cellpose's `_seg.npy` among them, without ever running code that stands in them."""

from __future__ import annotations

import io
import pickle
import re
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.claims import check_claim

_MASKS = "masks"  # the entry of a `_seg.npy` that holds the label image
_NUMBERS_AND_TEXT = re.compile("[biufcSUO][0-9]*")
_RECONSTRUCT = {(f"numpy.{core}.multiarray", "_reconstruct") for core in ("core", "_core")}
_SCALAR = {(f"numpy.{core}.multiarray", "scalar") for core in ("core", "_core")}
_LEFT_OUT = {("builtins", name) for name in ("set", "frozenset", "complex", "bytearray", "slice", "range")}


def read_npy(path: Path) -> np.ndarray[Any, Any]:
    """The array of a `.npy` file, or the label image of Cellpose's `_seg.npy`.

    Such a file is a pickle, which can hold commands. Here nothing but arrays of numbers and text, numbers,
    text, and plain containers of those are made from it; anything else is an error.

    Parameters
    ----------
    path : Path

    Returns
    -------
    ndarray
        A plain array is not read before it is used.

    Raises
    ------
    ReadError
        A pickle asks for anything else, or holds no label image.
    """
    with path.open("rb") as file:
        version = np.lib.format.read_magic(file)
        reader = np.lib.format.read_array_header_1_0 if version == (1, 0) else _header_2
        shape, _, dtype = reader(file)
        if not dtype.hasobject:
            if shape and 0 not in shape:
                check_claim(path, shape, dtype, path.stat().st_size - file.tell())
            return np.asanyarray(np.load(path, mmap_mode="r", allow_pickle=False))
        content = _Unpickler(file, path).load()
    found = content.values[0] if isinstance(content, _Array) and len(content.values) == 1 else None
    masks = found.get(_MASKS) if isinstance(found, dict) else None
    if not isinstance(masks, _Array) or masks.array is None:
        raise ReadError(
            f"{path} holds no label image: a `_seg.npy` of Cellpose has an array named {_MASKS!r}; "
            "or save the label image alone, with numpy.save or as TIFF"
        )
    return masks.array


def _header_2(file: Any) -> tuple[Any, Any, Any]:
    return np.lib.format.read_array_header_2_0(file)


class _Unpickler(pickle._Unpickler):
    """Makes stand-ins for NumPy's objects, so that what a pickle says never reaches NumPy unchecked.

    The unpickler is the one written in Python: the other allocates as much as the numbers in a file say.
    """

    def __init__(self, file: io.BufferedReader, path: Path):
        super().__init__(file)
        self._path = path

    def find_class(self, module: str, name: str) -> Any:
        """What a pickle may call; nothing that runs commands or opens files."""
        place = module, name
        if place in _RECONSTRUCT:
            return _Array
        if place in _SCALAR:
            return _number
        if place in _LEFT_OUT:
            return _LeftOut
        if place == ("numpy", "dtype"):
            return _Type
        if place == ("numpy", "ndarray"):
            return _Ndarray
        if place == ("_codecs", "encode"):
            return _latin1
        raise ReadError(
            f"{self._path} asks for {module}.{name} when it is read: a file must not run code, so nothing "
            "but arrays, numbers, text and plain containers is read; save the label image alone, as TIFF"
        )


class _LeftOut:
    """Stands for a plain object that is no part of the masks: `set(range(10**10))` would fill the memory."""

    def __init__(self, *_: Any):
        """Make nothing of what it is called with."""


class _Ndarray:
    """Stands where a pickle names the class of arrays."""


class _Type:
    """Stands for a dtype of numbers, text or objects."""

    def __init__(self, code: str, *_: Any):
        if not isinstance(code, str) or not _NUMBERS_AND_TEXT.fullmatch(code):
            raise ValueError(f"a pickled array has dtype {code!r}: only numbers and text are read")
        self.dtype = np.dtype(code)

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        if state[1] in ("<", ">"):
            self.dtype = self.dtype.newbyteorder(state[1])
        if self.dtype.kind in "SU" and self.dtype.itemsize == 0:
            self.dtype = np.dtype((self.dtype, state[5] // (4 if self.dtype.kind == "U" else 1)))


class _Array:
    """Stands for an array: `array` if it holds numbers or text, `values` if it holds objects."""

    def __init__(self, *_: Any):
        self.array: np.ndarray[Any, Any] | None = None
        self.values: list[Any] = []

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        _, shape, kind, fortran, content = state
        if kind.dtype.hasobject:
            self.values = list(content)
            return
        values = np.frombuffer(_as_bytes(content), kind.dtype)
        self.array = values.reshape(shape, order="F" if fortran else "C")


def _number(kind: _Type, content: bytes = b"") -> Any:
    return None if kind.dtype.hasobject else np.frombuffer(_as_bytes(content), kind.dtype)[0]


def _as_bytes(content: Any) -> bytes:
    if not isinstance(content, bytes | bytearray):  # of a number, `bytes` would make so many zeros
        raise ValueError(f"a pickled array has {type(content).__name__} where its bytes are due")
    return bytes(content)


def _latin1(text: str, encoding: str) -> bytes:
    """How old pickles write bytes."""
    if encoding not in ("latin1", "latin-1"):
        raise ValueError(f"a pickle holds bytes in the encoding {encoding!r}: only latin1 is read")
    return text.encode("latin1")
