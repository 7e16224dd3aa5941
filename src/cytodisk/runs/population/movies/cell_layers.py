"""Values by layer as those of windows, and why a cell has none."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr


def as_windows(values: xr.DataArray, activity: xr.Dataset) -> xr.DataArray:
    """Values by channel and layer, the same in all sectors of a layer.

    Parameters
    ----------
    values : DataArray with dims (channel, layer)
    activity : Dataset
        Of the cell, which tells its layers and sectors.

    Returns
    -------
    DataArray with dims (channel, layer, sector)
        NaN in layers without a value.
    """
    layers, sectors = activity["layer"].to_numpy(), activity["sector"].to_numpy()
    found = values.reindex(layer=layers).expand_dims(sector=sectors).transpose("channel", "layer", "sector")
    if "compartment" in activity:
        names = activity["compartment"].to_numpy().astype(object)
        found = found.assign_coords(compartment=("layer", names))
    return found.copy(data=np.array(found.to_numpy(), dtype=np.float64))


def reason_of(cells: pd.DataFrame, cell: int) -> str:
    """Why a cell has no rows, from the table of cells of what was computed.

    Parameters
    ----------
    cells : DataFrame
        cell and reason.
    cell : int
    """
    rows = cells[cells["cell"] == cell]
    return "the command was asked for other cells" if rows.empty else str(rows["reason"].iloc[0])
