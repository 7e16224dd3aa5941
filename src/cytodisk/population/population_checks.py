"""Checks of what a `Population` is made of."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.checks import instance_of
from cytodisk.errors import PopulationError
from cytodisk.population.cell_scaling import BLOCK_VALUES

DIMS = ("cell", "channel", "layer")
LAST = ("sector", "lag")


_LARGEST = 1e150  # whose square is a number


def check_table(cells: pd.DataFrame) -> None:
    """Raise where the table of cells is none, or has two columns with one name."""
    instance_of("cells", cells, pd.DataFrame, "a DataFrame with a row for each cell")
    if not cells.columns.is_unique:
        twice = cells.columns[cells.columns.duplicated()][0]
        raise PopulationError(f"cells has two columns {twice!r}: keep one")


def checked_values(values: xr.DataArray | None, cells: int) -> xr.DataArray:
    """Values with dims (cell, channel, layer, sector or lag); without values, of no channel.

    Parameters
    ----------
    values : DataArray or None
    cells : int

    Returns
    -------
    DataArray

    Raises
    ------
    PopulationError
        Other dims, another number of cells, no numbers, or infinite ones.
    """
    if values is None:
        empty = np.empty((cells, 0, 0, 0))
        return xr.DataArray(empty, dims=(*DIMS, "sector"), coords={"channel": np.array([], dtype=str)})
    instance_of("values", values, xr.DataArray, "a DataArray with dims cell, layer and sector")
    last = [name for name in LAST if name in values.dims]
    wanted = ("cell", "layer", *last)
    if len(last) != 1 or {*values.dims} - {"channel"} != {*wanted}:
        raise PopulationError(
            f"values has the dims {', '.join(map(str, values.dims))}: it needs cell, layer and sector (or "
            "lag), and may have channel"
        )
    if values.sizes["cell"] != cells:
        raise PopulationError(
            f"values has {values.sizes['cell']} cells and the table {cells} rows: row i must belong to "
            "values[i]"
        )
    if values.dtype not in (np.float64, np.float32):
        if values.dtype.kind not in "iufb":
            raise PopulationError(f"values must be numbers, got {values.dtype}")
        values = values.astype(np.float64)
    if "channel" not in values.dims:
        values = values.drop_vars("channel", errors="ignore")
        values = values.expand_dims(channel=[str(values.name or "signal")])
    elif "channel" not in values.coords:
        values = values.assign_coords(channel=[f"channel {k}" for k in range(values.sizes["channel"])])
    found = values.transpose(*DIMS, last[0])
    if 0 in found.shape[1:]:
        raise PopulationError(
            f"values has no {found.dims[found.shape.index(0, 1)]}: pass None for cells without windows"
        )
    names = [str(name) for name in found["channel"].values]
    if len(set(names)) < len(names):
        raise PopulationError(f"values has channels with one name: {', '.join(names)}")
    _refuse_infinite(found)
    return found


def _refuse_infinite(values: xr.DataArray) -> None:
    step = max(1, BLOCK_VALUES // max(1, int(np.prod(values.shape[1:]))))
    largest = values.dtype.type(min(_LARGEST, float(np.finfo(values.dtype).max)))
    for start in range(0, len(values), step):
        sizes = np.abs(values.values[start : start + step]).reshape(-1, int(np.prod(values.shape[1:])))
        infinite = sizes > largest
        if infinite.any():
            row = start + int(np.flatnonzero(infinite.any(axis=1))[0])
            raise PopulationError(
                f"values of cell {row} are infinite in {int(infinite[row - start].sum())} windows, or beyond "
                f"{_LARGEST:g}: write NaN where a window has no value"
            )


def checked_areas(areas: xr.DataArray | None, values: xr.DataArray) -> xr.DataArray | None:
    """Areas with dims (cell, layer, sector or lag) that fit the values.

    Raises
    ------
    PopulationError
        Other dims or sizes, or an area that is negative.
    """
    if areas is None:
        return None
    instance_of("areas", areas, xr.DataArray, "a DataArray with dims cell, layer and sector")
    wanted = tuple(str(name) for name in values.dims if name != "channel")
    if {*areas.dims} != {*wanted}:
        raise PopulationError(
            f"areas has the dims {', '.join(map(str, areas.dims))}: it needs {', '.join(wanted)}"
        )
    found = areas.transpose(*wanted)
    sizes = tuple(values.sizes[name] for name in wanted)
    if found.shape != sizes:
        raise PopulationError(f"areas is of shape {found.shape}, values are of {sizes}")
    if bool(((found < 0) | np.isinf(found)).any()):
        raise PopulationError("areas has a window with less than 0, or an infinite one")
    return found


def checked_scalars(scalars: Sequence[str], cells: pd.DataFrame) -> tuple[str, ...]:
    """Names of numeric columns of the table.

    Raises
    ------
    PopulationError
        A column is missing, stands twice, or holds no numbers.
    """
    if isinstance(scalars, str):
        raise PopulationError(f"scalars must be a list of names, got {scalars!r}: write [{scalars!r}]")
    for name in scalars:
        if name not in cells:
            raise PopulationError(
                f"scalars: cells has no column {name!r}: it has {', '.join(map(str, cells))}"
            )
        if not pd.api.types.is_numeric_dtype(cells[name]) or pd.api.types.is_bool_dtype(cells[name]):
            raise PopulationError(
                f"scalars: column {name!r} holds {cells[name].dtype}, no numbers: leave it out"
            )
        if np.isinf(cells[name].to_numpy(dtype=np.float64, na_value=np.nan)).any():
            raise PopulationError(
                f"scalars: column {name!r} has infinite numbers: write NaN where there is none"
            )
    if len(set(scalars)) < len(scalars):
        raise PopulationError(f"scalars: a name stands twice in {', '.join(scalars)}")
    return tuple(scalars)
