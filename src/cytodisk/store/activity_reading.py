"""Read one cell out of an activity store that somebody may have edited; arrays when they are asked for."""

from __future__ import annotations

import math
import zipfile
from collections.abc import Iterator
from functools import cache, lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import xarray as xr
from pydantic import ConfigDict, Field, TypeAdapter, with_config
from typing_extensions import TypedDict
from xarray.backends import BackendArray
from xarray.core import indexing

from cytodisk.analysis.activity import DISTANCES, GEOMETRY, STATISTICS, with_places
from cytodisk.errors import ReadError
from cytodisk.memory import free_bytes
from cytodisk.reading_files import checked, json_of, reading_file, text_of

_WHAT, _REMEDY = "the activity that cytodisk movie wrote", "run cytodisk movie again with --overwrite"
_MOST = 1_000_000  # frames, channels, layers or sectors
_SMALL = 10**8  # bytes that there always are
_WINDOW = ("layer", "sector")
EDGE_VARIABLES = (
    "velocity",
    "velocity_cell_frame",
    "velocity_fastest",
    "velocity_error",
    "protruded_area",
    "retracted_area",
    "edge_length",
)
_DIMS = {
    **dict.fromkeys(STATISTICS, ("time", "channel", *_WINDOW)),
    **dict.fromkeys((*GEOMETRY, *DISTANCES), ("time", *_WINDOW)),
    **dict.fromkeys(EDGE_VARIABLES, ("time", "sector")),
    **dict.fromkeys(("status", "reason", "frame", "time_s"), ("time",)),
    **{name: (name,) for name in ("channel", *_WINDOW)},
    "compartment": ("layer",),
}
_NEEDED = ("status", "reason", "frame", *_WINDOW, *GEOMETRY[:1], *EDGE_VARIABLES)
_TEXTS = ("status", "reason", "channel", "compartment")
_Length = Annotated[int, Field(strict=True, ge=0, le=_MOST)]
_Chunk = Annotated[int, Field(strict=True, ge=1, le=_MOST)]


@with_config(ConfigDict(extra="allow"))
class _ZarrArray(TypedDict):
    zarr_format: Literal[2]
    shape: Annotated[list[_Length], Field(max_length=4)]
    chunks: Annotated[list[_Chunk], Field(max_length=4)]
    dtype: Literal["<f8", "<i8", "|O"]
    order: Literal["C"]
    compressor: dict[str, Any] | None
    filters: list[dict[str, Any]] | None


@cache
def _zarr_array() -> TypeAdapter[Any]:
    return TypeAdapter(_ZarrArray)


@cache
def _attributes() -> TypeAdapter[Any]:
    return TypeAdapter(dict[str, str | float | list[str]])


def read_activity(path: Path, group: str, zarr: dict[str, Any]) -> xr.Dataset:
    """Read a group; see `cytodisk.store.activity_store.open_activity`.

    Parameters
    ----------
    path : Path
        A Zip file, or a folder as earlier versions wrote.
    group : str
    zarr : dict
        Options of the format.

    Returns
    -------
    Dataset with dims (time, channel, layer, sector)

    Raises
    ------
    ReadError
        It is not there or damaged; from the arrays, when they are read.
    """
    with reading_file(path, _WHAT, _REMEDY):
        told = dict(_metadata(path, group))
        if not told:
            raise ReadError(f"{path} has no activity of {group}: {_REMEDY}")
        for name, text in told.items():
            place = f"{path}: {name}"
            shape = {".zarray": _zarr_array, ".zattrs": _attributes}.get(name.rpartition("/")[2])
            content = json_of(text)
            if shape is not None:
                checked(content, shape, place, _REMEDY)
            if name.endswith(".zarray"):
                _check_size(place, content)
        store = path if path.is_dir() else _opened(path, path.stat().st_mtime_ns)
        found: xr.Dataset = xr.open_zarr(store, group=group, chunks=None, **zarr)
        _check(path, found)
        guarded = {
            name: (one.dims, indexing.LazilyIndexedArray(_Guarded(path, name, one.variable)), one.attrs)
            for name, one in found.data_vars.items()
        }
        return with_places(xr.Dataset(guarded, found.coords, found.attrs).set_xindex("frame"))


def _metadata(path: Path, group: str) -> Iterator[tuple[str, str]]:
    """Names and texts of what a group says of itself and of its arrays."""
    if path.is_dir():
        for file in sorted((path / group).rglob(".z*")):
            yield file.relative_to(path).as_posix(), text_of(file)
        return
    if not path.is_file() and path.exists():
        raise ReadError(f"{path} is no file: {_REMEDY}")
    archive: zipfile.ZipFile = _opened(path, path.stat().st_mtime_ns)._zf
    for name in archive.namelist():
        if name.startswith(f"{group}/") and name.rpartition("/")[2].startswith(".z"):
            if archive.getinfo(name).file_size > _MOST:
                raise ValueError(f"{name} is larger than any that is written")
            yield name, archive.read(name).decode()


@lru_cache(maxsize=1)
def _opened(path: Path, _changed: int) -> Any:
    """A packed store; it stays open for the next cell, as going through the names in it takes time."""
    from zarr.storage import ZipStore

    store = ZipStore(path, mode="r")
    store._sync_open()
    return store


def _check_size(place: str, array: dict[str, Any]) -> None:
    """Shape and chunks must fit each other and memory."""
    shape, chunks = array["shape"], array["chunks"]
    if len(shape) != len(chunks) or any(a > max(b, 64) for a, b in zip(chunks, shape, strict=True)):
        raise ReadError(f"{place}: chunks of {chunks} in an array of {shape}: {_REMEDY}")
    needed = 8 * max(math.prod(shape), math.prod(chunks))
    if needed > _SMALL and needed > free_bytes() // 2:
        raise ReadError(
            f"{place}: shape {shape} asks for {needed / 1e9:.1f} GB, more than is free: {_REMEDY}"
        )


def _check(path: Path, found: xr.Dataset) -> None:
    """Names, dims and types are those of a movie's cell, and coordinates count from 0."""
    for name in _NEEDED:
        if name not in found.variables:
            raise ReadError(f"{path}: {name} is missing: {_REMEDY}")
    for name, variable in ((str(name), variable) for name, variable in found.variables.items()):
        dims = _DIMS.get(name, variable.dims)
        kinds = "OTU" if name in _TEXTS else "iuf"
        if variable.dims != dims or variable.dtype.kind not in kinds:
            words = f"{name} has dims {', '.join(map(str, variable.dims))} and type {variable.dtype}"
            raise ReadError(f"{path}: {words}, not {', '.join(map(str, dims))}: {_REMEDY}")
    for name in _WINDOW:
        if not np.array_equal(found[name].to_numpy(), np.arange(found.sizes[name])):
            raise ReadError(f"{path}: {name} does not count from 0: {_REMEDY}")
    frames = found["frame"].to_numpy()
    if not len(frames) or frames[0] < 0 or (np.diff(frames) <= 0).any() or frames[-1] >= _MOST:
        raise ReadError(f"{path}: frame does not count up: {_REMEDY}")


class _Guarded(BackendArray):
    """An array that is read when it is asked for; what is wrong with it becomes a `ReadError`."""

    def __init__(self, path: Path, name: Any, variable: xr.Variable):
        self.shape = variable.shape
        self.dtype = variable.dtype
        self._path, self._name, self._variable = path, name, variable

    def __getitem__(self, key: Any) -> Any:
        """Some of its values."""
        return indexing.explicit_indexing_adapter(
            key, self.shape, indexing.IndexingSupport.BASIC, self._values_at
        )

    def _values_at(self, key: tuple[Any, ...]) -> Any:
        with reading_file(self._path, f"{_WHAT}: {self._name}", _REMEDY):
            return self._variable[key].values
