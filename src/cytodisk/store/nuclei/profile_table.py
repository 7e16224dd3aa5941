"""The profile from membrane to nucleus, out of a study's table of windows."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd

from cytodisk.analysis.compartments.layer_sums import area_mean, group_means, layer_shares
from cytodisk.errors import ReadError

_KEYS = ["cell", "frame", "time_s", "channel", "layer", "compartment"]


def profile_table(folder: Path, windows: pd.DataFrame) -> pd.DataFrame:
    """A row for each cell, frame, channel and layer.

    Parameters
    ----------
    folder : Path
        Of the study.
    windows : DataFrame
        Its table of windows, in its order.

    Returns
    -------
    DataFrame
        Columns as the variables of `nuclear_profile`, with units in `attrs["units"]`.

    Raises
    ------
    ReadError
        The study has no nuclei.
    """
    if "compartment" not in windows:
        raise ReadError(f"study {folder} has no nuclei: make it again with --nuclei")
    layers, sectors = (int(windows[name].max()) + 1 if len(windows) else 1 for name in ("layer", "sector"))
    column = {
        name: windows[name].to_numpy(dtype=np.float64).reshape(-1, sectors)
        for name in ("mean", "n_pixels", "area", "depth", "nucleus_distance")
    }
    table = windows[_KEYS].iloc[::sectors].reset_index(drop=True)
    found = group_means(column["mean"], column["n_pixels"])
    area = np.nansum(column["area"], axis=1)
    nuclear = table["compartment"].to_numpy() == "nucleus"
    share = layer_shares(area.reshape(-1, layers), nuclear.reshape(-1, layers)).ravel()
    table = table.assign(mean=found.mean, sd=found.sd, n_windows=found.number, area=area, share=share)
    table = table.assign(
        **{name: area_mean(column[name], column["area"]) for name in ("depth", "nucleus_distance")}
    )
    units = windows.attrs["units"] | {"n_windows": "1", "share": "1"}
    table.attrs["units"] = {str(name): units[name] for name in table}
    return table
