"""Pool curves over experiments, and test them against 0 and between conditions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.stats import t as student

from cytodisk.errors import PopulationError
from cytodisk.population.conditions.condition_comparison import compare_conditions
from cytodisk.population.conditions.with_control import holm
from cytodisk.population.conditions.with_zero import compare_with_zero
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.population.population import Population
from cytodisk.runs.population.correlations.curve_population import CURVES, curve_population, seconds_of
from cytodisk.runs.population.correlations.peak_words import (
    difference_sentences,
    peak_sentences,
    strongest,
)
from cytodisk.runs.population.correlations.pool_parameters import PoolParameters

_PLACE = ["layer", "lag"]


@dataclass
class Pooled:
    """Tables of pooled curves, and what to say of them.

    Attributes
    ----------
    tables : dict of str to DataFrame
        experiments, pooled, peaks and comparisons.
    sentences : list of str
    warnings : list of dict
        Those of the tests, with the condition they are about.
    """

    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    sentences: list[str] = field(default_factory=list)
    warnings: list[dict[str, Any]] = field(default_factory=list)


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
    parts: dict[str, list[pd.DataFrame]] = {name: [] for name in ("experiments", "pooled", "comparisons")}
    for kind in CURVES:
        population = curve_population(curves, cells, kind, names[0])
        if population is None:
            continue
        one = _OneKind(kind, population, options, found)
        for name, table in one.tables().items():
            parts[name].append(table.assign(curve=kind))
    seconds = seconds_of(curves)
    for name, tables in parts.items():
        joined = pd.concat(tables, ignore_index=True) if tables else pd.DataFrame()
        found.tables[name] = joined.assign(lag_s=joined["lag"].map(seconds)) if len(joined) else joined
    found.tables["peaks"] = peaks_of(found.tables["pooled"])
    found.sentences += peak_sentences(found.tables["pooled"], names)
    found.sentences += difference_sentences(found.tables["comparisons"])
    return found


def conditions_compared(there: Sequence[str], asked: Sequence[str]) -> list[str]:
    """Conditions that are compared, the control first.

    Parameters
    ----------
    there : sequence of str
        All, in their order.
    asked : sequence of str
        By the user; all by default.

    Raises
    ------
    PopulationError
        One that is asked for is not there.
    """
    if missing := [name for name in asked if name not in there]:
        raise PopulationError(
            f"condition {missing[0]!r} is not in the batch: it has {', '.join(map(repr, there))}"
        )
    if asked:
        return list(asked)
    first = next((name for name in there if name.lower() == "control"), there[0])
    return [first, *(name for name in there if name != first)]


@dataclass
class _OneKind:
    """Curves of one kind: raw, or partial."""

    kind: str
    population: Population
    options: PoolParameters
    found: Pooled

    def tables(self) -> dict[str, pd.DataFrame]:
        """The tables, without the column curve."""
        names = self.population.conditions
        control, *others = conditions_compared(names, self.options.compare)
        rest = [name for name in names if name not in (control, *others)]
        pooled = [self._pooled(name) for name in (control, *others, *rest)]
        tables = {"experiments": self._experiments(), "pooled": pd.concat(pooled, ignore_index=True)}
        compared = {other: self._compared(control, other) for other in others}
        return tables | ({"comparisons": _corrected(compared)} if compared else {})

    @property
    def _chance(self) -> dict[str, Any]:
        return {"permutations": self.options.permutations, "seed": self.options.seed}

    def _experiments(self) -> pd.DataFrame:
        """Mean curve of the cells of each experiment."""
        values = self.population.values.isel(channel=0, drop=True)
        cells = self.population.cells[[CONDITION, EXPERIMENT]]
        long = values.to_dataframe("z").reset_index()
        long = long.join(cells, on="cell").dropna(subset="z")
        means = long.groupby([CONDITION, EXPERIMENT, *_PLACE], sort=False)["z"].agg(["mean", "size"])
        table = means.reset_index().rename(columns={"size": "n_cells"})
        return table.assign(correlation=np.tanh(table.pop("mean")))

    def _pooled(self, condition: str) -> pd.DataFrame:
        """Mean over experiments, interval and test against 0 of one condition."""
        own = self.population.select((self.population.cells[CONDITION] == condition).to_numpy())
        atlas = own.atlas().isel(channel=0, drop=True).sel(condition=condition, drop=True)
        reach = _interval(atlas)
        arrays: dict[str, xr.DataArray] = {
            "correlation": _turned_back(atlas["mean"]),
            "low": _turned_back(atlas["mean"] - reach),
            "high": _turned_back(atlas["mean"] + reach),
            "n_cells": atlas["n_cells"],
            "n_experiments": atlas["n_experiments"],
        }
        try:
            tested = compare_with_zero(own, condition, **self._chance)
        except PopulationError as error:
            self._say(f"{condition} is not tested against 0: {error}")
            return _table(arrays).assign(condition=condition)
        self._say(f"{condition} against 0: {tested.sentences[0]}")
        return _table(arrays, tested.windows, tested.smallest_p).assign(condition=condition)

    def _compared(self, control: str, other: str) -> pd.DataFrame:
        """Difference of two conditions in Fisher's z."""
        try:
            tested = compare_conditions(self.population, control, other, **self._chance)
        except PopulationError as error:
            self._say(f"{other} is not compared with {control}: {error}")
            return pd.DataFrame()
        self._say(f"{other} against {control}: {' '.join(tested.sentences[:2])}")
        self.found.warnings += [
            asdict(one) | {"condition": other, "control": control, "curve": self.kind}
            for one in tested.warnings
        ]
        names = ("difference", "difference_low", "difference_high", "n_control", "n_treated")
        arrays = {name: tested.windows[name] for name in names}
        return _table(arrays, tested.windows, tested.smallest_p).assign(condition=other, control=control)

    def _say(self, words: str) -> None:
        """Note a sentence, that on the raw curve alone: the others have the same cells, or fewer."""
        if self.kind == "raw":
            self.found.sentences.append(words)


def _corrected(compared: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Comparisons of several conditions with the control, corrected for their number."""
    tested = {name: table for name, table in compared.items() if len(table)}
    if not tested:
        return pd.DataFrame()
    p_holm = holm({name: table["p_fwer"].to_numpy(np.float64) for name, table in tested.items()})
    parts = [table.assign(p_holm=p_holm[name], comparisons=len(tested)) for name, table in tested.items()]
    return pd.concat(parts, ignore_index=True)


def _turned_back(z: xr.DataArray) -> xr.DataArray:
    """Correlations of Fisher's z."""
    return z.copy(data=np.tanh(z.to_numpy()))


def _interval(atlas: xr.Dataset) -> xr.DataArray:
    """Half of the 95 % interval over experiments; NaN with fewer than two."""
    count = atlas["n_experiments"]
    quantile = student.ppf(0.975, np.maximum(count - 1, 1))
    return (atlas["sem"] * quantile).where(count > 1)


def _table(
    arrays: dict[str, xr.DataArray], windows: xr.Dataset | None = None, smallest_p: float = np.nan
) -> pd.DataFrame:
    """Arrays by layer and lag as a table, with the probabilities of a test."""
    plain = {
        name: array.drop_vars(["channel", "compartment"], errors="ignore") for name, array in arrays.items()
    }
    table = xr.Dataset(plain).to_dataframe(dim_order=_PLACE).reset_index()
    for name in ("p", "p_fwer"):
        table[name] = np.nan if windows is None else windows[name].transpose(*_PLACE).to_numpy().ravel()
    return table.assign(smallest_p=smallest_p)


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
