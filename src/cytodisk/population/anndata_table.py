"""A population as `anndata.AnnData`: cells × windows, as scanpy and the rest of scverse read them."""

from __future__ import annotations

import os
from collections.abc import Hashable, Iterator
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import AnyArray, FloatArray
from cytodisk.errors import MissingPartError
from cytodisk.files import replacing
from cytodisk.population.group_columns import CONDITION, EXPERIMENT, names_in
from cytodisk.population.plain_columns import categories, file_key, plain_column, with_plain_names

if TYPE_CHECKING:
    from anndata import AnnData as AnnData

_NAMES = ("input", "file", "cell", "frame")  # columns that together name a cell
_SECTOR_0 = {
    "none": "begins at +u of the disk",
    "nucleus": "begins away from the nucleus",
    "axis": "begins at the further end of the long axis",
    "front": "begins where the edge moves out",
    "motion": "begins where the cell moves to",
}
_DIRECTION, _STRENGTH = "disk_direction_", "direction_strength_"


class WindowsOfCells(Protocol):
    """What is read of a population."""

    cells: pd.DataFrame
    raw: xr.DataArray
    areas: xr.DataArray | None
    scalars: tuple[str, ...]
    normalisation: tuple[str, ...]
    aligned_by: str
    alignment: pd.DataFrame

    def __len__(self) -> int: ...

    @property
    def units(self) -> str: ...

    def blocks(self) -> Iterator[tuple[slice, FloatArray]]: ...

    def scalar_table(self) -> pd.DataFrame: ...


def population_anndata(population: WindowsOfCells) -> AnnData:
    """Cells × windows of a population, normalised and turned as it is.

    Parameters
    ----------
    population : Population

    Returns
    -------
    AnnData

    Raises
    ------
    MissingPartError
        anndata is not installed.
    """
    table = require_anndata()
    obs = _observations(population)
    windows = population.raw[0].size if len(population) else int(np.prod(population.raw.shape[1:]))
    if windows:
        values, var = _values(population), _variables(population.raw)
        var["cells"] = _counts(values)
    else:
        values, var = _scalars(population)
    return table(
        X=values, obs=obs, var=var, obsm=dict(_tables(population, obs)), uns={"cytodisk": _notes(population)}
    )


def require_anndata() -> type[AnnData]:
    """The class of tables.

    Raises
    ------
    MissingPartError
        anndata is not installed.
    """
    try:
        from anndata import AnnData
    except ImportError as error:
        fault = f"cannot be imported ({error})"
        raise MissingPartError.of("a table for scanpy needs anndata", "anndata", fault) from error
    table: type[AnnData] = AnnData
    return table


def write_h5ad(population: WindowsOfCells, path: str | os.PathLike[str]) -> None:
    """Write a population to a file that `scanpy.read_h5ad` reads, whole or not at all.

    Parameters
    ----------
    population : Population
    path : path-like
        Such as "atlas/population.h5ad". A file of this name is replaced.

    Raises
    ------
    MissingPartError
        anndata is not installed.
    WriteError
        The file cannot be written.
    """
    table = population_anndata(population)
    with replacing(path) as temporary:
        table.write_h5ad(temporary)


def _values(population: WindowsOfCells) -> AnyArray:
    """A row a cell, a column a window, in the precision of the population; filled block by block."""
    raw = population.raw
    found = np.empty((len(population), int(np.prod(raw.shape[1:]))), dtype=raw.dtype)
    for rows, block in population.blocks():
        found[rows] = block.reshape(len(block), -1)
    return found


def _counts(values: AnyArray, at_once: int = 4096) -> AnyArray:
    """How many cells have a value in each window."""
    parts = (values[start : start + at_once] for start in range(0, len(values), at_once))
    return sum((np.isfinite(part).sum(axis=0) for part in parts), np.zeros(values.shape[1], dtype=np.int64))


def _variables(raw: xr.DataArray) -> pd.DataFrame:
    """A row a window, in the order of `_values`."""
    last = str(raw.dims[-1])
    channels, layers, places = (raw[dim].to_numpy() for dim in raw.dims[1:])
    steps = np.meshgrid(*(np.arange(len(names)) for names in (channels, layers, places)), indexing="ij")
    channel, layer, place = (
        names[step.ravel()] for names, step in zip((channels, layers, places), steps, strict=True)
    )
    var = pd.DataFrame({"channel": categories(channel, channels), "layer": layer, last: place})
    if "compartment" in raw.coords:
        compartments = raw["compartment"].to_numpy()
        var["compartment"] = categories(compartments[steps[1].ravel()], compartments)
    named = [
        f"{one}_layer{ring}_{last}{at}"
        for one, ring, at in zip(channel, layer.tolist(), place.tolist(), strict=True)
    ]
    return with_plain_names(var, named)


def _scalars(population: WindowsOfCells) -> tuple[FloatArray, pd.DataFrame]:
    """Cells without windows, such as those of `shapes`: their scalars take the place of windows."""
    names = list(population.scalars)
    values = population.cells[names].to_numpy(dtype=np.float64)
    units = population.cells.attrs.get("units", {})
    var = pd.DataFrame({"unit": [str(units.get(name, "")) for name in names], "cells": _counts(values)})
    return values, with_plain_names(var, names)


def _observations(population: WindowsOfCells) -> pd.DataFrame:
    """The table of cells, and how each was turned, in types that every version of AnnData writes."""
    cells = population.cells
    columns: dict[Hashable, Any] = {name: plain_column(cells[name]) for name in cells}
    for name in (CONDITION, EXPERIMENT):
        if name in cells:
            names = names_in(cells, name)
            columns[name] = categories(names, names.dropna())
    if population.aligned_by != "none":
        for name in map(str, population.alignment):
            columns[f"alignment_{name}"] = plain_column(population.alignment[name])
    obs = pd.DataFrame(columns, index=range(len(cells)))
    return with_plain_names(obs, _cell_names(cells))


def _cell_names(cells: pd.DataFrame) -> list[str]:
    """A name for each cell: as short as is unique, out of the columns that name cells."""
    tried = [[name] for name in ("cell",) if name in cells]
    tried += [[name for name in _NAMES if name in cells]]
    tried += [[name for name in (CONDITION, EXPERIMENT, *_NAMES) if name in cells]]
    named = [f"cell{number}" for number in range(len(cells))]
    for columns in tried:
        if not columns:
            continue
        parts = [names_in(cells, name).fillna("") for name in columns]
        named = ["/".join(filter(None, row)) for row in zip(*parts, strict=True)]
        if len(set(named)) == len(named):
            break
    return named


def _tables(population: WindowsOfCells, obs: pd.DataFrame) -> Iterator[tuple[str, Any]]:
    """What a cell has beside its windows: scalars, directions in the disk, areas of windows."""
    scalars = population.scalar_table()
    own = scalars[[name for name in scalars if scalars[name].dtype.kind in "fiub" and name not in obs]]
    if own.shape[1]:
        yield "scalars", with_plain_names(own.astype(np.float64), list(obs.index))
    for name in [str(name) for name in population.cells if str(name).startswith(_DIRECTION)]:
        word = name.removeprefix(_DIRECTION)
        yield f"direction_{file_key(word)}", _direction(population, word)
    if population.areas is not None:
        areas = population.areas.to_numpy()
        yield "window_areas", _turned(areas, population.alignment["shift"]).reshape(len(areas), -1)


def _direction(population: WindowsOfCells, word: str) -> FloatArray:
    """(u, v) of a direction in the disk, as long as it is strong, turned with the windows."""
    cells, raw = population.cells, population.raw
    degrees = cells[_DIRECTION + word].to_numpy(dtype=np.float64)
    if raw.dims[-1] == "sector" and raw.sizes["sector"]:
        degrees = degrees - population.alignment["shift"].to_numpy() * 360.0 / raw.sizes["sector"]
    strength = np.ones(len(cells))
    if _STRENGTH + word in cells:
        strength = cells[_STRENGTH + word].to_numpy(dtype=np.float64)
    angle = np.deg2rad(degrees)
    uv: FloatArray = strength[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    return uv


def _turned(areas: AnyArray, shift: pd.Series[Any]) -> AnyArray:
    """Areas by (cell, layer, sector) with each cell's sectors turned as its values are."""
    if not shift.any():
        return areas.copy()
    sectors = areas.shape[-1]
    at = (np.arange(sectors) + shift.to_numpy()[:, None]) % sectors
    return np.take_along_axis(areas, at[:, None, :], axis=-1)


def _notes(population: WindowsOfCells) -> dict[str, Any]:
    """What the values are, for readers and other programs."""
    raw, cells = population.raw, population.cells
    units = {file_key(str(name)): str(unit) for name, unit in cells.attrs.get("units", {}).items()}
    inside = int((raw["compartment"] == "nucleus").sum()) if "compartment" in raw.coords else 0
    grid: dict[str, Any] = {f"{name}s": size for name, size in raw.sizes.items() if name != "cell"}
    return {
        "version": version("cytodisk"),
        "values": str(raw.attrs.get("long_name", raw.name or "")),
        "units": {"values": population.units, **units},
        "grid": grid | {"nucleus_layers": inside},
        "normalise": ", ".join(population.normalisation) or "none",
        "align": population.aligned_by,
        "sector_0": _SECTOR_0.get(population.aligned_by, "begins at the brightest side of the signal"),
    }
