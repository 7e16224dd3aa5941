"""Numbers of cells by layer as a population."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.population.population import Population

KEYS = ["input", "cell"]


def number_population(
    numbers: pd.DataFrame, cells: pd.DataFrame, channels: Sequence[str], value: str
) -> Population | None:
    """Numbers by channel and layer, a row for each cell.

    Parameters
    ----------
    numbers : DataFrame
        input, cell, channel, layer, and the column of values.
    cells : DataFrame
        input, cell, condition and experiment; those of other cells are left out.
    channels : sequence of str
        In their order.
    value : str
        Name of the column; NaN for none.

    Returns
    -------
    Population or None
        With one sector, which is the whole layer, of those cells that have a number; None where none has.
    """
    known = numbers[numbers[value].notna() & numbers["channel"].isin(channels)]
    both = known.merge(cells.reset_index(drop=True).reset_index(names="row"), on=KEYS)
    if both.empty:
        return None
    rows, at = np.unique(both["row"], return_inverse=True)
    layers, layer = np.unique(both["layer"], return_inverse=True)
    shown = [name for name in channels if name in set(both["channel"])]
    values = np.full((len(rows), len(shown), len(layers), 1), np.nan)
    channel = both["channel"].map({name: k for k, name in enumerate(shown)})
    values[at, channel, layer, 0] = both[value].to_numpy(np.float64)
    array = xr.DataArray(
        values,
        dims=("cell", "channel", "layer", "sector"),
        coords={"channel": shown, "layer": layers, "sector": [0]},
        attrs={"units": "1"},
    )
    table = cells.iloc[rows].reset_index(drop=True)
    names = table["input"].astype(str) + ", cell " + table["cell"].astype(str)
    return Population(array, table.assign(number=table["cell"], cell=names))
