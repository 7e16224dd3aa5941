"""Means of the units of a comparison, in windows and in scalars."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.population.cell_scalars import scalar_names
from cytodisk.population.group_means import group_sums
from cytodisk.population.population import Population


def usable_cells(pop: Population, channels: Sequence[str]) -> BoolArray:
    """Cells that have a value in one of the channels, or of a scalar where there are no windows.

    Parameters
    ----------
    pop : Population
    channels : sequence of str

    Returns
    -------
    ndarray of shape (cells,) and dtype bool
    """
    if not channels:
        numbers = pop.cells[list(pop.scalars)].to_numpy(dtype=np.float64, na_value=np.nan)
        return np.asarray(np.isfinite(numbers).any(axis=1))
    usable = np.zeros(len(pop), dtype=np.bool_)
    for rows, block in pop.blocks(channels):
        usable[rows] = np.isfinite(block).any(axis=(1, 2, 3))
    return usable


def window_means(pop: Population, channels: Sequence[str], codes: IntArray, units: int) -> FloatArray:
    """Mean of each unit's cells in each window: (units, channels × layers × last).

    Parameters
    ----------
    pop : Population
    channels : sequence of str
    codes : ndarray of shape (cells,) and dtype int64
        Unit of each cell, -1 for none.
    units : int

    Returns
    -------
    ndarray of dtype float64
        NaN where no cell of the unit has a value.
    """
    shape = (len(channels), *pop.raw.shape[2:])
    if units < int((codes >= 0).sum()):
        return group_sums(pop.blocks(channels), codes, units, shape).mean.reshape(units, -1)
    found = np.empty((units, int(np.prod(shape))))  # each cell is a unit
    for rows, block in pop.blocks(channels):
        code = codes[rows]
        used = code >= 0
        found[code[used]] = block[used].reshape(int(used.sum()), found.shape[1])
    return found


@dataclass(frozen=True, eq=False)
class UnitScalars:
    """Scalars of units.

    Attributes
    ----------
    values : ndarray of shape (units, scalars) and dtype float64
    table : DataFrame
        A row for each scalar: scalar, channel, what.
    """

    values: FloatArray
    table: pd.DataFrame


def scalar_means(pop: Population, channels: Sequence[str], codes: IntArray, units: int) -> UnitScalars:
    """Mean of each unit's cells in each scalar that follows from the channels, and in the named columns.

    Parameters
    ----------
    pop : Population
    channels : sequence of str
    codes : ndarray of shape (cells,) and dtype int64
    units : int

    Returns
    -------
    UnitScalars
    """
    made = scalar_names(channels, pop.compartments, pop.last)
    named = [name for name in pop.scalars if name not in made]
    rows = [(name, channel, what) for name, (channel, what) in made.items()]
    rows += [(name, "", "column of the cells") for name in named]
    table = pd.DataFrame(rows, columns=["scalar", "channel", "what"])
    numbers = pop.scalar_table()[list(table["scalar"])].to_numpy(dtype=np.float64)
    sums = group_sums(iter([(slice(0, len(pop)), numbers)]), codes, units, (len(table),))
    return UnitScalars(sums.mean, table)
