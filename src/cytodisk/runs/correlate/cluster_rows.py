"""Tables of clusters of windows, with their places in words."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.analysis.correlation.clusters import correlation_clusters, p_of_regions
from cytodisk.arrays import IntArray
from cytodisk.runs.correlate.partial_correlation import Partial

_UNITS = {"lag": "frame", "lag_s": "s", "correlation": "1", "mass": "1", "p": "1"}
_NAMES = ("cluster", "lag", "lag_s", "sign", "correlation", "windows", "mass", "p", "layers", "sectors")


def with_clusters(
    tables: dict[str, pd.DataFrame], correlations: xr.Dataset, partial: Partial | None
) -> dict[str, pd.DataFrame]:
    """Tables of a cell with that of its clusters, and the cluster of each window in the table of windows.

    Parameters
    ----------
    tables : dict of str to DataFrame
        Of `tables_of`.
    correlations : Dataset
        Of `cross_correlate`, with clusters or without.
    partial : Partial, optional
        The same without controls; None if nothing was to be regressed out.

    Returns
    -------
    dict of str to DataFrame
        As they were, if there is nothing about clusters.
    """
    if "cluster_null" not in correlations:
        return tables
    clusters = correlation_clusters(correlations)
    windows, units = tables["windows"].copy(), tables["windows"].attrs["units"]
    numbers = _number_of_each(clusters)
    windows["cluster"] = (
        numbers.to_series().reindex(pd.MultiIndex.from_frame(windows[["layer", "sector"]])).to_numpy()
    )
    windows.attrs = {"units": units | {"cluster": ""}}
    table = _table(clusters)
    if partial is not None:
        without = partial.correlations
        p = np.full(len(table), np.nan) if without is None else p_of_regions(clusters, without)
        units = table.attrs["units"]
        table = table.assign(p_partial=p)
        table.attrs = {"units": units | {"p_partial": "1"}}
    return tables | {"windows": windows, "clusters": table}


def _number_of_each(clusters: xr.Dataset) -> xr.DataArray:
    """The cluster of each window, of several that of the largest mass; 0 for none."""
    member = clusters["member"].transpose("cluster", "layer", "sector")
    numbers: IntArray = np.zeros(member.shape[1:], dtype=np.int64)
    for number in clusters["cluster"].to_numpy()[::-1]:
        numbers[member.sel(cluster=number).to_numpy()] = number
    return xr.DataArray(numbers, [member["layer"], member["sector"]], name="cluster")


def _table(clusters: xr.Dataset) -> pd.DataFrame:
    plain = clusters.drop_vars("member").drop_dims(["layer", "sector"]).rename(size="windows")
    table = plain.to_dataframe().reset_index()
    if "lag_s" not in table:
        table["lag_s"] = np.nan
    count = int(clusters.attrs["edge_sectors"])
    for name, whole in (("layer", None), ("sector", count)):
        members = clusters["member"].any({"layer", "sector"} - {name})
        there = [clusters[name].to_numpy()[one] for one in members.to_numpy()]
        table[f"{name}s"] = pd.Series([ranges_in_words(some, whole) for some in there], dtype="string")
    table = table.reindex(columns=list(_NAMES))
    table.attrs = {"units": {name: _UNITS.get(name, "") for name in _NAMES}}
    return table


def ranges_in_words(numbers: Iterable[int], count: int | None = None) -> str:
    """Numbers as ranges: 0–2, 7; with a count around a ring, so that 50–5 goes on over the last.

    Parameters
    ----------
    numbers : iterable of int
    count : int, optional
        Of the ring, after whose last number 0 comes.

    Returns
    -------
    str
        Ranges with commas between.
    """
    there = sorted({int(number) for number in numbers})
    starts = [number for number in there if number - 1 not in there]
    ends = [number for number in there if number + 1 not in there]
    if count is not None and len(starts) > 1 and {0, count - 1} <= set(there):
        starts, ends = starts[1:], ends[1:-1] + ends[:1]  # the last range goes on over 0
    return ", ".join(f"{a}–{b}" if a != b else f"{a}" for a, b in zip(starts, ends, strict=True))
