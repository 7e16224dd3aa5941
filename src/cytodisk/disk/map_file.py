"""The file of a map: a header in JSON, the mask cropped to the cell, and arrays."""

import json
import os
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import ParameterError, ReadError
from cytodisk.files import replacing
from cytodisk.geometry.placed_mask import PlacedMask

_FORMAT = 3
_OLDER = 2  # differs in one word: its "newton" relaxed as "newton-triangles" does in format 3
_FASTEST = 1  # level of compression
# Name, kinds of dtype and shape of a row of each array.
_EXPECTED = (
    ("vertices_yx", "f", (2,)),
    ("vertices_uv", "f", (2,)),
    ("triangles", "iu", (3,)),
    ("boundary", "iu", ()),
)
_RIGHTS = 0o600  # of an array's file where the archive is unpacked


def write_map_file(
    path: str | os.PathLike[str],
    header: Mapping[str, Any],
    mask: PlacedMask,
    arrays: Mapping[str, FloatArray | IntArray],
    numbers: Mapping[str, Any],
) -> None:
    """Write a map's header, mask and arrays to a `.npz` file.

    Parameters
    ----------
    path : path-like
    header : dict
        Can be written as JSON.
    mask : PlacedMask
    arrays : dict of str to ndarray
        Arrays that compression makes smaller. It is the fastest one: the best takes ten times as long for
        files of nearly the same size.
    numbers : dict of str to ndarray
        Arrays that are written as they are: few digits of them repeat, or they are small.

    Raises
    ------
    StudyError
        The file cannot be written.
    ParameterError
        The name does not end in `.npz`.
    """
    if Path(path).suffix != ".npz":
        raise ParameterError(f"path must end in .npz, got {path}")
    place = {"corner": mask.corner, "image_shape": mask.image_shape}
    text = json.dumps({"format": _FORMAT, **header, **place})
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        _write(archive, {"mask": mask.box, **arrays}, zipfile.ZIP_DEFLATED)
        _write(archive, {"header": np.array(text), **numbers}, zipfile.ZIP_STORED)


def _write(archive: zipfile.ZipFile, arrays: Mapping[str, Any], how: int) -> None:
    for name, array in arrays.items():
        content = BytesIO()
        np.lib.format.write_array(content, np.asanyarray(array), allow_pickle=False)
        entry = zipfile.ZipInfo(f"{name}.npy")
        entry.external_attr = _RIGHTS << 16
        archive.writestr(entry, content.getbuffer(), how, _FASTEST)


@contextmanager
def reading_map(path: str | os.PathLike[str]) -> Iterator[tuple[dict[str, Any], PlacedMask, dict[str, Any]]]:
    """Header, mask and arrays of a map's file; what is wrong with it becomes a `ReadError`.

    Raises
    ------
    ReadError
        The file is missing, damaged, of another format, or not a map.
    """
    try:
        if not zipfile.is_zipfile(path) and Path(path).is_file():
            raise ReadError(f"{path} is not a map that DiskMap.save wrote, or it is damaged")
        with Path(path).open("rb") as stream, np.load(stream) as file:
            header = json.loads(str(file["header"]))
            if header["format"] not in (_OLDER, _FORMAT):
                raise ReadError(
                    f"{path} is a map of format {header['format']}, this version reads formats {_OLDER} and "
                    f"{_FORMAT}: make it again, with cytodisk map or map_to_disk"
                )
            if header["format"] == _OLDER and header["method"] == "newton":
                header["method"] = "newton-triangles"
            (y, x), (height, width) = header["corner"], header["image_shape"]
            placed = PlacedMask(file["mask"], (y, x), (height, width))
            arrays = {name: file[name] for name, _, _ in _EXPECTED}
            _check(placed, arrays)
            yield header, placed, arrays
    except FileNotFoundError as error:
        raise ReadError(f"{path} does not exist: pass a file that DiskMap.save wrote") from error
    except (zipfile.BadZipFile, zlib.error, KeyError, TypeError, ValueError, OSError, EOFError) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"{path} is not a map that DiskMap.save wrote: {error}") from error


def _check(placed: PlacedMask, arrays: Mapping[str, FloatArray | IntArray]) -> None:
    """Check that arrays have the kind and the size that kernels take for granted.

    Raises
    ------
    ValueError
        One has not.
    """
    box = placed.box
    if box.dtype != bool or box.ndim != 2 or not box.any():
        raise ValueError(f"its mask has dtype {box.dtype} and shape {box.shape}, or is empty")
    if min(placed.corner) < 0 or (np.add(placed.corner, box.shape) > placed.image_shape).any():
        raise ValueError(
            f"its mask, of shape {box.shape} at {placed.corner}, is not in the image {placed.image_shape}"
        )
    n_vertices = len(arrays["vertices_yx"])
    for name, kind, shape in _EXPECTED:
        array = arrays[name]
        if array.dtype.kind not in kind or array.ndim != len(shape) + 1 or array.shape[1:] != shape:
            raise ValueError(f"{name} has dtype {array.dtype} and shape {array.shape}")
        if kind == "f" and len(array) != n_vertices:
            raise ValueError(f"{name} has shape {array.shape} for {n_vertices} vertices")
        if kind != "f" and not (len(array) and array.min() >= 0 and array.max() < n_vertices):
            raise ValueError(f"{name} name a vertex that does not exist")
