"""`population_from_tables`: a table of windows that a user has → `Population`."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import PopulationError
from cytodisk.images.short_lists import shortened
from cytodisk.parameter_words import short_words
from cytodisk.population.population import Population
from cytodisk.runs.population.opening.chosen_scalars import chosen_scalars

_MOST_SIDE = 100_000  # layers or sectors
_MOST_VALUES = 2_000_000_000


def population_from_tables(
    windows: pd.DataFrame,
    cells: pd.DataFrame,
    *,
    value: str = "mean",
    scalars: Sequence[str] = (),
) -> Population:
    """A population from a long table of windows and a table of cells.

    Parameters
    ----------
    windows : DataFrame
        A row a window: `cell` (as in cells), `layer` and `sector` (whole numbers from 0), the value, and
        `channel` where there are several; `area` is the weight of the window within its cell. Rows may be in
        any order. A window without a row has no value.
    cells : DataFrame
        A row a cell: `cell`, each once, `condition`, `experiment` and others; see `Population`.
    value : str
        Column of windows to take.
    scalars : sequence of str
        Columns of cells that are compared beside the windows.

    Returns
    -------
    Population
        In the order of cells.

    Raises
    ------
    PopulationError
        A column is missing, a cell or a window stands twice, or a cell is in one table alone.

    See Also
    --------
    open_population : Reads studies.

    Examples
    --------
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> windows = pd.DataFrame({"cell": list("aabb"), "layer": 0, "sector": [0, 1] * 2})
    >>> windows["mean"] = [1.0, 2.0, 3.0, 4.0]
    >>> cells = pd.DataFrame({"cell": ["a", "b"], "condition": ["control", "drug"], "experiment": [1, 1]})
    >>> cd.population_from_tables(windows, cells).values.values.tolist()
    [[[[1.0, 2.0]]], [[[3.0, 4.0]]]]
    """
    _needed(windows, "windows", "cell", "layer", "sector", value)
    _needed(cells, "cells", "cell")
    row = _places(windows["cell"], cells["cell"])
    layer, sector = (_whole(windows[name], name) for name in ("layer", "sector"))
    names, channel = _channels(windows, value)
    shape = len(cells), len(names), int(layer.max()) + 1, int(sector.max()) + 1
    if np.prod(shape, dtype=float) > _MOST_VALUES:
        raise PopulationError(
            f"windows: {' × '.join(map(str, shape))} values are more than memory holds: check its columns"
        )
    at = np.ravel_multi_index((row, channel, layer, sector), shape)
    _refuse_twice(at, windows)
    numbers = _numbers(windows, value)
    values = np.full(np.prod(shape), np.nan)
    values[at] = numbers
    dims = ("cell", "channel", "layer", "sector")
    found = xr.DataArray(values.reshape(shape), dims=dims, coords={"channel": names}, name=value)
    areas = None
    if "area" in windows:
        weights = np.zeros((shape[0], *shape[2:]))
        weights[row, layer, sector] = np.nan_to_num(_numbers(windows, "area"))
        areas = xr.DataArray(weights, dims=("cell", "layer", "sector"))
    return Population(found, cells, areas=areas, scalars=chosen_scalars(cells, names, scalars))


def _needed(table: Any, what: str, *names: str) -> None:
    if not isinstance(table, pd.DataFrame):
        raise PopulationError(f"{what} must be a DataFrame, got {type(table).__name__}")
    for name in names:
        if name not in table:
            there = shortened([str(one) for one in table])
            raise PopulationError(f"{what} has no column {name!r}: it has {there}")
    if not len(table):
        raise PopulationError(f"{what} has no rows: pass the table of some cells")


def _places(of_windows: pd.Series[Any], of_cells: pd.Series[Any]) -> IntArray:
    """Row of its cell for each window."""
    if empty := int(of_cells.isna().sum() + of_windows.isna().sum()):
        raise PopulationError(f"column cell is empty in {empty} rows: fill it in")
    if (twice := of_cells[of_cells.duplicated()]).size:
        raise PopulationError(f"cells: cell {_shown(twice.iloc[0])} stands twice: each cell is one row")
    index = pd.Index(of_cells)
    row = index.get_indexer(pd.Index(of_windows))
    if (strange := of_windows[row < 0]).size:
        kinds = (
            ""
            if of_cells.dtype == of_windows.dtype
            else f" ({of_windows.dtype} there, {of_cells.dtype} here)"
        )
        raise PopulationError(
            f"windows has cell {_shown(strange.iloc[0])}, which is not in cells{kinds}: add it there, or "
            "take it out"
        )
    without = of_cells[~np.isin(np.arange(len(of_cells)), row)]
    if len(without):
        raise PopulationError(
            f"cells without windows: {shortened([str(one) for one in without])}: take them out of cells"
        )
    return np.asarray(row, dtype=np.int64)


def _whole(column: pd.Series[Any], name: str) -> IntArray:
    numbers = pd.to_numeric(column, errors="coerce").to_numpy(np.float64)
    wrong = ~((numbers >= 0) & (numbers < _MOST_SIDE) & (numbers == np.floor(numbers)))
    if wrong.any():
        raise PopulationError(
            f"windows: {name} must be a whole number from 0, got {_shown(column[wrong].iloc[0])} in "
            f"{int(wrong.sum())} rows"
        )
    return numbers.astype(np.int64)


def _channels(windows: pd.DataFrame, value: str) -> tuple[list[str], IntArray]:
    if "channel" not in windows:
        return [value], np.zeros(len(windows), dtype=np.int64)
    codes, names = pd.factorize(windows["channel"])
    if (codes < 0).any():
        raise PopulationError(
            f"windows: column channel is empty in {int((codes < 0).sum())} rows: fill it in"
        )
    return [str(name) for name in names], np.asarray(codes, dtype=np.int64)


def _refuse_twice(at: IntArray, windows: pd.DataFrame) -> None:
    order = np.argsort(at, kind="stable")
    twice = np.flatnonzero(np.diff(at[order]) == 0)
    if len(twice):
        row = windows.iloc[int(order[twice[0] + 1])]
        raise PopulationError(
            f"windows: layer {row['layer']}, sector {row['sector']} of cell {_shown(row['cell'])} stands "
            "twice: a row for each window and channel; mean over frames first"
        )


def _numbers(windows: pd.DataFrame, name: str) -> FloatArray:
    column = windows[name]
    if not pd.api.types.is_numeric_dtype(column):
        raise PopulationError(f"windows: column {name!r} holds {column.dtype}, no numbers: write numbers")
    return column.to_numpy(dtype=np.float64, na_value=np.nan)


def _shown(value: Any) -> str:
    """A name of a cell or a number as a user wrote it."""
    return short_words(value.item() if hasattr(value, "item") else value)
