"""Predictions of a cell as the page shows them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.pages.report.encode import pack_floats
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_names import labels_of
from cytodisk.plot.prediction.link_looks import ALPHA, lost_in
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.findings.prediction_finding import prediction_finding
from cytodisk.store.predictions.prediction_store import Prediction

_LONGEST_NAME = 24
_BY_LAYER = ("gain_excess", "q", "gain_excess_partial", "q_partial", "effect")


def predictions_of(cell: ShownCell, flagged: tuple[str, ...] = ()) -> list[dict[str, Any]]:
    """Every prediction of a study for one cell, networks first.

    Parameters
    ----------
    cell : ShownCell
    flagged : tuple of str
        Names of the QC flags that bear on the cell's results.

    Returns
    -------
    list of dict
        For the page's scripts: label, finding, signals, and links with their numbers by layer; empty if
        nothing was tested in this cell. "lost" layers of a link do not count, as geometry or noise of
        measurement may have made them; a link is "doubtful" if all its significant layers are.
    """
    names = sorted(cell.study.predictions, key=lambda one: bool(one and one[0]))
    opened = [(one, cell.study.prediction(*one)) for one in names]
    known = [(one, found) for one, found in opened if (found.links["cell"] == cell.cell).any()]
    labels = labels_of([(_names(one), found.settings) for one, found in known])
    return [
        {"label": label} | _prediction(cell, found, flagged)
        for label, (_, found) in zip(labels, known, strict=True)
    ]


def _names(names: tuple[str, ...]) -> tuple[str, ...]:
    """Names as those of a correlation are, for its label."""
    source, target, *name = names or ("", "")
    return (source, target, *name) if source else ("network", "all signals", *name)


def _prediction(cell: ShownCell, found: Prediction, flagged: tuple[str, ...]) -> dict[str, Any]:
    finding = prediction_finding(cell.study, found, cell.cell, flagged)
    links = found.links[found.links["cell"] == cell.cell]
    groups = links.groupby(["source", "target"], sort=False)
    return {
        "kind": "" if finding is None else finding.kind,
        "finding": [] if finding is None else list(finding.sentences),
        "head": 1 if found.is_network else 2,  # a pair: one direction, and the other
        "signals": list(dict.fromkeys([*map(str, links["source"]), *map(str, links["target"])])),
        "names": {name: shown_name(name, _LONGEST_NAME) for name in {*links["source"], *links["target"]}},
        "links": [_link(cell, str(source), str(target), rows) for (source, target), rows in groups],
    }


def _link(cell: ShownCell, source: str, target: str, rows: pd.DataFrame) -> dict[str, Any]:
    known = rows.dropna(subset="q")
    found, lost = known["q"] < ALPHA, lost_in(known)
    counted = known[found & ~lost]
    best = _least(counted if len(counted) else known)
    return {
        "source": source,
        "target": target,
        "given": str(rows["given"].iloc[0] or ""),
        "reasons": list(dict.fromkeys(str(words) for words in rows["reason"].dropna() if words)),
        "best_q": np.nan if best is None else float(best["q"]),
        "best_gain": np.nan if best is None else float(best["gain_excess"]),
        "doubtful": bool(found.any() and counted.empty),
        "lost": pack_floats(_layers(cell, rows.assign(lost=lost_in(rows)), "lost")),
        **{name: pack_floats(_layers(cell, rows, name)) for name in _BY_LAYER},
    }


def _least(rows: pd.DataFrame) -> pd.Series | None:
    """The row with the smallest q; None of none."""
    return rows.iloc[int(rows["q"].to_numpy().argmin())] if len(rows) else None


def _layers(cell: ShownCell, rows: pd.DataFrame, name: str) -> FloatArray:
    values = np.full(cell.grid.layers, np.nan)
    if name in rows:
        values[rows["layer"].to_numpy()] = rows[name].to_numpy(dtype=np.float64)
    return values
