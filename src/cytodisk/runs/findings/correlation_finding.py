"""What a correlation of one cell shows, in sentences."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import pandas as pd

from cytodisk.number_words import counted
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.lag_words import lag_words, time_apart
from cytodisk.runs.correlate.verdict import JudgedPeak, judged_peaks
from cytodisk.runs.findings.doubt_words import doubt_words, doubted_words
from cytodisk.runs.findings.finding import Finding, capital, listed, signed_number
from cytodisk.runs.findings.layer_names import channel_words, layer_name, numbers_words
from cytodisk.runs.partial_words import SIGNIFICANT, without_words
from cytodisk.store.correlation_store import Correlation
from cytodisk.store.study import Study

_ALIKE = 1
"""Frames that the lags of two layers may differ by and still be told as one."""


def correlation_finding(
    study: Study, found: Correlation, cell: int, flagged: Sequence[str] = ()
) -> Finding | None:
    """What a correlation shows in one cell.

    Parameters
    ----------
    study : Study
    found : Correlation
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
    if "q" not in found.layers:
        return _untested(study, found, cell)
    peaks = judged_peaks(found, cell)
    clear = [peak for peak in peaks if not (peak.lost or peak.doubts)]
    waiting = [peak for peak in peaks if peak.doubts and not peak.lost]
    lost = [peak for peak in peaks if peak.lost]
    if clear:
        return _found(study, found, cell, clear, [*waiting, *lost], flagged)
    if waiting or lost:
        return _doubtful(study, found, cell, waiting, lost)
    return _nothing(found, cell, flagged)


def _found(
    study: Study,
    found: Correlation,
    cell: int,
    clear: list[JudgedPeak],
    doubted: list[JudgedPeak],
    flagged: Sequence[str],
) -> Finding:
    best = strongest(clear)
    but = f", but QC flags are raised that bear on it: {listed(list(flagged))}" if flagged else ""
    first = f"{_what(study, found, best)}: {_numbers(found, cell, best)}{but}."
    alike = [peak for peak in clear if peak is not best and _alike(peak, best)]
    second = f"{_sectors(found, cell, best)}{_meaning(found, best)}{_also(alike)}"
    kind: Any = "doubtful" if flagged else "found"
    without = without_words(found, cell)
    words = tuple(filter(None, (capital(first), second, _elsewhere(found, best, doubted, without))))
    return Finding(kind, words, size=abs(best.row["correlation"]))


def _also(alike: list[JudgedPeak]) -> str:
    if not alike:
        return ""
    words = numbers_words("layer", [int(peak.row["layer"]) for peak in alike])
    return f" {words[0].upper()}{words[1:]} {'shows' if len(alike) == 1 else 'show'} the same."


def _elsewhere(found: Correlation, best: JudgedPeak, doubted: list[JudgedPeak], without: str) -> str:
    """In how many other cells it is the same, and what else is significant, with what speaks against it."""
    words = []
    done = sorted(found.cells.loc[found.cells["status"] == "ok", "cell"].astype(int))
    if len(done) == 1:
        words.append("This is one cell: what others do is not known")
    elif best.kind == "layer":
        same = sum(_shows(found, cell, best) for cell in done)
        words.append(f"The same (layer, sign, lag within {_ALIKE} frame) in {same} of {len(done)} cells")
    if doubted:
        words.append(f"{'not' if words else 'Not'} yet to be believed: {doubted_words(doubted, without)}")
    return f"{'; '.join(words)}." if words else ""


def _doubtful(
    study: Study, found: Correlation, cell: int, waiting: list[JudgedPeak], lost: list[JudgedPeak]
) -> Finding:
    best = strongest(waiting or lost)
    without = without_words(found, cell)
    why = doubt_words(best.doubts) if waiting else f"{_left(best)} {without}"
    size = f"correlation {signed_number(best.row['correlation'])}, {_chance(best)}"
    close = "so it is no finding until that is settled" if waiting else "so it is no finding"
    words = f"{capital(_what(study, found, best))} ({size}), but {why}: {close}."
    others = [peak for peak in (*waiting, *lost) if peak is not best]
    told = f"Also significant, and also in doubt: {doubted_words(others, without)}." if others else ""
    return Finding("doubtful", tuple(filter(None, (words, told))), size=abs(best.row["correlation"]))


def _left(peak: JudgedPeak) -> str:
    """What is left of a peak without the controls; the partial correlation may have a peak elsewhere."""
    if peak.kind == "cluster":
        return f"p is {peak.row['p_partial']:.2g}"
    left, q = signed_number(peak.row["correlation_partial"]), peak.row["q_partial"]
    if q < SIGNIFICANT:
        return "less than half of it is left at this lag"
    return f"no more than {left} (q = {q:.2g}) is left" if q == q else f"no more than {left} is left"


def _nothing(found: Correlation, cell: int, flagged: Sequence[str]) -> Finding:
    layers = found.layers[(found.layers["cell"] == cell) & found.layers["correlation"].notna()]
    pair = f"{channel_words(found.signal)} and {_other(found)}{_variant(found)}"
    if layers.empty:
        return Finding(
            "nothing",
            (
                f"{capital(pair)} could not be correlated in any layer: too few frames, or values that never "
                "change.",
            ),
        )
    top = _largest(layers)
    size, at = signed_number(top["correlation"]), lag_words(top["lag"], top.get("lag_s", math.nan))
    first = (
        f"{capital(pair)} show no correlation beyond chance in {_any_of(len(layers))}: the largest is "
        f"{size} in layer {top['layer']} at {at} (q = {top['q']:.2g})."
    )
    words = [first]
    if "threshold" in layers and layers["threshold"].notna().any():
        low, high = (f"{value:.2f}" for value in (layers["threshold"].min(), layers["threshold"].max()))
        span = low if low == high else f"{low} to {high}, by layer,"
        words.append(
            f"Series shuffled in time reach {span} in 5 % of tries: a weaker coupling would not have been "
            "seen in this movie, so this is no proof that there is none."
        )
    if flagged:
        words.append(f"QC flags are raised that may hide one: {listed(list(flagged))}.")
    return Finding("nothing", tuple(words), size=abs(float(top["correlation"])))


def _any_of(layers: int) -> str:
    return f"any of {layers} layers" if layers > 1 else "the one layer there is"


def _untested(study: Study, found: Correlation, cell: int) -> Finding | None:
    """Of a correlation without surrogates."""
    layers = found.layers[(found.layers["cell"] == cell) & found.layers["correlation"].notna()]
    if layers.empty:
        return None
    row = _largest(layers)
    best = JudgedPeak("layer", row, (), False)
    words = (
        f"{capital(_what(study, found, best))}: correlation {signed_number(row['correlation'])}, but "
        "whether that is more than chance was not tested (--surrogates 0)."
    )
    return Finding("doubtful", (words,), size=abs(row["correlation"]))


def _largest(layers: pd.DataFrame) -> dict[Any, Any]:
    """The row of the largest correlation, of either sign."""
    return layers.iloc[int(layers["correlation"].abs().to_numpy().argmax())].to_dict()


def strongest(peaks: list[JudgedPeak]) -> JudgedPeak:
    """The layer with the largest correlation; without a layer, the largest cluster."""
    layers = [peak for peak in peaks if peak.kind == "layer"]
    return max(layers, key=lambda peak: abs(peak.row["correlation"])) if layers else peaks[0]


def _what(study: Study, found: Correlation, peak: JudgedPeak) -> str:
    """As "Rac1 in layer 0 (the edge) rises 15 s before the edge protrudes"."""
    signal, row = channel_words(found.signal), peak.row
    if peak.kind == "layer":
        place = layer_name(study, int(row["layer"]))
    else:
        place = f"sectors {row['sectors']}, layers {row['layers']}"
    verb = "rises" if row["correlation"] > 0 else "falls"
    steps = "the change of " if found.settings.get("difference") else ""
    begun = f"{steps}{signal} in {place} {verb}"
    other = "the edge protrudes" if found.with_ in VELOCITIES else f"{channel_words(found.with_)} rises"
    if not row["lag"]:
        return f"{begun} while {other}{_variant(found)}"
    apart = time_apart(row["lag"], peak.lag_s)
    return f"{begun} {apart} {'before' if row['lag'] > 0 else 'after'} {other}{_variant(found)}"


def _variant(found: Correlation) -> str:
    """The name of a variant, as " (early frames)"."""
    return f" ({found.name})" if found.name else ""


def _numbers(found: Correlation, cell: int, peak: JudgedPeak) -> str:
    row = peak.row
    size = f"correlation {signed_number(row['correlation'])}"
    without = without_words(found, cell)
    left: Any = row.get("correlation_partial" if peak.kind == "layer" else "p_partial")
    known = bool(without) and pd.notna(left)
    if peak.kind == "cluster":
        of = f" in {row['windows']} neighbouring windows, {_chance(peak)}"
        return f"{size}{of} ({left:.2g} {without})" if known else f"{size}{of}"
    partial = f" ({signed_number(left)}{_at_other_lag(peak)} {without})" if known else ""
    return f"{size}{partial}, {_chance(peak)}"


def _at_other_lag(peak: JudgedPeak) -> str:
    """The lag of the partial correlation, as " at lag +35 s"; empty where it is that of the peak."""
    lag, other = peak.row["lag"], peak.row.get("lag_partial", math.nan)
    if not abs(other - lag) > _ALIKE:
        return ""
    return f" at {lag_words(other, other * peak.lag_s / lag if lag else math.nan)}"


def _chance(peak: JudgedPeak) -> str:
    return f"q = {peak.row['q']:.2g}" if peak.kind == "layer" else f"p = {peak.row['p']:.2g}"


def _sectors(found: Correlation, cell: int, peak: JudgedPeak) -> str:
    """How many single windows of a layer show the same, and how many would by chance.

    Of series without a coupling, one in twenty has p < 0.05; half of these have the other sign, and many
    another lag.
    """
    rows = found.windows[(found.windows["cell"] == cell) & (found.windows["layer"] == peak.row.get("layer"))]
    tested = rows[rows["p"].notna()] if "p" in rows else rows[:0]
    if tested.empty:
        return ""
    near = (tested["lag"] - peak.row["lag"]).abs() <= _ALIKE
    same = (tested["p"] < SIGNIFICANT) & near & (tested["correlation"] * peak.row["correlation"] > 0)
    chance = SIGNIFICANT / 2 * len(tested)
    expected = f"at most about {chance:.0f}" if chance >= 1 else "fewer than 1"
    return (
        f"{int(same.sum())} of {counted(len(tested), 'sector')} show it by themselves (p < 0.05, lag within "
        f"{_ALIKE} frame); series shuffled in time would give {expected}. "
    )


def _meaning(found: Correlation, peak: JudgedPeak) -> str:
    other = "the edge" if found.with_ in VELOCITIES else channel_words(found.with_)
    signal, lag = channel_words(found.signal), peak.row["lag"]
    if not lag:
        return "Both change in the same frame: which comes first cannot be told at this frame interval."
    if lag > 0:
        return f"{capital(signal)} comes first, as a cause would; that alone does not make it the cause."
    return f"{capital(other)} comes first, and {signal} follows."


def _alike(peak: JudgedPeak, best: JudgedPeak) -> bool:
    if peak.kind != "layer" or best.kind != "layer":
        return False
    near = abs(peak.row["lag"] - best.row["lag"]) <= _ALIKE
    return bool(near and peak.row["correlation"] * best.row["correlation"] > 0)


def _shows(found: Correlation, cell: int, best: JudgedPeak) -> bool:
    """Whether a cell shows the same as the best peak of another, and nothing speaks against it there."""
    there = [
        peak for peak in judged_peaks(found, cell) if peak.kind == "layer" and not (peak.lost or peak.doubts)
    ]
    return any(peak.row["layer"] == best.row["layer"] and _alike(peak, best) for peak in there)


def _other(found: Correlation) -> str:
    return "edge velocity" if found.with_ in VELOCITIES else channel_words(found.with_)
