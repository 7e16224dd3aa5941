"""Tables with a row a window as arrays, and back."""

from __future__ import annotations

import pandas as pd
import xarray as xr

_AXES = ("channel", "layer", "sector", "lag")


def window_arrays(table: pd.DataFrame, *outer: str) -> xr.Dataset:
    """A table with a row for each window as arrays.

    Parameters
    ----------
    table : DataFrame
        Each combination of its keys once.
    *outer : str
        More keys, before the channel.

    Returns
    -------
    Dataset with dims (*outer, channel, layer, sector), or lag in the place of sector
        Other texts than the status are left out. A compartment is a coordinate of layers; units are in the
        attrs of each variable.
    """
    axes = [name for name in (*outer, *_AXES) if name in table]
    layers = table.drop_duplicates("layer").set_index("layer").sort_index()
    kept = [
        name
        for name in table.columns
        if name not in (*axes, "compartment") and (name == "status" or table[name].dtype.kind in "ifb")
    ]
    found = xr.Dataset.from_dataframe(table.set_index(axes)[kept])
    orders = {
        name: list(dict.fromkeys(table[name])) for name in axes if name not in ("layer", "sector", "lag")
    }
    found = found.reindex(orders)  # as in the table, not sorted by name
    if "compartment" in table:
        found = found.assign_coords(compartment=("layer", layers["compartment"].to_numpy(dtype=object)))
    units = table.attrs.get("units", {})
    for name in kept:
        found[name].attrs["units"] = units.get(name, "")
    return found


def window_rows(found: xr.Dataset) -> pd.DataFrame:
    """Arrays over windows as a table with a row for each, in the order of their dims.

    Parameters
    ----------
    found : Dataset
        All variables have all dims, or those of layers alone.

    Returns
    -------
    DataFrame
        Coordinates first; what is given by layer is repeated.
    """
    dims = [str(name) for name in found.sizes]
    rows = found.reset_coords().to_dataframe(dim_order=dims).reset_index()
    for name in rows.columns:
        if not pd.api.types.is_numeric_dtype(rows[name]):
            rows[name] = rows[name].astype(object).fillna("")
    return rows
