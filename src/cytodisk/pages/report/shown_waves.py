"""Waves of a cell as the page shows them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.pages.report.encode import pack_floats
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_names import labels_of
from cytodisk.runs.channel_names import VELOCITIES, shown_name
from cytodisk.runs.findings.waves_finding import waves_finding
from cytodisk.store.waves.waves_store import Waves

MOST_PHASES = 600_000
"""Numbers of phase that a page holds of one cell; of more than that only the chosen layer's are shown."""

_LONGEST_NAME = 24
_NUMBERS = ("period_s", "period", "speed_um_s", "direction", "persistence_s", "order", "p", "q", "mode")
_INSIDE = ("depth", "inward_speed", "around_speed")


def waves_of(cell: ShownCell, flagged: tuple[str, ...] = ()) -> tuple[list[dict[str, Any]], list[str]]:
    """The waves of every signal for one cell, those of velocity first.

    Parameters
    ----------
    cell : ShownCell
    flagged : tuple of str
        Names of the QC flags that bear on the cell's results.

    Returns
    -------
    waves : list of dict
        For the page's scripts: label, finding, numbers by layer and phase; empty if none were looked for in
        this cell.
    notes : list of str
        What was left out, in words.
    """
    names = sorted(cell.study.wave_signals, key=lambda one: one[0] not in VELOCITIES)
    opened = [(one, cell.study.waves(*one)) for one in names]
    known = [(one, found) for one, found in opened if (found.layers["cell"] == cell.cell).any()]
    labels = labels_of([((one[0], "itself", *one[1:]), found.settings) for one, found in known])
    notes: list[str] = []
    shown = []
    for label, (_, found) in zip(labels, known, strict=True):
        one, whole = _waves(cell, found, flagged)
        shown.append({"label": label.replace(" with itself", "")} | one)
        if not whole:
            notes.append(f"phase of waves of {found.signal} in layers but {one['chosen']}")
    return shown, notes


def _waves(cell: ShownCell, found: Waves, flagged: tuple[str, ...]) -> tuple[dict[str, Any], bool]:
    finding = waves_finding(cell.study, found, cell.cell, flagged)
    layers = found.layers[found.layers["cell"] == cell.cell]
    of_edge = found.signal in VELOCITIES
    chosen = 0 if of_edge else int(found.settings.get("layer") or 0)
    places = [0] if of_edge else [int(layer) for layer in layers["layer"]]
    whole = len(places) * len(cell.frames) * cell.grid.sectors <= MOST_PHASES
    depths = None if found.depths is None else found.depths[found.depths["cell"] == cell.cell]
    rows = layers.assign(place=places)
    return {
        "kind": "" if finding is None else finding.kind,
        "finding": [] if finding is None else list(finding.sentences),
        "head": 1,
        "signal": shown_name(found.signal, _LONGEST_NAME),
        "edge": of_edge,
        "channel": cell.channels.index(found.signal) if found.signal in cell.channels else None,
        "chosen": chosen,
        "layers": [_row(row, depths) for row in rows.to_dict("records")],
        "phase": _phases(cell, found, places if whole else [chosen]),
        "inside_unit": found.layers.attrs.get("units", {}).get("edge_speed", ""),
    }, whole


def _row(row: dict[Any, Any], depths: pd.DataFrame | None) -> dict[str, Any]:
    """Numbers of a layer, and of waves inside at its depth."""
    told: dict[str, Any] = {"layer": int(row["place"]), "kind": str(row["kind"] or "")}
    told |= {name: _number(row.get(name)) for name in _NUMBERS}
    told["reason"] = str(row.get("reason") or "")
    if depths is not None and (own := depths[depths["layer"] == row["place"]]).shape[0]:
        told |= {name: _number(own.iloc[0].get(name)) for name in _INSIDE}
        told["inside"] = str(own.iloc[0].get("inside") or "")
    return told


def _number(value: Any) -> float:
    return float("nan") if pd.isna(value) else float(value)


def _phases(cell: ShownCell, found: Waves, layers: list[int]) -> dict[str, Any]:
    """Phase in the shown frames, by layer, frame and sector."""
    rows = found.phase[found.phase["cell"] == cell.cell]
    return {str(layer): pack_floats(_phase(cell, rows, layer)) for layer in layers}


def _phase(cell: ShownCell, rows: pd.DataFrame, layer: int) -> FloatArray:
    own = rows[rows["layer"].fillna(0) == layer]
    places = {frame: place for place, frame in enumerate(cell.frames)}
    own = own[own["frame"].isin(places)]
    values = np.full((len(cell.frames), cell.grid.sectors), np.nan)
    values[own["frame"].map(places).to_numpy(), own["sector"].to_numpy()] = own["phase"].to_numpy(np.float64)
    return values
