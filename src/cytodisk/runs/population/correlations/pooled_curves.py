"""Pool curves over experiments, and test them against 0 and between conditions."""

from __future__ import annotations

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.population.group_columns import CONDITION
from cytodisk.runs.population.correlations.curve_population import CURVES, curve_population, seconds_of
from cytodisk.runs.population.correlations.peak_words import (
    difference_sentences,
    peak_sentences,
    strongest,
)
from cytodisk.runs.population.pooling.pool_parameters import PoolParameters
from cytodisk.runs.population.pooling.pooled_population import TABLES, Pool, Pooled

_PLACE = ("layer", "lag")


def pool_curves(
    curves: pd.DataFrame, cells: pd.DataFrame, names: tuple[str, str], options: PoolParameters
) -> Pooled:
    """Mean curve of each condition over experiments, with its interval, and what chance would give.

    Parameters
    ----------
    curves : DataFrame
        See `curve_population`.
    cells : DataFrame
        input, cell, condition and experiment of the cells that have curves.
    names : (str, str)
        Signal, and what it was correlated with.
    options : PoolParameters

    Returns
    -------
    Pooled
        An experiment counts once, whatever the number of its cells: its curve is the mean of theirs, and the
        condition's the mean of the experiments'. Means are of Fisher's z; correlations are turned back.
        Where experiments are unknown there is no interval and no test.

    Raises
    ------
    PopulationError
        A condition to compare is not there.
    """
    found = Pooled()
    parts: dict[str, list[pd.DataFrame]] = {name: [] for name in TABLES}
    for kind in CURVES:
        population = curve_population(curves, cells, kind, names[0])
        if population is None:
            continue
        one = Pool(population, options.compare, options, _PLACE, "correlation", _turned_back).pooled()
        if kind == "raw":  # the others have the same cells, or fewer
            found.sentences += one.sentences
        found.warnings += [warning | {"curve": kind} for warning in one.warnings]
        for name, table in one.tables.items():
            if len(table):
                parts[name].append(table.assign(curve=kind))
    seconds = seconds_of(curves)
    for name, tables in parts.items():
        joined = pd.concat(tables, ignore_index=True) if tables else pd.DataFrame()
        found.tables[name] = joined.assign(lag_s=joined["lag"].map(seconds)) if len(joined) else joined
    found.tables["peaks"] = peaks_of(found.tables["pooled"])
    found.sentences += peak_sentences(found.tables["pooled"], names)
    found.sentences += difference_sentences(found.tables["comparisons"])
    return found


def _turned_back(z: xr.DataArray) -> xr.DataArray:
    """Correlations of Fisher's z."""
    return z.copy(data=np.tanh(z.to_numpy()))


def peaks_of(pooled: pd.DataFrame) -> pd.DataFrame:
    """The peak of each condition, kind of curve and layer.

    Parameters
    ----------
    pooled : DataFrame

    Returns
    -------
    DataFrame
        Of the lags with p_fwer up to 0.05 that with the largest mean correlation, of all lags where none has.
    """
    if pooled.empty:
        return pooled
    groups = pooled.groupby([CONDITION, "curve", "layer"], sort=False)
    rows = [row for _, group in groups if (row := strongest(group)) is not None]
    return pd.DataFrame(rows).reset_index(drop=True)
