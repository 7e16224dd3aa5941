"""The tables of a comparison: windows, clusters, scalars, and the numbers that results are about."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from numpy.typing import NDArray

from cytodisk.arrays import FloatArray
from cytodisk.population.conditions.window_words import lags_of, runs_of
from cytodisk.population.exchange.exchange_test import ExchangeTest
from cytodisk.population.population import Population
from cytodisk.population.ratios import known_mean
from cytodisk.population.significance import LEVEL

CLUSTER_COLUMNS = (
    "cluster",
    "channel",
    "sign",
    "mass",
    "p",
    "n_windows",
    "layers",
    "sectors",
    "difference",
)
LEVELS = {"control", "treated", "difference", "difference_low", "difference_high"}
"""Columns with the unit of the values."""
_FEW = "too few units have a value"
_MOST_RESULTS = 5  # of a kind, that are looked at without one experiment at a time


def window_dataset(
    pop: Population, channels: Sequence[str], effects: Mapping[str, FloatArray], tested: ExchangeTest
) -> xr.Dataset:
    """Effects and p-values of windows, with dims (channel, layer, last).

    Parameters
    ----------
    pop : Population
    channels : sequence of str
    effects : dict of str to ndarray of shape (windows,)
    tested : ExchangeTest

    Returns
    -------
    Dataset
    """
    shape = (len(channels), *pop.raw.shape[2:])
    arrays: dict[str, NDArray[Any]] = {
        **effects,
        "score": tested.scores,
        "p": tested.p,
        "p_fwer": tested.p_fwer,
        "q": tested.q,
    }
    arrays["cluster"] = tested.labels
    arrays["status"] = np.where(np.isfinite(tested.p), "ok", _FEW)
    coords = {
        name: pop.raw.coords[name]
        for name in pop.raw.coords
        if not {"cell", "channel"} & {*pop.raw.coords[name].dims} and name != "channel"
    }
    found = xr.Dataset(
        {name: (pop.raw.dims[1:], array.reshape(shape)) for name, array in arrays.items()},
        coords | {"channel": list(channels)},
    )
    for name in LEVELS & {*found}:
        found[name].attrs["units"] = pop.units
    for name in (name for name in effects if name.startswith("n_")):
        found[name] = found[name].astype(np.int64)
    return found


def cluster_table(
    pop: Population, channels: Sequence[str], difference: FloatArray, tested: ExchangeTest
) -> pd.DataFrame:
    """One row for each cluster of windows, the largest mass first.

    Parameters
    ----------
    pop : Population
    channels : sequence of str
    difference : ndarray of shape (windows,) and dtype float64
    tested : ExchangeTest

    Returns
    -------
    DataFrame
    """
    shape = (len(channels), *pop.raw.shape[2:])
    lags = pop.raw["lag"] if pop.last == "lag" else None
    unit = "" if lags is None else str(lags.attrs.get("units", ""))
    rows = []
    for number, (mass, p) in enumerate(zip(tested.masses, tested.cluster_p, strict=True), 1):
        inside = tested.labels == number
        channel, layers, sectors = np.unravel_index(np.flatnonzero(inside), shape)
        rows.append(
            (
                number,
                channels[int(channel[0])],
                int(np.sign(tested.scores[inside][0])),
                float(mass),
                float(p),
                int(inside.sum()),
                runs_of(layers),
                runs_of(sectors, shape[2]) if lags is None else lags_of(sectors, lags.values, unit),
                float(difference[inside].mean()),
            )
        )
    return pd.DataFrame(rows, columns=list(CLUSTER_COLUMNS))


def scalar_rows(
    scalars: pd.DataFrame, effects: Mapping[str, FloatArray], tested: ExchangeTest
) -> pd.DataFrame:
    """One row for each scalar with its effects and p-values.

    Parameters
    ----------
    scalars : DataFrame
        Columns scalar, channel, what.
    effects : dict of str to ndarray of shape (scalars,)
    tested : ExchangeTest

    Returns
    -------
    DataFrame
    """
    numbers = {**effects, "p": tested.p, "p_fwer": tested.p_fwer, "q": tested.q}
    table = scalars.assign(**numbers)
    table["status"] = np.where(np.isfinite(tested.p), "ok", _FEW)
    return table.astype({name: np.int64 for name in effects if name.startswith("n_")})


def numbers_of_results(
    values: FloatArray, windows: xr.Dataset, clusters: pd.DataFrame, scalars: FloatArray, rows: pd.DataFrame
) -> dict[str, tuple[FloatArray, bool]]:
    """The number of each unit that a result is about, and whether the result is called different.

    These are clusters and scalars at p ≤ 0.05 and all windows at p ≤ 0.05 together; where there is none, the
    strongest window and the strongest scalar.

    Parameters
    ----------
    values : ndarray of shape (units, windows) and dtype float64
    windows : Dataset
    clusters : DataFrame
    scalars : ndarray of shape (units, scalars) and dtype float64
    rows : DataFrame
        Of the scalars.

    Returns
    -------
    dict of str to (ndarray of shape (units,), bool)
    """
    found: dict[str, tuple[FloatArray, bool]] = {}
    labels, p_fwer, score = (windows[name].values.ravel() for name in ("cluster", "p_fwer", "score"))
    for sign, words in ((1, "raised"), (-1, "lowered")):
        inside = (p_fwer <= LEVEL) & (np.sign(score) == sign)
        if inside.any():
            found[f"{words} windows"] = known_mean(values[:, inside], 1), True
    for row in clusters[clusters["p"] <= LEVEL].head(_MOST_RESULTS).itertuples():
        found[f"cluster {row.cluster}"] = known_mean(values[:, labels == row.cluster], 1), True
    if not found and np.isfinite(score).any():
        best = int(np.nanargmax(np.abs(score)))
        channel, layer, last = np.unravel_index(best, windows["score"].shape)
        name = f"strongest window (layer {layer}, {windows['score'].dims[-1]} {last})"
        if windows.sizes["channel"] > 1:
            name = f"{windows['channel'].values[channel]}, {name}"
        found[name] = values[:, best], False
    significant = rows[rows["p_fwer"] <= LEVEL]
    shown = significant if len(significant) else rows[rows["status"] == "ok"]
    for at in shown.sort_values("p_fwer", kind="stable").head(_MOST_RESULTS if len(significant) else 1).index:
        found[str(rows.at[at, "scalar"])] = scalars[:, int(at)], bool(len(significant))
    return found
