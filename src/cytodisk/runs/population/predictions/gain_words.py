"""What pooled gains show, in sentences."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.population.group_columns import CONDITION
from cytodisk.population.significance import LEVEL
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.findings.doubt_words import doubt_words
from cytodisk.runs.population.pooling.number_words import digits
from cytodisk.runs.predict.prediction_verdict import WEAKER

_LINK = ["source", "target"]
_MOST_LINKS = 4  # that are told one by one


def link_sentences(pooled: pd.DataFrame) -> list[str]:
    """What predicts what in each condition, and what does not.

    Parameters
    ----------
    pooled : DataFrame
        Table `pooled`.

    Returns
    -------
    list of str
        Of more than four links those that do not predict are counted.
    """
    if pooled.empty:
        return []
    said = []
    for condition, rows in pooled[pooled["kind"] == "raw"].groupby(CONDITION, sort=False):
        partial = pooled[(pooled["kind"] == "partial") & (pooled[CONDITION] == condition)]
        if words := [*_of_condition(rows, partial)]:
            said.append(f"{condition}: {' '.join(words)}")
    return said


def best_layer(rows: pd.DataFrame) -> Any:
    """The row of a link with the largest gain: of the layers where it predicts, of all where none does.

    Parameters
    ----------
    rows : DataFrame
        Of one condition, link and kind.

    Returns
    -------
    Series or None
        None where no layer has a gain.
    """
    known = rows.dropna(subset="gain_excess")
    chosen = known[predicts(known)]
    chosen = chosen if len(chosen) else known
    return chosen.iloc[int(chosen["gain_excess"].to_numpy().argmax())] if len(chosen) else None


def predicts(rows: pd.DataFrame) -> pd.Series:
    """Whether the source predicts the target: its scores are above 0 beyond chance."""
    return (rows["p_fwer"] <= LEVEL) & (rows["score"] > 0.0)


def _of_condition(rows: pd.DataFrame, partial: pd.DataFrame) -> Iterator[str]:
    links = [(names, own) for names, own in rows.groupby(_LINK, sort=False)]
    best = {names: row for names, own in links if (row := best_layer(own)) is not None}
    if not best:
        return
    if all(np.isnan(row["p_fwer"]) for row in best.values()) or _cannot_tell(rows):
        yield from (_untested(row) for row in _largest(best.values()))
        yield _from_cells(rows)
        return
    found = [row for row in best.values() if predicts(pd.DataFrame([row])).all()]
    for row in _largest(found):
        yield _predicted(row)
        yield from _without_geometry(partial, row)
    rest = [row for row in best.values() if not predicts(pd.DataFrame([row])).all()]
    if len(best) <= _MOST_LINKS or not found:
        yield from (_not_predicted(row) for row in _largest(rest)[:_MOST_LINKS])
        rest = rest[_MOST_LINKS:]
    if rest:
        yield f"{len(rest)} {'more ' if not found else ''}of {len(best)} links do not predict beyond chance."
    yield _from_cells(rows)


def _largest(rows: Any) -> list[Any]:
    return sorted(rows, key=lambda row: -row["gain_excess"])


def _cannot_tell(rows: pd.DataFrame) -> bool:
    return bool(rows["smallest_p"].min() > LEVEL)


def _names(row: Any) -> tuple[str, str]:
    source, target = (_shown(row[name]) for name in _LINK)
    return source, target


def _shown(name: str) -> str:
    return "the edge's velocity" if name in VELOCITIES else name


def _size(row: Any) -> str:
    """Gain with its interval."""
    interval = ""
    if pd.notna(row["low"]):
        interval = f" (95 % interval {digits(row['low'])} to {digits(row['high'])})"
    return f"gain beyond chance {digits(row['gain_excess'])}{interval}"


def _predicted(row: Any) -> str:
    source, target = _names(row)
    less = 100.0 * -np.expm1(-row["gain_excess"])
    return (
        f"The past of {source} predicts {target}, most in layer {row['layer']}: {less:.2g} % less error, "
        f"{_size(row)}, p = {row['p_fwer']:.2g} over all links and layers{_but(row)}."
    )


def _but(row: Any) -> str:
    return f", but {doubt_words([WEAKER])}: so it is no finding" if row["weaker"] else ""


def _not_predicted(row: Any) -> str:
    source, target = _names(row)
    return (
        f"The past of {source} does not predict {target} beyond chance; at most in layer {row['layer']}: "
        f"{_size(row)}, p = {row['p_fwer']:.2g}."
    )


def _untested(row: Any) -> str:
    source, target = _names(row)
    why = "not tested"
    if pd.notna(row["smallest_p"]):
        why = f"whether it is by chance cannot be told, as p is {row['smallest_p']:.2g} at best"
    return f"From {source} to {target}, most in layer {row['layer']}: {_size(row)}; {why}."


def _without_geometry(partial: pd.DataFrame, row: Any) -> Iterator[str]:
    """What is left of a link in its layer with controls regressed out."""
    same = (partial[_LINK] == row[_LINK]).all(axis=1) & (partial["layer"] == row["layer"])
    if not same.any() or pd.isna(partial.loc[same, "gain_excess"].iloc[0]):
        return
    left = partial[same].iloc[0]
    verdict = "it survives" if predicts(partial[same]).all() else "it does not survive"
    size = f"{digits(left['gain_excess'])}, p = {left['p_fwer']:.2g}"
    yield f"With what geometry alone would give regressed out the gain is {size}: {verdict}."


def _from_cells(rows: pd.DataFrame) -> str:
    cells, experiments = int(rows["n_cells"].max()), int(rows["n_experiments"].max())
    return (
        f"{cells} cells in {experiments} experiments."
        if experiments
        else f"{cells} cells, experiments unknown."
    )


def difference_sentences(comparisons: pd.DataFrame) -> list[str]:
    """A sentence for each pair of conditions: which gain differs most.

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
    raw = comparisons[comparisons["kind"] == "raw"].dropna(subset="p_fwer")
    return [
        _difference(str(name), str(control), rows)
        for (name, control), rows in raw.groupby([CONDITION, "control"], sort=False)
    ]


def _difference(name: str, control: str, rows: pd.DataFrame) -> str:
    significant = rows[rows["p_holm"] <= LEVEL]
    chosen = significant if len(significant) else rows
    most: Any = chosen.iloc[int(chosen["difference"].abs().to_numpy().argmax())]
    number = int(most["comparisons"])
    corrected = f", corrected for {number} comparisons (Holm)" if number > 1 else ""
    best = min(number * float(rows["smallest_p"].min()), 1.0)
    if best > LEVEL:
        return f"Whether {name} differs from {control} cannot be told: p is {best:.2g} at best{corrected}."
    source, target = _names(most)
    interval = f"95 % interval {digits(most['difference_low'])} to {digits(most['difference_high'])}"
    where = (
        f"the gain of {source} for {target} in layer {most['layer']}: {name} less {control} "
        f"{digits(most['difference'])} ({interval}), p = {most['p_holm']:.2g}{corrected}"
    )
    if len(significant):
        places = f"{len(significant)} of {len(rows)} links × layers"
        return f"{name} differs from {control} in {places}, most in {where}."
    return f"{name} does not differ from {control} beyond chance; at most in {where}."
