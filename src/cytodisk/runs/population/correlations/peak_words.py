"""What pooled curves show, in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from cytodisk.population.significance import LEVEL
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.lag_words import lag_words


def peak_sentences(pooled: pd.DataFrame, names: tuple[str, str]) -> list[str]:
    """A sentence for each condition: its strongest correlation, and what is left of it without controls.

    Parameters
    ----------
    pooled : DataFrame
        Table `pooled`.
    names : (str, str)
        Signal, and what it was correlated with.

    Returns
    -------
    list of str
    """
    conditions = pooled["condition"].drop_duplicates().tolist() if len(pooled) else []
    return [" ".join(_of_condition(pooled[pooled["condition"] == name], name, names)) for name in conditions]


def strongest(rows: pd.DataFrame) -> Any:
    """The row with the largest correlation: of those with p_fwer up to 0.05, of all where there is none."""
    known = rows.dropna(subset="correlation")
    significant = known[known["p_fwer"] <= LEVEL]
    chosen = significant if len(significant) else known
    return chosen.iloc[int(chosen["correlation"].abs().to_numpy().argmax())] if len(chosen) else None


def _of_condition(rows: pd.DataFrame, name: str, names: tuple[str, str]) -> Iterator[str]:
    raw = strongest(rows[rows["curve"] == "raw"])
    if raw is None:
        return
    from_cells = f"{raw['n_cells']} cells in {raw['n_experiments']} experiments"
    if not raw["n_experiments"]:
        from_cells = f"{raw['n_cells']} cells, experiments unknown"
    what = f"{name}: {names[0]} and {_other(names[1])}"
    place = f"in layer {raw['layer']} at {lag_words(raw['lag'], raw['lag_s'])}"
    size = f"r = {_two(raw['correlation'])}{_interval(raw)}"
    if raw["p_fwer"] <= LEVEL:
        chance = f"p = {raw['p_fwer']:.2g} over all layers and lags"
        yield f"{what} correlate {place}: {size}, {chance}; {from_cells}."
        yield from _without(rows[rows["curve"] == "partial"], raw)
    elif raw["smallest_p"] > LEVEL:
        yield (
            f"{what}: the largest mean correlation is {size} {place}; {from_cells}. Whether it is by chance "
            f"cannot be told: p is {raw['smallest_p']:.2g} at best."
        )
    elif pd.notna(raw["p_fwer"]):
        yield (
            f"{what} correlate nowhere beyond chance. The largest mean correlation is {size} {place}, "
            f"p = {raw['p_fwer']:.2g} over all layers and lags; {from_cells}."
        )
    else:
        yield f"{what}: the largest mean correlation is {size} {place}; {from_cells}; not tested."


def _without(partial: pd.DataFrame, raw: Any) -> Iterator[str]:
    """What is left of a peak at its layer and lag with controls regressed out."""
    at = partial[(partial["layer"] == raw["layer"]) & (partial["lag"] == raw["lag"])]
    if at.empty or pd.isna(at["correlation"].iloc[0]):
        return
    left = at.iloc[0]
    size = f"r = {_two(left['correlation'])}"
    verdict = "it survives" if left["p_fwer"] <= LEVEL else "it does not survive"
    yield f"With geometry and other controls regressed out {size}, p = {left['p_fwer']:.2g}: {verdict}."


def _interval(row: Any) -> str:
    if pd.isna(row["low"]):
        return ""
    return f" (95 % interval {_two(row['low'])} to {_two(row['high'])})"


def _two(number: float) -> str:
    """Two digits after the point, with a true minus; never minus nothing."""
    return f"{round(number, 2) + 0.0:.2f}".replace("-", "−")


def _other(with_: str) -> str:
    return "the edge's velocity" if with_ in VELOCITIES else with_


def difference_sentences(comparisons: pd.DataFrame) -> list[str]:
    """A sentence for each pair of conditions: where their raw curves differ most.

    Parameters
    ----------
    comparisons : DataFrame
        Table `comparisons`; empty with one condition.

    Returns
    -------
    list of str
    """
    if comparisons.empty:
        return []
    raw = comparisons[comparisons["curve"] == "raw"].dropna(subset="p_fwer")
    said = []
    for (name, control), rows in raw.groupby(["condition", "control"], sort=False):
        significant = rows[rows["p_holm"] <= LEVEL]
        chosen = significant if len(significant) else rows
        most: Any = chosen.iloc[int(chosen["difference"].abs().to_numpy().argmax())]
        number = int(most["comparisons"])
        corrected = f", corrected for {number} comparisons (Holm)" if number > 1 else ""
        best = min(number * raw["smallest_p"].min(), 1.0)
        low, high = _two(most["difference_low"]), _two(most["difference_high"])
        size = f"{_two(most['difference'])} in Fisher's z (95 % interval {low} to {high})"
        where = f"{size} in layer {most['layer']} at {lag_words(most['lag'], most['lag_s'])}"
        where += f", p = {most['p_holm']:.2g}{corrected}"
        if max(best, most["smallest_p"]) > LEVEL:
            words = f"p is {max(best, most['smallest_p']):.2g} at best{corrected}"
            said.append(f"Whether {name} differs from {control} cannot be told: {words}.")
        elif len(significant):
            count = f"{len(significant)} of {len(rows)} layers × lags"
            said.append(f"{name} differs from {control} at {count}, most by {where}.")
        else:
            said.append(f"{name} does not differ from {control} beyond chance; at most by {where}.")
    return said
