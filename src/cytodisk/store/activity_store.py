"""The activity store of a movie's study: a Zarr group a cell, written a few frames at a time.

It is one file, the Zip of a Zarr store: with shards each of a cell's arrays, about 30, still were two files.
"""

from __future__ import annotations

import shutil
import zipfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.activity import DISTANCES, STATISTICS, geometry_of
from cytodisk.errors import ReadError, StudyError
from cytodisk.files import replacing, temporary_name
from cytodisk.scale import Scale
from cytodisk.store.activity_reading import EDGE_VARIABLES, read_activity
from cytodisk.windows.layer_coords import layer_coords
from cytodisk.windows.polar_windows import PolarGrid

_FRAMES_PER_CHUNK = 64
_ZARR: dict[str, Any] = {"zarr_format": 2, "consolidated": False}  # format 3 has no strings yet


class ActivityStore:
    """The writing side of an activity store."""

    def __init__(self, path: Path):
        self._path = path

    @classmethod
    @contextmanager
    def replacing(cls, target: Path) -> Iterator[ActivityStore]:
        """Write a store under a temporary name and rename it when the block ends well.

        Parameters
        ----------
        target : Path

        Yields
        ------
        ActivityStore

        Raises
        ------
        StudyError
            The folder cannot be written.
        """
        work = target.with_name(temporary_name(".zarr"))
        try:
            work.mkdir()
            yield cls(work)
            with replacing(target) as temporary:
                _pack(work, temporary)
        except OSError as error:
            raise StudyError(f"cannot write {target}: {error.strerror or error}") from error
        finally:
            shutil.rmtree(work, ignore_errors=True)

    def cell(
        self,
        cell: int,
        label: int,
        grid: PolarGrid,
        channels: Sequence[str],
        scale: Scale,
    ) -> CellActivity:
        """Start the group of a cell; without channels it has no statistics."""
        attrs: dict[str, Any] = {"cell": cell, "label": label} | scale.attrs
        return CellActivity(self._path, group_name(cell), grid, channels, attrs)


class CellActivity:
    """One cell's group; frames are appended in order."""

    def __init__(
        self, path: Path, group: str, grid: PolarGrid, channels: Sequence[str], attrs: dict[str, Any]
    ):
        self._path = path
        self._group = group
        self._grid = grid
        self._channels = list(channels)
        self._attrs = attrs
        self._scale = Scale(attrs.get("pixel_size_um"), attrs.get("frame_interval_s"))
        self._frames: list[tuple[int, dict[str, Any] | None, str, str]] = []
        self._written = False

    def append(self, frame: int, arrays: dict[str, Any] | None, status: str, reason: str) -> None:
        """Add a frame.

        Parameters
        ----------
        frame : int
        arrays : dict of str to ndarray, or None
            Statistics of shape (C, L, S), geometry (L, S), edge (S,); None without a map.
        status, reason : str
        """
        self._frames.append((frame, arrays, status, reason))
        if len(self._frames) >= _FRAMES_PER_CHUNK:
            self._flush()

    def close(self) -> None:
        """Write what is left."""
        if self._frames:
            self._flush()

    def _flush(self) -> None:
        chunk = self._dataset()
        if self._written:
            fixed = [name for name in chunk.variables if "time" not in chunk[name].dims]
            chunk.drop_vars(fixed).to_zarr(self._path, group=self._group, append_dim="time", **_ZARR)
        else:
            encoding = {
                name: {"chunks": (_FRAMES_PER_CHUNK, *variable.shape[1:])}
                for name, variable in chunk.variables.items()
                if variable.dims[:1] == ("time",)
            }
            chunk.to_zarr(self._path, group=self._group, encoding=encoding, **_ZARR)
        self._written = True
        self._frames = []

    def _dataset(self) -> xr.Dataset:
        layers, sectors = self._grid.layers, self._grid.sectors
        names = self._channels
        shapes: dict[str, tuple[tuple[str, ...], tuple[int, ...]]] = {}
        shapes |= dict.fromkeys(geometry_of(self._grid), (("layer", "sector"), (layers, sectors)))
        shapes |= dict.fromkeys(EDGE_VARIABLES, (("sector",), (sectors,)))
        if names:
            three = ("channel", "layer", "sector"), (len(names), layers, sectors)
            shapes = dict.fromkeys(STATISTICS, three) | shapes
        data: dict[str, Any] = {}
        for name, (dims, shape) in shapes.items():
            values = [
                np.full(shape, np.nan) if arrays is None else arrays[name] for _, arrays, _, _ in self._frames
            ]
            data[name] = (("time", *dims), np.stack(values), {"units": self._unit(name)})
        for place, name in ((2, "status"), (3, "reason")):
            data[name] = ("time", np.array([frame[place] for frame in self._frames], dtype=object))
        coords: dict[str, Any] = layer_coords(self._grid) | {"sector": np.arange(sectors)}
        if "compartment" in coords:
            coords["compartment"] = "layer", self._grid.compartments.astype(object)
        if names:
            coords["channel"] = np.array(names, dtype=object)
        coords |= self._scale.time_coords(np.array([frame[0] for frame in self._frames]))
        return xr.Dataset(data, coords, self._attrs)

    def _unit(self, name: str) -> str:
        if name.startswith("velocity"):
            return self._scale.velocity_unit
        if name == "edge_length" or name in DISTANCES:
            return self._scale.length_unit
        if name.endswith("area"):
            return self._scale.area_unit
        return {"n_pixels": "px²", "n_nan": "px²", "centroid_y": "px", "centroid_x": "px"}.get(name, "a.u.")


def group_name(cell: int) -> str:
    """Name of a cell's group."""
    return f"cell_{cell:05d}"


def open_activity(path: Path, cell: int) -> xr.Dataset:
    """Read a cell's group; arrays are read when asked for.

    Parameters
    ----------
    path : Path
        The store; where it does not stand, a folder of that name without ".zip", as earlier versions wrote.
    cell : int

    Returns
    -------
    Dataset with dims (time, channel, layer, sector)

    Raises
    ------
    ReadError
        It is not there or damaged.
    """
    folder = path.with_suffix("")
    place = folder if folder.is_dir() and not path.exists() else path
    if not place.exists():
        raise ReadError(f"{path} has no activity of cell {cell}: it does not exist")
    return read_activity(place, group_name(cell), _ZARR)


def _pack(folder: Path, target: Path) -> None:
    """Put a folder into a Zip file; the same content gives the same bytes."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_STORED) as packed:
        for file in sorted(path for path in folder.rglob("*") if path.is_file()):
            name = zipfile.ZipInfo(file.relative_to(folder).as_posix())
            packed.writestr(name, file.read_bytes())
