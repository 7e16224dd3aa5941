"""What a prediction tells: the finding first, then links by layer, what was left out, what was replaced."""

import math
from collections.abc import Iterator
from itertools import groupby
from typing import TYPE_CHECKING, Any

from cytodisk.number_words import counted
from cytodisk.runs.told.layer_peak_words import compartment_words

if TYPE_CHECKING:
    from cytodisk.runs.predict.prediction_verdict import Direction, JudgedLink
    from cytodisk.store.predictions.prediction_store import Prediction
    from cytodisk.store.study import Study

_MOST_FINDINGS = 3  # cells of which sentences are told
_LAYERS_OF = 4  # cells of which layers are told


def prediction_finding_lines(found: "Prediction", study: "Study") -> Iterator[str]:
    """What the prediction shows, in the sentences of the report: over all cells, then of the first cells."""
    from cytodisk.runs.findings.doubt_words import bearing_flags
    from cytodisk.runs.findings.prediction_finding import pooled_finding, prediction_finding
    from cytodisk.runs.qc_flags.study_flags import run_flags

    flags = run_flags(study)
    cells = [int(cell) for cell in found.cells.loc[found.cells["status"] == "ok", "cell"]]
    if len(cells) > 1 and (pooled := pooled_finding(study, found)) is not None:
        yield f"Finding: {pooled.words}"
    for cell in cells[:_MOST_FINDINGS]:
        finding = prediction_finding(study, found, cell, bearing_flags(flags, cell))
        if finding is not None:
            yield f"Finding, cell {cell}: {finding.words}"
    if (more := len(cells) - _MOST_FINDINGS) > 0:
        yield f"… and {counted(more, 'more cell')}: tables links and cells in {found.path}"


def prediction_lines(found: "Prediction", study: "Study") -> Iterator[str]:
    """Links by layer, what was left out, and where the tables are."""
    from cytodisk.runs.predict.prediction_verdict import directions

    settings = found.settings
    held = " and its neighbours'" if settings.get("neighbours", True) else ""
    chance = f"; q of {settings['surrogates']} shifted sources" if settings["surrogates"] else ""
    yield (
        f"Less error: than from the target's own past{held} alone{chance}. Past: how far back the source is "
        "used."
    )
    cells = [int(cell) for cell in found.cells.loc[found.cells["status"] == "ok", "cell"]]
    for cell in cells[:_LAYERS_OF]:
        for way in directions(found, cell):
            yield from _direction_lines(found, study, cell, way)
    if len(cells) > _LAYERS_OF:
        yield f"… links of {counted(len(cells) - _LAYERS_OF, 'more cell')}: links.parquet"
    for row in found.cells[found.cells["status"] != "ok"].itertuples():
        yield f"cell {row.cell} left out: {row.reason}"
    if settings.get("geometry") is False:
        yield "geometry was not tested (--no-geometry)"
    yield from _power_words(found)
    yield f"{counted(len(cells), 'cell')} tested: {found.path}"


def replaced_prediction_words(study: "Study", names: tuple[str, str, str], now: dict[str, Any]) -> str:
    """Which settings the prediction that will be replaced has, if others; empty if there is none."""
    from cytodisk.runs.told.correlation_words import changed_settings

    there = {tuple((*one, "", "", "")[:3]) for one in study.predictions}
    if names not in there:
        return ""
    told = changed_settings(study.prediction(*names).settings, now)
    return f"The earlier prediction ({', '.join(told)}) will be replaced" if told else ""


def _direction_lines(found: "Prediction", study: "Study", cell: int, way: "Direction") -> Iterator[str]:
    """A line for a source and target, then one for each significant layer; others share one."""
    from cytodisk.runs.depth_layers import layer_borders
    from cytodisk.runs.link_words import signal_words
    from cytodisk.windows.study_grid import polar_grid_of

    borders = layer_borders(polar_grid_of(study.provenance))
    given = f", given {way.given}" if way.given else ""
    head = f"cell {cell}, {signal_words(way.source)} → {signal_words(way.target)}{given}"
    judged = {one.layer: one for one in way.judged}
    rows = way.rows.to_dict("records")
    if not judged:
        yield f"{head}: {_nothing(rows)}"
        return
    yield f"{head}, by layer{compartment_words(study)}:"
    for is_nothing, some in groupby(rows, key=lambda row: row["layer"] not in judged):
        group = list(some)
        if is_nothing:
            yield f"  {_layers(group, borders)}: {_nothing(group)}"
            continue
        for row in group:
            yield f"  {_layers([row], borders)}: {_numbers(judged[row['layer']], study)}"


def _numbers(link: "JudgedLink", study: "Study") -> str:
    from cytodisk.runs.correlate.lag_words import time_apart
    from cytodisk.runs.link_words import effect_words, less_error
    from cytodisk.runs.partial_words import SIGNIFICANT

    row, doubts = link.row, link.doubts
    interval = study.scale.frame_interval_s or math.nan
    past = time_apart(row["source_order"], row["source_order"] * interval)
    words = f"{less_error(row['gain'])}, q = {row['q']:.2g}, past {past}; "
    words += effect_words(row["source"], row["target"], row["effect"], link.turns)
    if math.isfinite(row["gain_partial"]):
        left = less_error(max(row["gain_partial"], 0.0)).removesuffix(" less error")
        lost = ""
        if row["geometry"]:
            lost = "mostly gone " if row["q_partial"] < SIGNIFICANT else "not "
        words += f"; {lost}without geometry ({left}, q = {row['q_partial']:.2g})"
    return f"{words}; in doubt: {', '.join(doubts)}" if doubts else words


def _nothing(rows: list[dict[Any, Any]]) -> str:
    known = [row["q"] for row in rows if math.isfinite(row["q"])]
    gains = [row["gain"] for row in rows if math.isfinite(row["gain"])]
    if known:
        return f"nothing, q = {known[0]:.2g}" if len(rows) == 1 else f"nothing, all q ≥ {min(known):.2g}"
    if gains:
        from cytodisk.runs.link_words import less_error

        return f"at most {less_error(max(gains))}, not compared with chance"
    return f"not tested: {rows[0]['reason']}"


def _layers(rows: list[dict[Any, Any]], borders: list[str]) -> str:
    first, last = int(rows[0]["layer"]), int(rows[-1]["layer"])
    if first != last:
        return f"layers {first}–{last}"
    return ", ".join(filter(None, [f"layer {first}", borders[first]]))


def _power_words(found: "Prediction") -> Iterator[str]:
    """How many rows must be beyond all shifts for any q to be below 0.05."""
    surrogates = (
        int(found.cells["surrogates"].dropna().min()) if found.cells["surrogates"].notna().any() else 0
    )
    tested = int(found.links["q"].notna().groupby(found.links["cell"]).sum().max())
    if not surrogates or not tested:
        return
    fewest = tested * 20 // (surrogates + 1) + 1  # q = tested / (number · (surrogates + 1)) < 1 / 20
    if fewest > tested:
        yield f"{surrogates} shifted sources are too few for any q below 0.05: see --surrogates"
    elif fewest > 1:
        enough = tested * 20
        yield (
            f"A link in fewer than {fewest} layers in all cannot reach q < 0.05 among {tested} rows. To find "
            f"one, use --surrogates {-(-enough // 1000) * 1000 - 1}."
        )
