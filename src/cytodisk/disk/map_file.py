"""The file of a map: a header in JSON, the mask cropped to the cell, and arrays."""

import json
import os
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import ParameterError, ReadError
from cytodisk.files import replacing

_FORMAT = 2


def write_map_file(
    path: str | os.PathLike[str],
    header: Mapping[str, Any],
    mask: BoolArray,
    arrays: Mapping[str, FloatArray | IntArray],
) -> None:
    """Write a map's header, mask and arrays to a compressed `.npz` file.

    Raises
    ------
    StudyError
        The file cannot be written.
    ParameterError
        The name does not end in `.npz`.
    """
    if Path(path).suffix != ".npz":
        raise ParameterError(f"path must end in .npz, got {path}")
    crop, corner = _cropped(mask)  # a cell is small in its image
    place = {"corner": corner, "image_shape": list(mask.shape)}
    text = json.dumps({"format": _FORMAT, **header, **place})
    with replacing(path) as temporary:
        np.savez_compressed(temporary, header=np.array(text), mask=crop, **dict[str, Any](arrays))


@contextmanager
def reading_map(path: str | os.PathLike[str]) -> Iterator[tuple[dict[str, Any], BoolArray, Any]]:
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
            if header["format"] != _FORMAT:
                raise ReadError(
                    f"{path} is a map of format {header['format']}, this version reads format {_FORMAT}: "
                    "make it again, with cytodisk map or map_to_disk"
                )
            yield header, placed_mask(file["mask"], header["corner"], header["image_shape"]), file
    except FileNotFoundError as error:
        raise ReadError(f"{path} does not exist: pass a file that DiskMap.save wrote") from error
    except (zipfile.BadZipFile, zlib.error, KeyError, TypeError, ValueError, OSError, EOFError) as error:
        if isinstance(error, ReadError):
            raise
        raise ReadError(f"{path} is not a map that DiskMap.save wrote: {error}") from error


def placed_mask(mask: BoolArray, corner: Sequence[int], image_shape: Sequence[int]) -> BoolArray:
    """A mask in the image that it was cut out of.

    Parameters
    ----------
    mask : ndarray of shape (h, w) and dtype bool
    corner : (int, int)
        (row, column) of its first pixel in the image.
    image_shape : (int, int)
    """
    whole = np.zeros(tuple(image_shape), dtype=bool)
    (y, x), (height, width) = corner, mask.shape
    whole[y : y + height, x : x + width] = mask
    return whole


def _cropped(mask: BoolArray) -> tuple[BoolArray, list[int]]:
    rows = np.flatnonzero(mask.any(axis=1))
    strip = mask[rows[0] : rows[-1] + 1]
    columns = np.flatnonzero(strip.any(axis=0))
    return strip[:, columns[0] : columns[-1] + 1], [int(rows[0]), int(columns[0])]
