"""The study of a population as its run writes it, made of arrays."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

import cytodisk as cd
from cytodisk.population.conditions.with_control import smallest_corrected
from cytodisk.population.population import Population
from cytodisk.runs.population.comparison_rows import described_scalars
from cytodisk.store.populations.population_study import PopulationStudy
from cytodisk.store.populations.window_arrays import window_rows

_COMPARISON = ["condition", "control", "unit", "design", "n_control", "n_treated"]
_COMPARISON += ["smallest_p", "smallest_p_holm"]


def study_of(pop: Population, path: Path, **parameters: Any) -> PopulationStudy:
    """Tables of a study whose control is the first condition; nothing is tested without experiments."""
    control, *treated = pop.conditions
    known = bool(pop.experiments)
    found = cd.compare_with_control(pop, control, treated, permutations=99) if treated and known else {}
    scalars = pop.scalar_table()
    cells = pop.cells.copy()
    cells = cells.assign(
        experiment=cells["experiment"] if known else None,
        direction=pop.alignment["direction"],
        shift=pop.alignment["shift"].astype(float),
        left_out="",
        cell=cells["cell"] if "cell" in cells else [f"cell {k}" for k in range(len(cells))],
    )
    cells = pd.concat([cells, scalars[[name for name in scalars if name not in cells]]], axis=1)
    cells.attrs["units"] = {name: "a.u." for name in scalars if name.startswith("mean_")}
    provenance = {"conditions": [*pop.conditions], "control": control, "parameters": parameters}
    study = PopulationStudy(path, provenance | {"scalars compared": list(scalars)})
    atlas = window_rows(pop.atlas())
    atlas.attrs["units"] = {"mean": "a.u."}
    study.__dict__.update(
        cells=cells,
        atlas=atlas,
        windows=_windows(pop, found, control, treated),
        clusters=_joined(found, lambda one: one.clusters, control),
        scalars=_scalars(pop, scalars, found, control, treated),
        comparisons=_comparisons(found, control, treated),
        profiles=_profiles(pop, scalars),
        gallery=_gallery(pop),
    )
    return study


def _windows(pop: Population, found: dict[str, Any], control: str, treated: list[str]) -> pd.DataFrame:
    if found:
        return _joined(found, lambda one: window_rows(_by_channel(one.windows, pop)), control)
    mean = pop.atlas()["mean"]
    first = mean.sel(condition=control, drop=True)
    differences = {name: mean.sel(condition=name, drop=True) - first for name in treated}
    return _joined(differences, lambda one: window_rows(one.to_dataset(name="difference")), control)


def _scalars(
    pop: Population, scalars: pd.DataFrame, found: dict[str, Any], control: str, treated: list[str]
) -> pd.DataFrame:
    tested = _joined(found, lambda one: one.scalars, control)
    if found or not treated:
        return tested
    described = described_scalars(scalars, pop.cells["condition"], control, treated)
    return described.reindex(columns=[*described, *(name for name in tested if name not in described)])


def _by_channel(windows: Any, pop: Population) -> Any:
    return windows if "channel" in windows.dims else windows.expand_dims(channel=list(pop.channels))


def _joined(found: dict[str, Any], table_of: Any, control: str) -> pd.DataFrame:
    tables = [table_of(one).assign(condition=name, control=control) for name, one in found.items()]
    columns = ["condition", "control", "channel", "cluster", "scalar", "effect_size", "p", "p_fwer"]
    columns += ["low", "high"]
    return pd.concat(tables, ignore_index=True) if tables else pd.DataFrame(columns=columns)


def _comparisons(found: dict[str, Any], control: str, treated: list[str]) -> pd.DataFrame:
    rows = []
    smallest = smallest_corrected(found)
    for name in treated:
        one = found.get(name)
        counts = (
            [0, 0] if one is None else [(one.units["condition"] == side).sum() for side in (control, name)]
        )
        rows.append(
            {
                "condition": name,
                "control": control,
                "unit": "experiment",
                "design": "not tested" if one is None else one.design,
                "n_control": counts[0],
                "n_treated": counts[1],
                "smallest_p_holm": smallest.get(name, np.nan),
                "smallest_p": np.nan if one is None else one.smallest_p,
            }
        )
    return pd.DataFrame(rows, columns=_COMPARISON)


def _profiles(pop: Population, scalars: pd.DataFrame) -> pd.DataFrame:
    experiment = pop.cells["experiment"] if pop.experiments else pd.Series("", pop.cells.index)
    parts = []
    for channel in pop.channels:
        for layer, compartment in enumerate(pop.compartments):
            values = scalars[f"layer_{layer}_{channel}"]
            found = values.groupby([pop.cells["condition"], experiment], sort=False).mean().reset_index()
            found.columns = pd.Index(["condition", "experiment", "mean"])
            depth = float(layer) + 0.5
            parts.append(found.assign(channel=channel, layer=layer, compartment=compartment, depth=depth))
    table = pd.concat(parts, ignore_index=True)
    table.attrs["units"] = {"depth": "µm"}
    return table


def _gallery(pop: Population) -> pd.DataFrame:
    """The first two cells of each condition as nearest, the last two as farthest."""
    parts = []
    for condition in pop.conditions:
        rows = np.flatnonzero(pop.cells["condition"] == condition)
        for place, chosen in (("nearest", rows[:2]), ("farthest", rows[-2:])):
            for rank, row in enumerate(chosen.tolist()):
                values = pop.values[row].drop_vars("cell", errors="ignore")
                table = window_rows(values.to_dataset(name="value"))
                parts.append(table.assign(condition=condition, row=row, place=place, rank=rank + 1))
    return pd.concat(parts, ignore_index=True)
