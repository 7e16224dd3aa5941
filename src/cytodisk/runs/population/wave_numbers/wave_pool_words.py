"""What pooled numbers of waves show, in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pandas as pd

from cytodisk.population.group_columns import CONDITION
from cytodisk.population.significance import LEVEL
from cytodisk.runs.population.movies.wave_summaries import has_wave
from cytodisk.runs.population.pooling.number_words import cells_words, digits, significant, with_interval

NAMES = {
    "wave_order": "order of waves",
    "wave_speed_um_s": "speed along the edge",
    "wave_direction": "direction (1: all waves run one way, 0: standing)",
    "wave_period_s": "period",
    "wave_persistence_s": "persistence",
}
"""Numbers of waves in words."""

_TOLD = ("wave_speed_um_s", "wave_period_s", "wave_persistence_s")


def wave_sentences(pooled: pd.DataFrame, cells: pd.DataFrame) -> list[str]:
    """Whether the cells of each condition have waves, and their usual speed, period and persistence.

    Parameters
    ----------
    pooled : DataFrame
        Table `pooled`.
    cells : DataFrame
        condition, kind and p of each cell's wave.

    Returns
    -------
    list of str
    """
    if pooled.empty:
        return []
    said = []
    for condition, rows in pooled.groupby(CONDITION, sort=False):
        own = cells[cells[CONDITION] == condition]
        said.append(f"{condition}: {' '.join(_of_condition(rows, own))}")
    return said


def _of_condition(rows: pd.DataFrame, cells: pd.DataFrame) -> Iterator[str]:
    order = _strongest(rows[rows["number"] == "wave_order"])
    layers = rows.loc[rows["number"] == "wave_order", "layer"].nunique()
    where = f" in layer {order['layer']}" if layers > 1 else ""
    chance = f"mean order {digits(order['mean'], 2)}{where}"
    if pd.isna(order["p_fwer"]):
        verdict = f"Whether there are waves beyond chance was not tested ({chance})."
    elif order["smallest_p"] > LEVEL:
        best = f"p is {order['smallest_p']:.2g} at best"
        verdict = f"Whether there are waves beyond chance cannot be told, as {best} ({chance})."
    else:
        over = ", over all layers" if layers > 1 else ""
        is_wave = order["p_fwer"] <= LEVEL and order["mean"] > 0.0
        what = "There are waves beyond chance" if is_wave else "There are no waves beyond chance"
        verdict = f"{what} ({chance}, p = {order['p_fwer']:.2g}{over})."
    yield verdict
    having = cells[has_wave(cells)]
    kinds = ", ".join(f"{count} {kind}" for kind, count in having["kind"].value_counts().items())
    yield f"{len(having)} of {len(cells)} cells have one by themselves{f': {kinds}' if kinds else ''}."
    told = [_number(rows, name) for name in _TOLD]
    if any(told):
        yield f"Of these cells: {', '.join(filter(None, told))}."
    yield f"{cells_words(int(order['n_cells']), int(order['n_experiments']))}."


def _strongest(orders: pd.DataFrame) -> Any:
    """Of the layers with waves beyond chance that with the largest order; of all where none has."""
    chosen = orders[(orders["p_fwer"] <= LEVEL) & (orders["mean"] > 0.0)]
    chosen = chosen if len(chosen) else orders
    return chosen.iloc[int(chosen["mean"].to_numpy().argmax())]


def _number(rows: pd.DataFrame, name: str) -> str:
    own = rows[rows["number"] == name]
    if own.empty:
        return ""
    row: Any = own.iloc[0]
    return f"{NAMES[name]} {with_interval(row['mean'], row['low'], row['high'], row['unit'])}"


def difference_sentences(comparisons: pd.DataFrame) -> list[str]:
    """A sentence for each pair of conditions: which numbers differ.

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
    tested = comparisons.dropna(subset="p_fwer")
    return [
        _difference(str(name), str(control), rows)
        for (name, control), rows in tested.groupby([CONDITION, "control"], sort=False)
    ]


def _difference(name: str, control: str, rows: pd.DataFrame) -> str:
    number = int(rows["comparisons"].iloc[0])
    corrected = f", corrected for {number} comparisons (Holm)" if number > 1 else ""
    best = min(number * float(rows["smallest_p"].min()), 1.0)
    if best > LEVEL:
        return f"Whether {name} differs from {control} cannot be told: p is {best:.2g} at best{corrected}."
    different = rows[rows["p_holm"] <= LEVEL].sort_values("p_holm", kind="stable")
    if len(different):
        different = different.drop_duplicates("number")  # the table has all layers
        parts = [_size(row, name, control) for _, row in different.iterrows()]
        return f"{name} differs from {control}{corrected}: {'; '.join(parts)}."
    most: Any = rows.iloc[int(rows["p_holm"].to_numpy().argmin())]
    size = _size(most, name, control)
    return f"{name} does not differ from {control} beyond chance{corrected}; at most: {size}."


def _size(row: Any, name: str, control: str) -> str:
    interval = f"{significant(row['difference_low'])} to {significant(row['difference_high'])}"
    layer = f" in layer {row['layer']}" if row["number"] == "wave_order" else ""
    return (
        f"{NAMES[row['number']]}{layer}, {name} less {control} {significant(row['difference'], row['unit'])} "
        f"(95 % interval {interval}), p = {row['p_holm']:.2g}"
    )
