"""Read `.npy` files, Cellpose's `_seg.npy` among them, without ever running code that stands in them."""

from __future__ import annotations

import io
import pickle
import re
from pathlib import Path
from typing import Any, Self

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.claims import check_claim

_MASKS = "masks"  # the entry of a `_seg.npy` that holds the label image
_NUMBERS_AND_TEXT = re.compile("[biufcSUO][0-9]*")
_RECONSTRUCT = {(f"numpy.{core}.multiarray", "_reconstruct") for core in ("core", "_core")}
_SCALAR = {(f"numpy.{core}.multiarray", "scalar") for core in ("core", "_core")}
_FROM_BUFFER = {(f"numpy.{core}.numeric", "_frombuffer") for core in ("core", "_core")}
_DICTS = {("collections", name) for name in ("OrderedDict", "defaultdict", "Counter")}
# What only a file asks for that wants to run something; nothing of it would run, but it is no file to trust.
_COMMANDS = {
    "os",
    "posix",
    "nt",
    "subprocess",
    "sys",
    "shutil",
    "importlib",
    "runpy",
    "socket",
    "ctypes",
    "io",
}
_COMMANDS |= {"_io", "pty", "code", "timeit", "webbrowser", "pip", "multiprocessing", "pickle"}
_RUNS = {"eval", "exec", "execfile", "compile", "open", "__import__", "input", "breakpoint", "apply", "file"}


def read_npy(path: Path) -> np.ndarray[Any, Any]:
    """The array of a `.npy` file, or the label image of Cellpose's `_seg.npy`.

    Such a file is a pickle, which can hold commands. Here nothing but arrays of numbers and text, numbers,
    text, and plain containers of those are made from it. Any other object, such as a path or a date, is left
    out: an empty object stands in its place. A file that asks for commands is refused.

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
        A pickle asks for commands, or holds no label image.
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
            return _Number
        if place in _FROM_BUFFER:
            return _ArrayOfBytes
        if place in _DICTS:
            return _Dict
        if place == ("numpy", "dtype"):
            return _Type
        if place == ("numpy", "ndarray"):
            return _Ndarray
        if place == ("_codecs", "encode"):
            return _Latin1
        built_in = module in ("builtins", "__builtin__")
        if module.partition(".")[0] in _COMMANDS or (built_in and name in _RUNS):
            raise ReadError(
                f"{self._path} asks for {module}.{name} when it is read: a file must not run code, so it is "
                "not read; save the label image alone, as TIFF"
            )
        return _LeftOut


class _LeftOut:
    """Stands for an object that is no part of the masks: `set(range(10**10))` would fill the memory.

    Whatever a pickle does to it, it stays empty.
    """

    def __new__(cls, *_: Any, **__: Any) -> Self:
        """Make nothing of what it is called with."""
        return super().__new__(cls)

    def __setstate__(self, state: Any) -> None:
        """Take nothing in."""

    def __setitem__(self, key: Any, value: Any) -> None:
        """Take nothing in."""

    def append(self, value: Any) -> None:
        """Take nothing in."""

    extend = update = add = append

    def __call__(self, *_: Any, **__: Any) -> _LeftOut:
        """Stand for what a call would have made."""
        return self


class _Dict(dict[Any, Any]):
    """Stands for the kinds of dict that Python comes with."""

    def __init__(self, *given: Any):
        super().__init__(*(value for value in given if type(value) in (dict, list)))

    def __setstate__(self, state: Any) -> None:
        """Take nothing in."""


class _Ndarray(_LeftOut):
    """Stands where a pickle names the class of arrays."""


class _Type:
    """Stands for a dtype; `dtype` is None unless it is one of numbers, text or objects."""

    def __init__(self, code: str, *_: Any):
        known = isinstance(code, str) and _NUMBERS_AND_TEXT.fullmatch(code) is not None
        self.dtype = np.dtype(code) if known else None

    def __setstate__(self, state: tuple[Any, ...]) -> None:
        if self.dtype is None:
            return
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
        if len(state) != 5 or not isinstance(state[2], _Type):
            return  # of a kind of array with more to it
        _, shape, kind, fortran, content = state
        if kind.dtype is None:
            return
        if kind.dtype.hasobject:
            self.values = list(content)
            return
        values = np.frombuffer(_as_bytes(content), kind.dtype)
        self.array = values.reshape(shape, order="F" if fortran else "C")


class _ArrayOfBytes(_LeftOut):
    """Stands for the function that makes an array in pickles of protocol 5."""

    def __new__(cls, content: Any, kind: _Type, shape: tuple[int, ...], order: str) -> Any:
        """The array."""
        made = _Array()
        made.__setstate__((1, shape, kind, order == "F", content))
        return made


class _Number(_LeftOut):
    """Stands for the function that makes a number; as a class, it cannot be changed by a pickle."""

    def __new__(cls, kind: _Type, content: bytes = b"") -> Any:
        """The number, or None where it is none."""
        if kind.dtype is None or kind.dtype.hasobject:
            return None
        return np.frombuffer(_as_bytes(content), kind.dtype)[0]


def _as_bytes(content: Any) -> bytes:
    if not isinstance(content, bytes | bytearray):  # of a number, `bytes` would make so many zeros
        raise ValueError(f"a pickled array has {type(content).__name__} where its bytes are due")
    return bytes(content)


class _Latin1(_LeftOut):
    """Stands for the function that makes bytes in old pickles."""

    def __new__(cls, text: str, encoding: str) -> Any:
        """The bytes of a text."""
        if encoding not in ("latin1", "latin-1"):
            raise ValueError(f"a pickle holds bytes in the encoding {encoding!r}: only latin1 is read")
        return text.encode("latin1")
