"""Tables of a correlation, with their units."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.correlation.cross_correlation import correlation_by_layer
from cytodisk.analysis.correlation.peaks import peak_correlation
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.correlate.partial_correlation import Partial, curves_of, with_curve, with_partial

_OF_CHANCE = ("null", "threshold", "mean_null", "mean_threshold", "cluster_null", "cluster_spread")


def tables_of(
    correlations: xr.Dataset, options: CorrelateParameters, partial: Partial | None = None
) -> dict[str, pd.DataFrame]:
    """Peaks and curves of windows and of layers, as tables windows, layers, curves and layer_curves.

    Parameters
    ----------
    correlations : Dataset
        Of `cross_correlate`.
    options : CorrelateParameters
    partial : Partial, optional
        The same without controls; None if nothing was to be regressed out.
    """
    by_layer = correlation_by_layer(correlations)
    peaks = peak_correlation(correlations, rule=options.rule)
    layers = peak_correlation(by_layer, rule=options.rule)
    if "threshold" in by_layer:
        layers = layers.assign(threshold=by_layer["threshold"])
        peaks = peaks.assign(threshold=correlations["threshold"])
    if partial is not None:
        without, without_by_layer = curves_of(partial.correlations)
        peaks = with_partial(peaks, without, options)
        layers = with_partial(layers, without_by_layer, options)
        correlations = with_curve(correlations, without)
        by_layer = with_curve(by_layer, without_by_layer)
    curves = correlations.drop_vars(_OF_CHANCE, errors="ignore")
    mean = by_layer.drop_vars("null", errors="ignore")
    return {
        "windows": as_table(peaks, ("layer", "sector")),
        "layers": as_table(layers, ("layer",)),
        "curves": as_table(curves, ("layer", "sector", "lag")),
        "layer_curves": as_table(mean, ("layer", "lag")),
    }


def as_table(dataset: xr.Dataset, index: tuple[str, ...]) -> pd.DataFrame:
    """A Dataset as a table with its units; seconds of lags are a column, NaN when unknown."""
    table = dataset.reset_coords(drop=False).to_dataframe(dim_order=list(index)).reset_index()
    if "lag_s" not in table:
        table.insert(list(table.columns).index("lag") + 1, "lag_s", np.nan)
    units = {"lag": "frame", "lag_s": "s", "lag_partial": "frame"}
    known = {name: str(values.attrs.get("units", "1")) for name, values in dataset.variables.items()}
    plain = dict.fromkeys(("layer", "sector", "along", "n", "n_effective", "geometry"), "")
    table.attrs = {"units": {name: (known | units | plain).get(name, "1") for name in table.columns}}
    return table


def of_cell(table: pd.DataFrame, cell: int) -> pd.DataFrame:
    """The table with the number of its cell as first column."""
    units = table.attrs["units"]
    table = table.copy()
    table.insert(0, "cell", cell)
    table.attrs = {"units": {"cell": ""} | units}
    return table


def merged(parts: list[pd.DataFrame]) -> pd.DataFrame:
    """Tables of several cells under each other."""
    units = parts[0].attrs["units"]
    for part in parts:
        part.attrs = {}  # pandas compares them one by one, which arrays do not survive
    table = pd.concat(parts, ignore_index=True)
    table.attrs = {"units": units}
    return table
