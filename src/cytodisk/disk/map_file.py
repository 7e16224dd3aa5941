"""The file of a map: a header in JSON, the mask cropped to the cell, and arrays."""

import json
import math
import os
import zipfile
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from io import BytesIO
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, NotRequired, Required

import numpy as np
from pydantic import ConfigDict, Field, TypeAdapter, with_config
from typing_extensions import TypedDict

from cytodisk.array_archive import ArrayArchive, reading_arrays
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.mapping_parameters import Method
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.disk.nucleus.nucleus_file import NucleusHeader, nucleus_arrays, nucleus_header, read_nucleus
from cytodisk.errors import ParameterError, ReadError
from cytodisk.files import replacing
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.parameter_words import short_words
from cytodisk.reading_files import checked, json_of

_FORMAT = 4
_OLDER = (2, 3)  # without nuclei and holes; in 2 "newton" relaxed as "newton-triangles" does in later ones
_FASTEST = 1  # level of compression
_WHAT = "a map that DiskMap.save wrote"
_REMEDY = "make it again, with cytodisk map or map_to_disk"
_MOST_SIDE = 1_000_000  # pixels of an image
_BESIDE_PX = 2.0  # the outline runs half a pixel around the mask; of long edges it cuts corners off
_FURTHEST = 1.5  # in the disk; the paper's relaxation can carry vertices beyond the rim
_RIGHTS = 0o600  # of an array's file where the archive is unpacked


def write_map_file(
    path: str | os.PathLike[str],
    header: Mapping[str, Any],
    masks: tuple[PlacedMask, PlacedMask | None],
    arrays: Mapping[str, FloatArray | IntArray],
    numbers: Mapping[str, Any],
    nucleus: Nucleus | None = None,
) -> None:
    """Write a map's header, mask and arrays to a `.npz` file.

    Parameters
    ----------
    path : path-like
    header : dict
        Can be written as JSON.
    masks : (PlacedMask, PlacedMask or None)
        That of the cell, and its holes that belong to no window, in the same box.
    arrays : dict of str to ndarray
        Arrays that compression makes smaller. It is the fastest one: the best takes ten times as long for
        files of nearly the same size.
    numbers : dict of str to ndarray
        Arrays that are written as they are: few digits of them repeat, or they are small.
    nucleus : Nucleus, optional

    Raises
    ------
    StudyError
        The file cannot be written.
    ParameterError
        The name does not end in `.npz`.
    """
    if Path(path).suffix != ".npz":
        raise ParameterError(f"path must end in .npz, got {path}")
    mask, holes = masks
    boxes = {"mask": mask.box} if holes is None else {"mask": mask.box, "holes": holes.box}
    place = {"corner": mask.corner, "image_shape": mask.image_shape}
    if nucleus is not None:
        header = {**header, "nucleus": nucleus_header(nucleus)}
        arrays, numbers = {**arrays, **nucleus_arrays(nucleus)}, {**numbers, "nucleus_places": nucleus.places}
    text = json.dumps({"format": _FORMAT, **header, **place})
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w") as archive:
        _write(archive, {**boxes, **arrays}, zipfile.ZIP_DEFLATED)
        _write(archive, {"header": np.array(text), **numbers}, zipfile.ZIP_STORED)


def _write(archive: zipfile.ZipFile, arrays: Mapping[str, Any], how: int) -> None:
    for name, array in arrays.items():
        content = BytesIO()
        np.lib.format.write_array(content, np.asanyarray(array), allow_pickle=False)
        entry = zipfile.ZipInfo(f"{name}.npy")
        entry.external_attr = _RIGHTS << 16
        archive.writestr(entry, content.getbuffer(), how, _FASTEST)


class MapContent(NamedTuple):
    """What a map's file holds.

    Attributes
    ----------
    header : dict
    mask : PlacedMask
    arrays : dict of str to ndarray
        "vertices_yx", "vertices_uv", "triangles" and "boundary".
    nucleus : Nucleus or None
    holes : PlacedMask or None
    """

    header: dict[str, Any]
    mask: PlacedMask
    arrays: dict[str, Any]
    nucleus: Nucleus | None
    holes: PlacedMask | None


_Count = Annotated[int, Field(ge=0, lt=2**53)]
_Side = Annotated[int, Field(ge=1, le=_MOST_SIDE)]
_Share = Annotated[float, Field(ge=0, le=1)]
_Positive = Annotated[float, Field(gt=0)]
_STRICT = ConfigDict(strict=True, allow_inf_nan=False)


@with_config(_STRICT)
class _Report(TypedDict):
    area_px: _Count
    components: _Count
    dropped_px: _Count
    holes: _Count
    filled_px: _Count
    border_share: _Share
    excluded_px: NotRequired[_Count]
    nucleus_in_holes_px: NotRequired[_Count]


@with_config(_STRICT)
class _Header(TypedDict, total=False):
    report: Required[_Report]
    pixel_size_um: _Positive | None
    frame_interval_s: _Positive | None
    method: Required[Method]
    start: Required[Literal["cotangent", "uniform", "previous"]]
    shape_weight: Required[_Positive]
    edge_length: Required[_Positive]
    steps: Required[_Count]
    converged: Required[bool]
    corner: Required[Annotated[list[_Count], Field(min_length=2, max_length=2)]]
    image_shape: Required[Annotated[list[_Side], Field(min_length=2, max_length=2)]]
    nucleus: NucleusHeader


@cache
def _header() -> TypeAdapter[Any]:
    return TypeAdapter(_Header)


def read_map_file(path: str | os.PathLike[str]) -> MapContent:
    """Header, mask and arrays of a map's file, checked so far that kernels can take them.

    Whether they are those of a map that is one to one, its certificate says.

    Parameters
    ----------
    path : path-like

    Returns
    -------
    MapContent

    Raises
    ------
    ReadError
        The file is missing, damaged, of another format, or not a map.
    """
    with reading_arrays(path, _WHAT, _REMEDY) as archive:
        header = _read_header(path, archive)
        arrays = _read_arrays(archive)
        placed = _read_mask(archive, header, arrays["vertices_yx"])
        about = header.get("nucleus")
        nucleus = None if about is None else read_nucleus(archive, about, arrays, placed)
        excluded = header["report"].get("excluded_px", 0)
        holes = _read_holes(archive, placed, excluded) if excluded else None
    return MapContent(header, placed, arrays, nucleus, holes)


def _read_header(path: str | os.PathLike[str], archive: ArrayArchive) -> dict[str, Any]:
    header = json_of(*archive.texts("header"))
    version = header.get("format") if isinstance(header, dict) else None
    if version not in (*_OLDER, _FORMAT):
        raise ReadError(
            f"{path} is a map of format {short_words(version)}, this version reads formats {_OLDER[0]} to "
            f"{_FORMAT}: {_REMEDY}"
        )
    found: dict[str, Any] = checked(header, _header, f"{path}: header", _REMEDY)
    if version == _OLDER[0] and found["method"] == "newton":
        found["method"] = "newton-triangles"
    return found


def _read_arrays(archive: ArrayArchive) -> dict[str, Any]:
    """Vertices, triangles and boundary: what kernels would follow out of their memory is an error."""
    in_cell = archive.floats("vertices_yx", (None, 2), low=-_MOST_SIDE, high=2 * _MOST_SIDE)
    n_vertices = len(in_cell)
    in_disk = archive.floats("vertices_uv", (n_vertices, 2), low=-_FURTHEST, high=_FURTHEST)
    triangles = archive.integers("triangles", (None, 3), least=0, most=n_vertices - 1)
    boundary = archive.integers("boundary", (None,), least=0, most=n_vertices - 1)
    if len(boundary) < 3 or not len(triangles):
        raise archive.fault("boundary", f"has {len(boundary)} vertices around {len(triangles)} triangles")
    if not _runs_round_once(in_disk[boundary]):
        raise archive.fault("boundary", "does not run once around the disk")
    if len(triangles) != 2 * n_vertices - len(boundary) - 2 or len(np.unique(triangles)) != n_vertices:
        raise archive.fault("triangles", f"has {len(triangles)} rows, which do not fill a disk")
    if not _have_area(in_cell, triangles):
        raise archive.fault("triangles", "have corners in one line in the cell")
    return {"vertices_yx": in_cell, "vertices_uv": in_disk, "triangles": triangles, "boundary": boundary}


def _have_area(vertices_yx: FloatArray, triangles: IntArray) -> bool:
    """Whether no triangle of the cell is a line, of which stretches would be infinite."""
    y, x = vertices_yx.T
    first, second, third = triangles.T
    across = (y[second] - y[first]) * (x[third] - x[first]) - (x[second] - x[first]) * (y[third] - y[first])
    return bool(across.all())


def _runs_round_once(on_circle: FloatArray) -> bool:
    u, v = on_circle.T
    next_u, next_v = np.roll(u, -1), np.roll(v, -1)
    turns = np.arctan2(u * next_v - v * next_u, u * next_u + v * next_v)
    return bool(turns.min() > 0 and abs(turns.sum() - 2.0 * math.pi) < 1e-6)


def _read_mask(archive: ArrayArchive, header: Mapping[str, Any], vertices_yx: FloatArray) -> PlacedMask:
    """The mask, whose box must lie in the image, and around the vertices."""
    slack = _BESIDE_PX + header["edge_length"]
    low, high = vertices_yx.min(axis=0), vertices_yx.max(axis=0)
    height, width = (int(side) for side in high - low + 2.0 * slack)
    box = archive.truths("mask", (None, None), most=(height, width))
    corner, image_shape = np.array(header["corner"]), header["image_shape"]
    end = corner + box.shape
    if (end > image_shape).any():
        words = f"has shape {box.shape} at {header['corner']}, which is not in an image of {image_shape}"
        raise archive.fault("mask", words)
    if not box.any() or (low < corner - slack).any() or (high > end + slack).any():
        raise archive.fault("mask", "is not that of the cell that vertices_yx describe")
    return PlacedMask(box, tuple(header["corner"]), tuple(image_shape))


def _read_holes(archive: ArrayArchive, placed: PlacedMask, n_pixels: int) -> PlacedMask:
    """Holes in the mask, which must be so many pixels of it, and not all."""
    box = archive.truths("holes", placed.box.shape, most=placed.box.shape)
    if box.sum() != n_pixels or (box & ~placed.box).any() or n_pixels == placed.box.sum():
        raise archive.fault("holes", "are not those of the mask")
    return replace(placed, box=box)
