"""The atlas: mean and spread of many cells' windows, by condition."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.errors import PopulationError
from cytodisk.population.group_columns import EXPERIMENT, codes_of, names_in
from cytodisk.population.group_means import GroupSums, group_sums
from cytodisk.population.ratios import ratio


def atlas_of(
    by: str,
    cells: pd.DataFrame,
    raw: xr.DataArray,
    blocks: Callable[[], Iterator[tuple[slice, FloatArray]]],
    units: str,
) -> xr.Dataset:
    """Mean, sd, sem and counts of windows for each name in a column.

    Parameters
    ----------
    by : str
    cells : DataFrame
    raw : DataArray with dims (cell, channel, layer, last)
    blocks : callable
        See `Population.blocks`.
    units : str
        Of the values in the blocks.

    Returns
    -------
    Dataset

    Raises
    ------
    PopulationError
        There is no such column, or it is empty.
    """
    if by not in cells:
        raise PopulationError(
            f"atlas: cells has no column {by!r}: add it to the table, as with --groups; it has "
            f"{', '.join(map(str, cells))}"
        )
    codes, names = codes_of(names_in(cells, by))
    if not names:
        raise PopulationError(f"atlas: column {by!r} of cells is empty")
    shape = raw.shape[1:]
    by_cell = group_sums(blocks(), codes, len(names), shape)
    mean = by_cell.mean
    squares = group_sums(blocks(), codes, len(names), shape, centre=mean)
    sd = _root(squares.total, by_cell.count - 1)
    experiments, n_experiments, sem = _over_experiments(cells, codes, len(names), shape, blocks)
    mean = np.where(n_experiments > 0, experiments, mean)
    dims = (by, *raw.dims[1:])
    arrays = {"mean": mean, "sd": sd, "sem": sem, "n_cells": by_cell.count.astype(np.int64)}
    arrays["n_experiments"] = n_experiments
    coords = {name: raw.coords[name] for name in raw.coords if "cell" not in raw.coords[name].dims}
    found = xr.Dataset({name: (dims, array) for name, array in arrays.items()}, coords | {by: list(names)})
    for name in ("mean", "sd", "sem"):
        found[name].attrs["units"] = units
    return found


def _root(total: FloatArray, degrees: FloatArray) -> FloatArray:
    root: FloatArray = np.sqrt(ratio(total, degrees, degrees > 0))
    return root


def _over_experiments(
    cells: pd.DataFrame,
    codes: np.ndarray,
    groups: int,
    shape: tuple[int, ...],
    blocks: Callable[[], Iterator[tuple[slice, FloatArray]]],
) -> tuple[FloatArray, np.ndarray, FloatArray]:
    """Mean of the experiments' means, their number, and the standard error over them.

    All are of no experiment in a group some of whose cells have none.
    """
    nothing = np.full((groups, *shape), np.nan), np.zeros((groups, *shape), dtype=np.int64)
    experiment, names = codes_of(names_in(cells, EXPERIMENT))
    known = np.bincount(codes[(codes >= 0) & (experiment < 0)], minlength=groups) == 0
    if not names or not known.any():
        return (*nothing, nothing[0])
    both = np.where((codes >= 0) & (experiment >= 0), codes * len(names) + experiment, -1)
    present, unit = np.unique(both[both >= 0], return_inverse=True)
    units = np.full(len(both), -1, dtype=np.int64)
    units[both >= 0] = unit
    means = group_sums(blocks(), units, len(present), shape).mean
    of_group = present // len(names)
    one_by_one = iter([(slice(0, len(present)), means)])
    sums = group_sums(one_by_one, of_group, groups, shape)
    mean = sums.mean
    squares: GroupSums = group_sums(
        iter([(slice(0, len(present)), means)]), of_group, groups, shape, centre=mean
    )
    sem = _root(squares.total, sums.count - 1) / np.sqrt(np.maximum(sums.count, 1))
    mean[~known], sem[~known] = np.nan, np.nan
    return mean, np.where(known[:, None, None, None], sums.count, 0).astype(np.int64), sem
