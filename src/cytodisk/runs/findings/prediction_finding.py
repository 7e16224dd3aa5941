"""What a prediction shows: which signal predicts which, in both directions, in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.runs.correlate.lag_words import time_apart
from cytodisk.runs.findings.doubt_words import doubt_words
from cytodisk.runs.findings.finding import Finding, capital, listed
from cytodisk.runs.findings.layer_names import layer_name, numbers_words
from cytodisk.runs.link_words import effect_words, less_error, signal_words
from cytodisk.runs.partial_words import SIGNIFICANT
from cytodisk.runs.predict.prediction_verdict import (
    JITTER,
    WEAKER,
    Direction,
    JudgedLink,
    directions,
    strongest,
)
from cytodisk.store.predictions.prediction_store import Prediction
from cytodisk.store.study import Study

_MOST_LINKS = 4  # of a network that are named
_JITTER = "masks that jitter make each of them predict the other by themselves"
_DRIVER = "a common driver that was not imaged can do the same"


def prediction_finding(
    study: Study, found: Prediction, cell: int, flagged: Sequence[str] = ()
) -> Finding | None:
    """What a prediction shows in one cell.

    Parameters
    ----------
    study : Study
    found : Prediction
    cell : int
    flagged : sequence of str
        Names of the QC flags of the run that bear on it.

    Returns
    -------
    Finding or None
        None for a cell that is not in it, or was left out.
    """
    rows = found.cells[(found.cells["cell"] == cell) & (found.cells["status"] == "ok")]
    if rows.empty:
        return None
    ways = directions(found, cell)
    if found.links["q"].isna().all():
        return Finding("nothing", (_untested(study, found, ways),))
    told = _network(study, found, ways) if found.is_network else _pair(study, found, ways)
    clear = [link for way in ways for link in way.clear]
    some = [link for way in ways for link in way.judged]
    kind: Any = "found" if clear else "doubtful" if some else "nothing"
    if clear and flagged:
        kind = "doubtful"
        told[-1] += f" QC flags are raised that bear on it: {listed(list(flagged))}."
    size = max((float(one.row["gain_excess"]) for one in clear or some), default=0.0)
    return Finding(kind, tuple(told), size=size)


def pooled_finding(study: Study, found: Prediction) -> Finding | None:
    """What a prediction shows over all cells of a study.

    Parameters
    ----------
    study : Study
    found : Prediction

    Returns
    -------
    Finding or None
        Of one cell its own; None without any.
    """
    cells = [int(cell) for cell in found.cells.loc[found.cells["status"] == "ok", "cell"]]
    if len(cells) == 1:
        return prediction_finding(study, found, cells[0])
    if not cells or found.pooled["q"].isna().all():
        return None
    by_cell = {cell: directions(found, cell) for cell in cells}
    ways = [way for some in by_cell.values() for way in some]
    told, size = [], 0.0
    for (source, target), rows in found.pooled.groupby(["source", "target"], sort=False):
        same = [way for way in ways if (way.source, way.target) == (source, target)]
        told.append(_pooled_direction(study, str(source), str(target), rows, same))
        sure = rows.loc[(rows["q"] < SIGNIFICANT) & ~rows["weaker"], "gain_excess"]
        size = max([size, *sure.astype(float)])
    if found.is_network:
        told = [words for words in told if " does not predict " not in words] or [
            "no signal predicts another in any layer"
        ]
    head = f"Over {counted(len(cells), 'cell')}: "
    return Finding(
        "found" if size else "nothing",
        (f"{head}{'. '.join(_begun(words) for words in told)}.", _given_words(found, by_cell[cells[0]])),
        size=size,
    )


def _pooled_direction(
    study: Study, source: str, target: str, rows: pd.DataFrame, ways: list[Direction]
) -> str:
    """What one direction shows over cells, without a full stop."""
    pair = f"{signal_words(source)} {{}} {signal_words(target)}"
    there = rows[rows["q"] < SIGNIFICANT]
    if there.empty:
        return f"{pair.format('does not predict')} in any layer ({_least(float(rows['q'].min()))})"
    sure = there[~there["weaker"]]
    there = sure if len(sure) else there
    best = max(there.to_dict("records"), key=lambda row: float(row["gain_excess"]))
    layers = [int(layer) for layer in there["layer"]]
    most = f", most in {layer_name(study, int(best['layer']))}" if len(layers) > 1 else ""
    effects = [way.rows.set_index("layer")["effect"].get(best["layer"], math.nan) for way in ways]
    return (
        f"{pair.format('predicts')} in {numbers_words('layer', layers)}{most}: {less_error(best['gain'])} "
        f"(q = {best['q']:.2g}); {effect_words(source, target, _mean(effects))}; by itself in "
        f"{sum(bool(way.clear) for way in ways)} of {len(ways)} cells"
        f"{'' if len(sure) else f', but {_doubt_words([WEAKER])}'}"
    )


def _pair(study: Study, found: Prediction, ways: list[Direction]) -> list[str]:
    there, back = ways
    first = _direction(study, there)
    second = _direction(study, back)
    variant = f" ({found.name})" if found.name else ""
    last = _given_words(found, ways)
    second = f"The other way round, {second}{_compared(there, back)}."
    return [f"{_begun(first)}{variant}.", second, last]


def _direction(study: Study, way: Direction) -> str:
    """What one direction shows, without a full stop."""
    pair = f"{signal_words(way.source)} {{}} {signal_words(way.target)}"
    tested = way.rows[way.rows["status"] == "ok"]
    if tested.empty:
        return f"whether {pair.format('predicts')} could not be tested: {way.rows['reason'].iloc[0]}"
    if not way.judged:
        return f"{pair.format('does not predict')} in any layer ({_least(way.least_q)})"
    some = way.clear or way.waiting or way.lost
    best = strongest(some)
    words = f"{pair.format('predicts')} in {layer_name(study, best.layer)}: {_numbers(study, best)}"
    if not best.clear:
        why = _left(best) if best.lost else _doubt_words(best.doubts)
        words += f", but {why}: so it is no finding until that is settled"
        return words
    also = [one.layer for one in way.clear if one is not best and _same_sign(one, best)]
    if also:
        words += f"; {numbers_words('layer', also)} {'does' if len(also) == 1 else 'do'}, too"
    doubted = [one.layer for one in way.judged if not one.clear]
    return f"{words}; {numbers_words('layer', doubted)} in doubt" if doubted else words


def _numbers(study: Study, link: JudgedLink) -> str:
    """As "4.2 % less error with its past 15 s (3.9 % without geometry, q = 0.002); more Rac1 is …"."""
    row, interval = link.row, study.scale.frame_interval_s or math.nan
    past = time_apart(row["source_order"], row["source_order"] * interval)
    partial = row["gain_partial"]
    left = f"{less_error(max(partial, 0.0)).removesuffix(' less error')} without geometry, "
    words = f"{less_error(row['gain'])} with its past {past} ({left if partial == partial else ''}"
    sign = effect_words(row["source"], row["target"], row["effect"], link.turns)
    return f"{words}q = {row['q']:.2g}); {sign}"


def _left(link: JudgedLink) -> str:
    q = link.row["q_partial"]
    if q < SIGNIFICANT:
        return "less than a quarter of that is left without geometry"
    return f"not without what the cell's motion alone would give (q = {q:.2g})"


def _doubt_words(doubts: Sequence[str]) -> str:
    """The first doubt in words, the others by name."""
    first, *others = doubts
    words = _JITTER if first == JITTER else doubt_words([first])
    return f"{words} (also in doubt: {', '.join(others)})" if others else words


def _compared(there: Direction, back: Direction) -> str:
    """Where both predict each other, which gains more."""
    if not (there.clear and back.clear):
        return ""
    one, other = (float(strongest(way.clear).row["gain_excess"]) for way in (there, back))
    larger, ratio = (there, one / other) if one >= other else (back, other / one)
    words = f"{signal_words(larger.source)} → {signal_words(larger.target)}"
    return f"; of both directions {words} is {ratio:.2g} times as strong" if ratio > 1.2 else ""


def _network(study: Study, found: Prediction, ways: list[Direction]) -> list[str]:
    names = listed([signal_words(name) for name in found.signals])
    clear = sorted((way for way in ways if way.clear), key=_strength, reverse=True)
    told = [_link(way) for way in clear[:_MOST_LINKS]]
    more = len(clear) - len(told)
    words = f"Of {len(ways)} links among {names}, "
    if clear:
        holds = "holds" if len(clear) == 1 else "hold"
        words += f"{len(clear)} {holds}: {'; '.join(told)}{f'; and {more} more' if more > 0 else ''}."
    else:
        least = min((way.least_q for way in ways), default=math.nan)
        words += f"none holds ({_least(least)})."
    doubted = [way for way in ways if way.judged and not way.clear]
    second = []
    if doubted:
        told = [f"{_arrow(way)} ({', '.join(_why(way))})" for way in doubted]
        second = [f"Not yet to be believed: {listed(told)}."]
    return [words, *second, _given_words(found, ways)]


def _link(way: Direction) -> str:
    best = strongest(way.clear).row
    layers = numbers_words("layer", [one.layer for one in way.clear])
    words = effect_words(way.source, way.target, best["effect"], strongest(way.clear).turns)
    return f"{_arrow(way)} ({layers}, {less_error(best['gain'])}, q = {best['q']:.2g}; {words})"


def _why(way: Direction) -> list[str]:
    found = [doubt for one in way.judged for doubt in one.doubts]
    return list(dict.fromkeys([*found, *["geometry"] * any(one.lost for one in way.judged)]))


def _arrow(way: Direction) -> str:
    return f"{signal_words(way.source)} → {signal_words(way.target)}"


def _strength(way: Direction) -> float:
    return float(strongest(way.clear).row["gain_excess"])


def _given_words(found: Prediction, ways: list[Direction]) -> str:
    """What was given, what not, and that a common driver cannot be excluded."""
    asked = found.settings.get("given")
    if found.is_network and asked is None and len(found.signals) > 2:
        return f"Each link was tested with all other signals given; {_DRIVER}."
    names = [signal_words(name) for name in asked or ()]
    left = [name for row in found.cells["not_given"].dropna().unique() for name in row.split(", ") if name]
    others = f", such as {signal_words(left[0])}," if left else ""
    what = f"Given: {listed(names)}" if names else "Nothing else was given"
    return f"{what}; a common driver that was not given{others} can do the same."


def _untested(study: Study, found: Prediction, ways: list[Direction]) -> str:
    parts = []
    for way in ways:
        rows = way.rows[way.rows["gain"].notna()].to_dict("records")
        if rows:
            best = max(rows, key=lambda row: float(row["gain"]))
            where = layer_name(study, int(best["layer"]))
            parts.append(f"{_arrow(way)} {less_error(best['gain'])} in {where}")
    return f"Largest gains, not compared with chance (--surrogates 0): {'; '.join(parts)}."


def _begun(words: str) -> str:
    """Words at the start of a sentence."""
    return f"Edge{words[4:]}" if words.startswith("edge velocity") else capital(words)


def _least(q: float) -> str:
    return f"all q ≥ {q:.2g}" if math.isfinite(q) else "not tested"


def _mean(values: list[float]) -> float:
    known = pd.Series(values).dropna()
    return float(known.mean()) if len(known) else math.nan


def _same_sign(one: JudgedLink, other: JudgedLink) -> bool:
    return bool(one.row["effect"] * other.row["effect"] > 0)
