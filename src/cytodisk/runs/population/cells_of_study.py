"""The table of cells of a population's study: who they are, how they were aligned, their scalars."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import PopulationError
from cytodisk.population.cell_directions import signal_direction
from cytodisk.population.cell_scalars import LAYER, MEAN, scalar_names
from cytodisk.population.population import Population
from cytodisk.store.nuclei.nucleus_columns import NUCLEUS_COLUMNS
from cytodisk.store.nuclei.summary_columns import PLACE_COLUMNS
from cytodisk.store.populations.population_columns import CELL_COLUMNS
from cytodisk.store.populations.population_writing import columns_of
from cytodisk.store.tables import SOURCE_COLUMNS, Column
from cytodisk.store.window_columns import WINDOW_SIZE_COLUMNS

BRIGHTEST_SIDE = "polarity_direction_{}"
"""Column of the direction of a channel's polarity."""

_AS_ALIGNED = "from sector 0 of the population on, in the disk"
_INPUT = "as in the table of cells that it comes from, or in the table of groups"
_KNOWN = (SOURCE_COLUMNS, NUCLEUS_COLUMNS, PLACE_COLUMNS, WINDOW_SIZE_COLUMNS)
_OWN = ("direction", "strength", "shift", "alignment", "distance_to_mean", "left_out")


def cells_of_study(population: Population, left_out: pd.Series[str], scalars: pd.DataFrame) -> pd.DataFrame:
    """One row a cell: the columns of the population, then those that this run adds.

    Parameters
    ----------
    population : Population
        All cells, also those that are left out.
    left_out : Series of str
        Why each is; empty for those that are used.
    scalars : DataFrame
        See `Population.scalar_table`.

    Returns
    -------
    DataFrame
        Without the distance to the mean, see `with_distances`.

    Raises
    ------
    PopulationError
        A column of the population has a name that this table has for something else.
    """
    cells = population.cells.copy(deep=False)
    if clash := [name for name in cells if name in _OWN]:
        raise PopulationError(
            f"groups: column {clash[0]!r} is one that cytodisk population writes itself: rename yours"
        )
    if "cell" not in cells:
        cells["cell"] = [str(number) for number in range(len(cells))]
    if "study" in cells:  # pages look for its maps, from wherever they are made
        cells["study"] = [str(Path(study).absolute()) for study in cells["study"]]
    turned = population.alignment
    cells["direction"] = turned["direction"].to_numpy()
    cells["strength"] = turned["strength"].to_numpy()
    cells["shift"] = turned["shift"].to_numpy().astype(np.float64)
    cells["alignment"] = turned["status"].to_numpy()
    cells["left_out"] = left_out.to_numpy()
    more = scalars.reset_index(drop=True).assign(**_brightest_sides(population))
    new = [name for name in more if name not in cells]
    return pd.concat([cells.reset_index(drop=True), more[new]], axis=1)


def _brightest_sides(population: Population) -> dict[str, FloatArray]:
    """Direction of each channel's first harmonic around the cells, by name of the column."""
    if population.last != "sector":
        return {}
    return {
        BRIGHTEST_SIDE.format(name): signal_direction(population.blocks([name]), len(population))[0]
        for name in population.channels
    }


def with_distances(cells: pd.DataFrame, used: BoolArray, distances: FloatArray) -> pd.DataFrame:
    """The table with the distance to the mean of those cells that are used."""
    found = np.full(len(cells), np.nan)
    found[used] = distances
    return cells.assign(distance_to_mean=found)


def more_columns(cells: pd.DataFrame, population: Population) -> dict[str, Column]:
    """What stands in the table of cells beside the columns of every study.

    Parameters
    ----------
    cells : DataFrame
    population : Population

    Returns
    -------
    dict of str to Column
    """
    units = population.cells.attrs.get("units", {})
    told = {column.name: column.meaning for columns in _KNOWN for column in columns}
    meanings = {str(name): (str(units.get(name, "")), told.get(str(name), _INPUT)) for name in cells}
    of_signal = scalar_names(population.channels, population.compartments, population.last)
    for name, (channel, words) in of_signal.items():
        unit = population.units if name in _layers(channel, population) else "1"
        if name == MEAN.format(channel):
            unit = str(population.raw.attrs.get("units", "a.u."))  # it is not normalised
        meanings[name] = unit, f"signal of {channel}: {words}"
    for channel in population.channels:
        words = f"direction of the brightest side of {channel}, {_AS_ALIGNED}"
        meanings[BRIGHTEST_SIDE.format(channel)] = "°", words
    return columns_of(cells, CELL_COLUMNS, meanings)


def _layers(channel: str, population: Population) -> list[str]:
    return [LAYER.format(layer, channel) for layer in range(len(population.compartments))]
