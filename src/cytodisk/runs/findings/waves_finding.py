"""What waves were found in a cell, in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.findings.finding import Finding, listed
from cytodisk.runs.findings.layer_names import channel_words, layer_name
from cytodisk.runs.findings.wave_words import (
    chance_words,
    course_words,
    period_words,
    speed_words,
    time_words,
    wave_numbers,
    waves_around,
)
from cytodisk.runs.qc_flags.wave_doubts import has_inside, wave_doubts
from cytodisk.store.study import Study
from cytodisk.store.waves.waves_store import Waves

_OF_SIGNALS = ("saturated signal", "clipped signal", "signal drift")  # which the edge knows nothing of
_KINDS = ("rotating", "standing", "oscillating")


def waves_finding(study: Study, found: Waves, cell: int, flagged: Sequence[str] = ()) -> Finding | None:
    """What waves a cell has, which way they run on the picture, how fast, and what speaks against them.

    Parameters
    ----------
    study : Study
    found : Waves
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
    row = rows.iloc[0]
    if found.signal in VELOCITIES:
        flagged = [name for name in flagged if name not in _OF_SIGNALS]
    if row["kind"] not in _KINDS:
        return (_inside_alone if has_inside(row) else _nothing)(study, found, row, flagged)
    doubts = wave_doubts(row)
    said = f"{_what(study, found, row)}: {wave_numbers(row, study.scale)}, {chance_words(row)}"
    sentences = [f"{said}{_but(doubts, flagged)}."]
    more = course_words(row, study.scale) if row["kind"] == "rotating" else ""
    sentences.append(" ".join(filter(None, [more, _inside(study, row), _one_around(found, row)])))
    sentences.append(_others(found))
    kind: Any = "doubtful" if doubts or flagged else "found"
    return Finding(kind, tuple(filter(None, sentences)), size=float(row["order"]))


def waves_summary(study: Study, found: Waves) -> str:
    """How many cells have waves, of which kind, and their median numbers, as a sentence.

    Parameters
    ----------
    study : Study
    found : Waves

    Returns
    -------
    str
        As "Edge velocity: waves in 5 of 12 cells (3 clockwise, 1 anticlockwise, 1 standing); in the median
        period 95 s and 0.12 µm/s."
    """
    done = found.cells[found.cells["status"] == "ok"]
    waving = done[done["kind"].isin(_KINDS)]
    head = f"{_of_what(study, found, done)}: waves in {len(waving)} of {counted(len(done), 'cell')}"
    if waving.empty:
        return f"{head}."
    words = [
        f"{count} {name}"
        for name in ("clockwise", "anticlockwise", "standing", "oscillating as a whole")
        if (count := sum(_kind_words(row) == name for _, row in waving.iterrows()))
    ]
    period = period_words({"period": float(waving["period"].median())}, study.scale)
    running = waving[waving["kind"] == "rotating"]["edge_speed"].abs().dropna()
    speed = (
        f" and {speed_words(float(running.median()), study.scale, float(done['frames'].max()))}"
        if len(running)
        else ""
    )
    return f"{head} ({', '.join(words)}); in the median {period}{speed}."


def _kind_words(row: Any) -> str:
    return str(row["way"] or "") or (
        "oscillating as a whole" if row["kind"] == "oscillating" else str(row["kind"])
    )


def _of_what(study: Study, found: Waves, rows: pd.DataFrame) -> str:
    """As "Edge velocity" or "Rac1 in layer 0 (outermost)"."""
    if found.signal in VELOCITIES:
        return "Edge velocity"
    layer = rows["layer"].dropna()
    where = f" in {layer_name(study, int(layer.iloc[0]))}" if len(layer) else ""
    return f"{channel_words(found.signal)}{where}"


def _what(study: Study, found: Waves, row: Any) -> str:
    """As "Waves run along the edge of cell 3"."""
    cell, variant = f"cell {row['cell']}", f" ({found.name})" if found.name else ""
    if found.signal in VELOCITIES:
        own = " in its own frame" if found.signal == "velocity_cell_frame" else ""
        begun = {
            "rotating": f"Waves run along the edge of {cell}",
            "standing": f"A standing wave moves the edge of {cell} out and in",
            "oscillating": f"The whole edge of {cell} moves out and in at once",
        }[row["kind"]]
        return f"{begun}{own}{variant}"
    place = f"{layer_name(study, int(row['layer']))} of {cell}"
    signal = channel_words(found.signal)
    begun = {
        "rotating": f"Waves of {signal} run around in {place}",
        "standing": f"{signal} rises and falls in a standing wave in {place}",
        "oscillating": f"{signal} rises and falls all around at once in {place}",
    }[row["kind"]]
    return f"{begun[0].upper()}{begun[1:]}{variant}" if begun.startswith("signal ") else f"{begun}{variant}"


def _but(doubts: Sequence[str], flagged: Sequence[str]) -> str:
    words = [f"but {' and '.join(doubts)}"] if doubts else []
    if flagged:
        words.append(
            f"{'and' if doubts else 'but'} QC flags are raised that bear on it: {listed(list(flagged))}"
        )
    return f", {', '.join(words)}" if words else ""


def _inside(study: Study, row: Any) -> str:
    """What the wave through all layers does, as a sentence; empty where there is none."""
    if not has_inside(row):
        return ""
    p, frames = f"p = {row['p_inside']:.2g}", row["frames"]
    if row["inside"] in ("inwards", "outwards", "spiral"):
        way = "outwards" if row["inward_speed"] < 0 else "inwards"
        speed = speed_words(row["inward_speed"], study.scale, frames)
        known = f" at {speed}" if math.isfinite(row["inward_speed"]) else ""
        spiral = f"as a spiral, {row['inside_way']} and " if row["inside"] == "spiral" else ""
        return f"Through all layers crests run {spiral}{way}{known} ({p})."
    if row["inside"] == "around":
        return f"All layers take part: crests run around together, neither inwards nor outwards ({p})."
    return f"All layers take part: crests run neither around nor inwards or outwards ({p})."


def _one_around(found: Waves, row: Any) -> str:
    """What else one wave around the cell could be."""
    if found.signal != "velocity" or row["mode"] != 1:
        return ""
    moves = "moves in circles" if row["kind"] == "rotating" else "goes to and fro"
    return f"With one wave around, the whole cell {moves}: a stage that does so looks the same."


def _others(found: Waves) -> str:
    """In how many other cells there are waves, and which way they run."""
    done = found.cells[found.cells["status"] == "ok"]
    if len(done) == 1:
        return "This is one cell: what others do is not known."
    ways = [_kind_words(row) for _, row in done[done["kind"].isin(_KINDS)].iterrows()]
    counts = listed([f"{ways.count(way)} {way}" for way in dict.fromkeys(ways)])
    return f"Waves in {len(ways)} of {counted(len(done), 'cell')} ({counts})."


def _inside_alone(study: Study, found: Waves, row: Any, flagged: Sequence[str]) -> Finding:
    """A wave that shows in all layers together, but not in the chosen one alone."""
    doubts, signal = wave_doubts(row), channel_words(found.signal)
    numbers = [waves_around(row["inside_mode"])] if row["inside_mode"] else []
    numbers.append(f"period {time_words(row['inside_period'], study.scale)}")
    words = (
        f"Waves of {signal} run through all layers of cell {row['cell']}: {', '.join(numbers)}, "
        f"p = {row['p_inside']:.2g}{_but(doubts, flagged)}.",
        f"{_inside(study, row)} By itself {layer_name(study, int(row['layer']))} shows none beyond chance "
        f"({chance_words(row)}).",
        _others(found),
    )
    kind: Any = "doubtful" if doubts or flagged else "found"
    return Finding(kind, words, size=float(row["inside_order"]))


def _nothing(study: Study, found: Waves, row: Any, flagged: Sequence[str]) -> Finding:
    scale = study.scale
    what = "the edge velocity" if found.signal in VELOCITIES else _of_what(study, found, pd.DataFrame([row]))
    like = f"{waves_around(row['mode'])}, {period_words(row, scale)}" if math.isfinite(row["mode"]) else ""
    best = f": what is most like one is {like} ({chance_words(row)})" if like else ""
    words = [
        f"No waves beyond chance in {what} of cell {row['cell']}{best}.",
        "Weak or short-lived waves may be missed, so this is no proof that there are none.",
    ]
    if flagged:
        words.append(f"QC flags are raised that may hide some: {listed(list(flagged))}.")
    return Finding("nothing", tuple(words), size=float(row["order"]))
