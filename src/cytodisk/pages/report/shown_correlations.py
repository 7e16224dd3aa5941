"""Correlations of a cell as the page shows them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.pages.report.encode import pack_floats
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.pages.report.shown_names import differences, labels_of
from cytodisk.runs.channel_names import correlation_name, shown_name
from cytodisk.runs.correlate.cluster_words import cluster_line
from cytodisk.runs.partial_words import not_tested, region_left, windows_lost, without_words
from cytodisk.store.correlation_store import Correlation

MOST_CURVE_NUMBERS = 900_000
"""Of curves of single windows that a page holds; beyond, only peaks and the layers' curves are shown."""

MOST_CLUSTERS = 3
"""Clusters that are listed; the table has them all."""

_PEAK = ("correlation", "lag", "p", "q", "threshold")  # low and high hold for a lag chosen beforehand
_LAYER_PEAK = (*_PEAK, "correlation_partial", "q_partial")
_CURVE = ("correlation", "low", "high")


def pairs_of(cell: ShownCell, most: int = MOST_CURVE_NUMBERS) -> tuple[list[dict[str, Any]], list[str]]:
    """Every correlation of a study for one cell.

    Parameters
    ----------
    cell : ShownCell
    most : int
        Numbers of curves of single windows.

    Returns
    -------
    pairs : list of dict
        For the page's scripts, those with velocity first; empty if nothing was correlated. What was not
        computed, as p and q without surrogates, is NaN.
    notes : list of str
        What was left out, in words.
    """
    names = sorted(cell.study.correlations, key=lambda names: not names[1].startswith("velocity"))
    found = [(pair, cell.study.correlation(*pair)) for pair in names]
    known = [(pair, one) for pair, one in found if len(_of(cell, one.windows))]
    shown = {pair for pair, _ in known}
    notes = [
        f"correlation of {correlation_name(pair)}, which this cell has not"
        for pair in names
        if pair not in shown
    ]
    numbers = sum(len(_of(cell, one.curves)) * len(_CURVE) for _, one in known)
    with_curves = numbers <= most
    if not with_curves:
        notes.append("correlation curves of single windows (only those of layers are shown)")
    labels = labels_of([(pair, one.settings) for pair, one in known])
    pairs = [
        {"label": label, "differs": differences(one.settings)} | _pair(cell, one, with_curves)
        for label, (_, one) in zip(labels, known, strict=True)
    ]
    return pairs, notes


def _pair(cell: ShownCell, found: Correlation, with_curves: bool) -> dict[str, Any]:
    windows, layers = _of(cell, found.windows), _of(cell, found.layers)
    layer_curves = _of(cell, found.layer_curves)
    curves = _of(cell, found.curves) if with_curves else None
    lags = np.unique(pd.concat([table["lag"] for table in (layer_curves, curves) if table is not None]))
    return {
        "signal": shown_name(found.signal),
        "channel": cell.channels.index(found.signal) if found.signal in cell.channels else 0,
        "with": shown_name(found.with_),
        "lags": lags.tolist(),
        "peak_notes": [*_clusters(cell, found), *_lost(cell, found)],
        "windows": {name: pack_floats(_grid(cell, windows, name)) for name in _PEAK},
        "curves": None if curves is None else dict(_curves(cell, curves, lags)),
        "layers": {name: pack_floats(_layer(cell, layers, name)) for name in _LAYER_PEAK},
        "layer_curves": pack_floats(_curve(cell, layer_curves, "correlation", lags)),
        "layer_partial": pack_floats(_curve(cell, layer_curves, "correlation_partial", lags)),
        "without": without_words(found, cell.cell),
    }


def _curves(cell: ShownCell, curves: pd.DataFrame, lags: Any) -> Iterator[tuple[str, Any]]:
    for name in _CURVE:
        yield name, pack_floats(_curve(cell, curves, name, lags))


def _clusters(cell: ShownCell, found: Correlation) -> list[str]:
    """The largest clusters in words; empty where they were not looked for."""
    if found.clusters is None:
        return []
    clusters = _of(cell, found.clusters)
    if clusters.empty:
        return ["no cluster of neighbouring windows with p ≤ 0.05"]
    without = without_words(found, cell.cell)
    told = list(clusters.head(MOST_CLUSTERS).itertuples())
    parts = [(cluster_line(row), region_left(row, without)) for row in told]
    lines = ["; ".join(filter(None, part)) for part in parts]
    more = len(clusters) - len(told)
    return [*lines, f"and {more} smaller"] if more else lines


def _lost(cell: ShownCell, found: Correlation) -> list[str]:
    """How many windows do not survive without the controls, and whether geometry is one; often nothing."""
    words = windows_lost(_of(cell, found.windows), without_words(found, cell.cell))
    return [line for line in (words, not_tested(found)) if line]


def _of(cell: ShownCell, table: pd.DataFrame) -> pd.DataFrame:
    return table[table["cell"] == cell.cell]


def _grid(cell: ShownCell, table: pd.DataFrame, name: str) -> FloatArray:
    values = np.full((cell.grid.layers, cell.grid.sectors), np.nan)
    if name in table:
        values[table["layer"].to_numpy(), table["sector"].to_numpy()] = table[name].to_numpy(dtype=np.float64)
    return values


def _layer(cell: ShownCell, table: pd.DataFrame, name: str) -> FloatArray:
    values = np.full(cell.grid.layers, np.nan)
    if name in table:
        values[table["layer"].to_numpy()] = table[name].to_numpy(dtype=np.float64)
    return values


def _curve(cell: ShownCell, table: pd.DataFrame, name: str, lags: Any) -> FloatArray:
    """By layer, sector if the table has one, and lag."""
    axes = [table["layer"].to_numpy(), np.searchsorted(lags, table["lag"].to_numpy())]
    shape = [cell.grid.layers, len(lags)]
    if "sector" in table:
        axes.insert(1, table["sector"].to_numpy())
        shape.insert(1, cell.grid.sectors)
    values = np.full(shape, np.nan)
    if name in table:
        values[tuple(axes)] = table[name].to_numpy(dtype=np.float64)
    return values
