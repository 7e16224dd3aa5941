"""Mean of each condition over experiments, with its interval, and what chance would give."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from scipy.stats import t as student

from cytodisk.errors import PopulationError
from cytodisk.population.comparison_parameters import PermutationParameters
from cytodisk.population.conditions.condition_comparison import compare_conditions
from cytodisk.population.conditions.with_control import holm
from cytodisk.population.conditions.with_zero import compare_with_zero
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.population.population import Population

TABLES = ("experiments", "pooled", "comparisons")


@dataclass
class Pooled:
    """Tables of pooled numbers, and what to say of them.

    Attributes
    ----------
    tables : dict of str to DataFrame
        experiments, pooled, and comparisons; of curves also peaks.
    sentences : list of str
    warnings : list of dict
        Those of the tests, with the condition they are about.
    """

    tables: dict[str, pd.DataFrame] = field(default_factory=dict)
    sentences: list[str] = field(default_factory=list)
    warnings: list[dict[str, Any]] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class Pool:
    """A population whose conditions are pooled over experiments.

    Attributes
    ----------
    population : Population
    compare : sequence of str
        Conditions that are compared, the control first; all where it is empty.
    chance : PermutationParameters
    place : (str, str)
        Dims of the values that tables have columns for; others have one value.
    value : str
        Name of the column of means.
    back : callable
        Turns means and the ends of their intervals into what tables hold; by default they are it.
    zero, between : sequence of str or None
        Channels whose mean is tested against 0, and those that are compared between conditions, each
        together; None for all.
    scores : Population or None
        Of the same channels and layers, whose mean is tested against 0 in the place of that of the numbers.
    """

    population: Population
    compare: Sequence[str]
    chance: PermutationParameters
    place: tuple[str, str]
    value: str
    back: Callable[[xr.DataArray], xr.DataArray] = lambda mean: mean
    zero: Sequence[str] | None = None
    between: Sequence[str] | None = None
    scores: Population | None = None

    def pooled(self) -> Pooled:
        """Pool, and test.

        Returns
        -------
        Pooled
            An experiment counts once, whatever the number of its cells: its number is the mean of theirs, and
            the condition's the mean of the experiments'. Where experiments are unknown there is no interval
            and no test, and a sentence says so.

        Raises
        ------
        PopulationError
            A condition to compare is not there.
        """
        found = Pooled()
        names = self.population.conditions
        control, *others = conditions_compared(names, self.compare)
        rest = [name for name in names if name not in (control, *others)]
        pooled = [self._of_condition(name, found) for name in (control, *others, *rest)]
        compared = {other: self._compared(control, other, found) for other in others}
        tables = [self._experiments(), pd.concat(pooled, ignore_index=True), _corrected(compared)]
        found.tables = dict(zip(TABLES, tables, strict=True))
        return found

    @property
    def _chance(self) -> dict[str, Any]:
        return {"permutations": self.chance.permutations, "seed": self.chance.seed}

    def _experiments(self) -> pd.DataFrame:
        """Mean of the cells of each experiment."""
        values = self.population.values
        single = {str(name): 0 for name in values.dims if name not in ("cell", *self.place)}
        cells = self.population.cells[[CONDITION, EXPERIMENT]]
        long = values.isel(single, drop=True).to_dataframe("mean")
        long = long[["mean"]].reset_index().join(cells, on="cell").dropna(subset="mean")
        means = long.groupby([CONDITION, EXPERIMENT, *self.place], sort=False)["mean"].agg(["mean", "size"])
        table = means.reset_index().rename(columns={"size": "n_cells"})
        turned = self.back(xr.DataArray(table.pop("mean").to_numpy(np.float64), dims="row"))
        return table.assign(**{self.value: turned.to_numpy()})

    def _of_condition(self, condition: str, found: Pooled) -> pd.DataFrame:
        """Mean over experiments, interval and test against 0 of one condition."""
        own = self.population.select((self.population.cells[CONDITION] == condition).to_numpy())
        atlas = own.atlas().sel(condition=condition, drop=True)
        reach = _interval(atlas)
        arrays: dict[str, xr.DataArray] = {
            self.value: self.back(atlas["mean"]),
            "low": self.back(atlas["mean"] - reach),
            "high": self.back(atlas["mean"] + reach),
            "n_cells": atlas["n_cells"],
            "n_experiments": atlas["n_experiments"],
        }
        if self.scores is not None:
            own = self.scores.select((self.scores.cells[CONDITION] == condition).to_numpy())
            arrays["score"] = own.atlas().sel(condition=condition, drop=True)["mean"]
        tested_ones = self._chosen(self.zero)
        try:
            tested = compare_with_zero(own, condition, channel=tested_ones, **self._chance)
        except PopulationError as error:
            found.sentences.append(f"{condition} is not tested against 0: {error}")
            return self._table(arrays).assign(condition=condition)
        found.sentences.append(f"{condition} against 0: {tested.sentences[0]}")
        windows = self._with_channel(tested.windows, tested_ones)
        return self._table(arrays, windows, tested.smallest_p).assign(condition=condition)

    def _chosen(self, names: Sequence[str] | None) -> list[str]:
        there = self.population.channels
        return [name for name in there if names is None or name in names]

    @staticmethod
    def _with_channel(windows: xr.Dataset, channels: list[str]) -> xr.Dataset:
        """What a test found, by channel also where it was of one."""
        if "channel" in windows.dims:
            return windows
        return windows.drop_vars("channel", errors="ignore").expand_dims(channel=channels)

    def _compared(self, control: str, other: str, found: Pooled) -> pd.DataFrame:
        """Difference of two conditions."""
        compared = self._chosen(self.between)
        try:
            tested = compare_conditions(self.population, control, other, channel=compared, **self._chance)
        except PopulationError as error:
            found.sentences.append(f"{other} is not compared with {control}: {error}")
            return pd.DataFrame()
        found.sentences.append(f"{other} against {control}: {' '.join(tested.sentences[:2])}")
        found.warnings += [asdict(one) | {"condition": other, "control": control} for one in tested.warnings]
        names = ("difference", "difference_low", "difference_high", "n_control", "n_treated")
        windows = self._with_channel(tested.windows, compared)
        table = self._table({name: windows[name] for name in names}, windows, tested.smallest_p)
        return table.assign(condition=other, control=control)

    def _table(
        self,
        arrays: dict[str, xr.DataArray],
        windows: xr.Dataset | None = None,
        smallest_p: float = np.nan,
    ) -> pd.DataFrame:
        """Arrays by place as a table, with the probabilities of a test."""
        if windows is not None:
            arrays = arrays | {name: windows[name] for name in ("p", "p_fwer")}
        plain = xr.Dataset({name: self._placed(array) for name, array in arrays.items()})
        table = plain.to_dataframe(dim_order=list(self.place)).reset_index()
        if windows is None:
            table = table.assign(p=np.nan, p_fwer=np.nan)
        return table.assign(smallest_p=smallest_p if windows is not None else np.nan)

    def _placed(self, array: xr.DataArray) -> xr.DataArray:
        """The array along the dims of the tables, in the population's order."""
        plain = array.drop_vars("compartment", errors="ignore")
        single = {str(name): 0 for name in plain.dims if name not in self.place}
        placed = plain.isel(single, drop=True)
        if "channel" in self.place:
            placed = placed.reindex(channel=list(self.population.channels))
        return placed.drop_vars([str(name) for name in placed.coords if name not in self.place])


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


def _corrected(compared: dict[str, pd.DataFrame]) -> pd.DataFrame:
    """Comparisons of several conditions with the control, corrected for their number."""
    tested = {name: table for name, table in compared.items() if len(table)}
    if not tested:
        return pd.DataFrame()
    p_holm = holm({name: table["p_fwer"].to_numpy(np.float64) for name, table in tested.items()})
    parts = [table.assign(p_holm=p_holm[name], comparisons=len(tested)) for name, table in tested.items()]
    return pd.concat(parts, ignore_index=True)


def _interval(atlas: xr.Dataset) -> xr.DataArray:
    """Half of the 95 % interval over experiments; NaN with fewer than two."""
    count = atlas["n_experiments"]
    quantile = student.ppf(0.975, np.maximum(count - 1, 1))
    return (atlas["sem"] * quantile).where(count > 1)
