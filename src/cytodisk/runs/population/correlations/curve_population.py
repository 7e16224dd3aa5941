"""Correlation curves of many cells as a population: Fisher's z by layer and lag."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.population.population import Population

CURVES = {"raw": "correlation", "partial": "correlation_partial"}
"""Kinds of curve, and their column: as measured, and with controls such as geometry regressed out."""

_LARGEST = 1.0 - 1e-9  # r = 1, of a signal with itself, would be infinite


def curve_population(curves: pd.DataFrame, cells: pd.DataFrame, kind: str, signal: str) -> Population | None:
    """Curves of one kind, a row for each cell.

    Parameters
    ----------
    curves : DataFrame
        input, cell, layer, lag, lag_s and the columns of `CURVES`.
    cells : DataFrame
        input, cell, condition and experiment.
    kind : {"raw", "partial"}
    signal : str
        Name of the channel.

    Returns
    -------
    Population or None
        Of those cells that have a curve of this kind; None where none has.
    """
    known = curves[curves[CURVES[kind]].notna()]
    if known.empty:
        return None
    both = known.merge(cells.reset_index(names="row"), on=["input", "cell"])
    rows, at = np.unique(both["row"], return_inverse=True)
    layers, layer = np.unique(both["layer"], return_inverse=True)
    lags = np.arange(curves["lag"].min(), curves["lag"].max() + 1)
    values = np.full((len(rows), 1, len(layers), len(lags)), np.nan)
    values[at, 0, layer, both["lag"] - lags[0]] = fisher(both[CURVES[kind]].to_numpy(np.float64))
    array = xr.DataArray(
        values,
        dims=("cell", "channel", "layer", "lag"),
        coords={"channel": [signal], "layer": layers, "lag": lags},
        attrs={"units": "1"},
    )
    table = cells.loc[rows].reset_index(drop=True)
    names = table["input"].astype(str) + ", cell " + table["cell"].astype(str)
    return Population(array, table.assign(number=table["cell"], cell=names))


def fisher(correlation: FloatArray) -> FloatArray:
    """Fisher's z of correlations: spread alike for large and small ones."""
    return np.asarray(np.arctanh(np.clip(correlation, -_LARGEST, _LARGEST)))


def seconds_of(curves: pd.DataFrame) -> pd.Series:
    """Seconds of each lag in frames; NaN where they are unknown."""
    return curves.groupby("lag")["lag_s"].first()
