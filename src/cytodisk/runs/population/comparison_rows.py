"""What comparisons of conditions found, as rows of the tables of a population's study."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.population.conditions.condition_comparison import ConditionComparison
from cytodisk.population.conditions.dose_trend import DoseTrend
from cytodisk.population.group_columns import CONDITION, EXPERIMENT
from cytodisk.population.population import Population
from cytodisk.population.significance import LEVEL
from cytodisk.store.populations.window_arrays import window_rows

Comparisons = Mapping[str, ConditionComparison]
"""By the condition that is compared with the control."""

_MEANS = {"control": "mean_control", "treated": "mean_treated"}


def comparison_tables(found: Comparisons, control: str) -> dict[str, pd.DataFrame]:
    """The tables that have rows for each comparison.

    Parameters
    ----------
    found : dict of str to ConditionComparison
    control : str

    Returns
    -------
    dict of str to DataFrame
    """
    left_out = {"experiment": "left_out", "difference": "difference_without", "p": "p_without"}
    left_out |= {"difference_of_all": "difference"}
    tables = {
        "windows": {name: window_table(one.windows) for name, one in found.items()},
        "clusters": {name: one.clusters for name, one in found.items()},
        "scalars": {name: one.scalars.rename(columns=_MEANS) for name, one in found.items()},
        "left_out": {name: one.left_out.rename(columns=left_out) for name, one in found.items()},
    }
    return {name: _joined(parts, control) for name, parts in tables.items()}


def window_table(windows: xr.Dataset) -> pd.DataFrame:
    """Windows of one comparison as rows; none without windows."""
    if not windows.sizes["layer"]:
        return pd.DataFrame()
    if "channel" not in windows.dims:
        windows = windows.expand_dims("channel")
    return window_rows(windows).rename(columns=_MEANS)


def described_windows(atlas: xr.Dataset, control: str, treated: Sequence[str]) -> pd.DataFrame:
    """The table windows where nothing is tested: means of all cells and their differences.

    Parameters
    ----------
    atlas : Dataset
    control : str
    treated : sequence of str

    Returns
    -------
    DataFrame
    """
    mean = atlas["mean"]
    first = mean.sel({CONDITION: control}, drop=True)
    parts = {}
    for name in treated:
        second = mean.sel({CONDITION: name}, drop=True)
        found = xr.Dataset({"mean_control": first, "mean_treated": second, "difference": second - first})
        parts[name] = window_rows(found).assign(cluster=0, status="not tested")
    return _joined(parts, control)


def described_scalars(
    scalars: pd.DataFrame, conditions: pd.Series[str], control: str, treated: Sequence[str]
) -> pd.DataFrame:
    """The table scalars where nothing is tested: means of all cells and their differences.

    Parameters
    ----------
    scalars : DataFrame
        One column a scalar that is compared, a row a cell.
    conditions : Series of str
        Of the cells.
    control : str
    treated : sequence of str

    Returns
    -------
    DataFrame
    """
    means = scalars.groupby(conditions.to_numpy()).mean()
    parts = {}
    for name in treated:
        first, second = means.loc[control], means.loc[name]
        table = pd.DataFrame({"mean_control": first, "mean_treated": second, "difference": second - first})
        parts[name] = table.rename_axis("scalar").reset_index().assign(status="not tested")
    return _joined(parts, control)


def _joined(tables: Mapping[str, pd.DataFrame], control: str) -> pd.DataFrame:
    """Tables of several comparisons, one below the other, with the conditions that are compared."""
    parts = [table.assign(condition=name, control=control) for name, table in tables.items() if len(table)]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def comparison_row(
    one: ConditionComparison, channels: tuple[str, ...], unit: str, smallest: float
) -> dict[str, Any]:
    """The row of a comparison in the table comparisons.

    Parameters
    ----------
    one : ConditionComparison
    channels : tuple of str
        Those that were tested together.
    unit : str
        experiment or cell.
    smallest : float
        The smallest p_holm that there can be.

    Returns
    -------
    dict
    """
    p, status = one.windows["p_fwer"].values, one.windows["status"].values
    used = one.units[one.units["used"] > 0]
    units = used.groupby(CONDITION)["used"].sum() if unit == "cell" else used.groupby(CONDITION).size()
    corrected = one.windows["p_holm"].values
    return {
        CONDITION: one.treated,
        "control": one.control,
        "channels": ", ".join(channels),
        "unit": unit,
        "design": one.design,
        "n_control": int(units.get(one.control, 0)),
        "n_treated": int(units.get(one.treated, 0)),
        "smallest_p": one.smallest_p,
        "smallest_p_holm": smallest,
        "windows_tested": int((status == "ok").sum()),
        "windows_found": int((corrected <= LEVEL).sum()),
        "clusters_found": int((one.clusters["p_holm"] <= LEVEL).sum()),
        "scalars_found": int((one.scalars["p_holm"] <= LEVEL).sum()),
        "smallest_found": _least(p),
        "p_holm": _least(corrected),
        "finding": " ".join(one.sentences[2:]),
    }


def _least(p: FloatArray) -> float:
    known = p[np.isfinite(p)]
    return float(known.min()) if len(known) else np.nan


def trend_tables(trend: DoseTrend | None) -> dict[str, pd.DataFrame]:
    """The tables of a trend over a dose; without rows where there is none."""
    if trend is None:
        return {"trends": pd.DataFrame(), "scalar_trends": pd.DataFrame()}
    slopes = {"difference": "slope", "difference_low": "slope_low", "difference_high": "slope_high"}
    return {
        "trends": window_table(trend.windows).rename(columns=slopes),
        "scalar_trends": trend.scalars.rename(columns=slopes),
    }


def untested_row(condition: str, control: str, channels: tuple[str, ...], unit: str) -> dict[str, Any]:
    """The row of a pair of conditions that is shown, but not tested."""
    row: dict[str, Any] = {CONDITION: condition, "control": control, "channels": ", ".join(channels)}
    return row | {"unit": unit, "design": "not tested", "finding": "not tested"}


def experiment_table(found: Comparisons, population: Population, why: str) -> pd.DataFrame:
    """The table experiments: each condition and experiment once, used if it is in any comparison.

    Parameters
    ----------
    found : dict of str to ConditionComparison
    population : Population
        The cells that are shown.
    why : str
        Why nothing is tested, where that is so.

    Returns
    -------
    DataFrame
    """
    cells = population.cells.assign(**{EXPERIMENT: population.cells[EXPERIMENT].astype(object).fillna("")})
    counted = cells.groupby([CONDITION, EXPERIMENT], sort=False).size().rename("cells").reset_index()
    if not found:
        return counted.assign(used=False, reason=why)
    units = pd.concat([one.units for one in found.values()], ignore_index=True)
    units = units.assign(used=units["used"] > 0).sort_values("used", ascending=False, kind="stable")
    first = units.drop_duplicates([CONDITION, EXPERIMENT])[[CONDITION, EXPERIMENT, "used", "reason"]]
    table = counted.merge(first, how="left", on=[CONDITION, EXPERIMENT])
    return table.assign(used=table["used"].eq(True), reason=table["reason"].fillna("no cell has values"))
