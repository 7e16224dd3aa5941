"""How far each cell is from the mean of its condition, and the cells that are nearest and farthest."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.population.population import Population
from cytodisk.population.ratios import known_mean
from cytodisk.store.populations.window_arrays import window_rows

SHOWN = 4
"""Cells of each condition that are nearest to its mean, and as many that are farthest."""


def distances_to_mean(population: Population, atlas: xr.Dataset) -> FloatArray:
    """Distance of each cell to the mean of its condition.

    Parameters
    ----------
    population : Population
        All its cells have a condition of the atlas.
    atlas : Dataset
        See `Population.atlas`.

    Returns
    -------
    ndarray of shape (cells,) and dtype float
        Root mean square over windows, each in standard deviations over cells; NaN for a cell without values,
        and where all cells of a condition are alike.
    """
    order = {name: place for place, name in enumerate(atlas[CONDITION].values)}
    at = population.cells[CONDITION].map(order).to_numpy(np.int64)
    mean, sd = atlas["mean"].values, atlas["sd"].values
    sd = np.where(sd > 0, sd, np.nan)
    found = np.full(len(population), np.nan)
    for rows, block in population.blocks():
        away = (block - mean[at[rows]]) / sd[at[rows]]
        found[rows] = np.sqrt(known_mean(away**2, (1, 2, 3)))
    return found


def gallery(population: Population, distances: FloatArray) -> pd.DataFrame:
    """The windows of the cells nearest to the mean of their condition, and farthest from it.

    Parameters
    ----------
    population : Population
    distances : ndarray of shape (cells,) and dtype float

    Returns
    -------
    DataFrame
        As the table gallery; `row` counts the cells of this population.
    """
    cells = population.cells
    picked = []
    for condition in population.conditions:
        own = np.flatnonzero((cells[CONDITION] == condition).to_numpy() & np.isfinite(distances))
        ranked = own[np.argsort(distances[own], kind="stable")]
        nearest = ranked[: min(SHOWN, -(-len(ranked) // 2))]
        farthest = ranked[len(nearest) :][::-1][:SHOWN]
        picked += [(int(row), "nearest", rank + 1) for rank, row in enumerate(nearest)]
        picked += [(int(row), "farthest", rank + 1) for rank, row in enumerate(farthest)]
    parts = [_windows_of(population, *one) for one in picked]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def _windows_of(population: Population, row: int, place: str, rank: int) -> pd.DataFrame:
    one = np.zeros(len(population), dtype=bool)
    one[row] = True
    values = population.select(one).values[0]
    values = values.drop_vars([name for name in values.coords if "cell" in values.coords[name].dims])
    rows = window_rows(values.drop_vars("cell", errors="ignore").to_dataset(name="value"))
    cell = population.cells.iloc[row]
    told = {"row": row, "place": place, "rank": rank, CONDITION: cell[CONDITION], "cell": str(cell["cell"])}
    return rows.assign(**told, **{EXPERIMENT: cell[EXPERIMENT]})
