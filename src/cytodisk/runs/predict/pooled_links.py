"""Links over all cells of a study: sums of gains against sums of those of shifted sources."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from cytodisk.analysis.correlation.peaks import false_discovery
from cytodisk.arrays import FloatArray
from cytodisk.runs.partial_words import SIGNIFICANT
from cytodisk.runs.predict.tested_link import TestedLink, weaker_links

_QUANTILE = 0.95
_OWN = ("n", "gain", "gain_reversed")


@dataclass(frozen=True, eq=False)
class _CellGain:
    """Of one cell and layer: rows, gain, that on reversed time, and gains of shifted sources."""

    n: float
    gain: float
    gain_reversed: float
    null: FloatArray


def pooled_table(links: Sequence[TestedLink], seed: int) -> pd.DataFrame:
    """Each link over cells.

    Parameters
    ----------
    links : sequence of TestedLink
        Of all cells.
    seed : int
        Of the order in which the shifted sources of cells come together.

    Returns
    -------
    DataFrame
        One row a source, target and layer; see `POOLED`.

    Notes
    -----
    Gains are weighted by the rows of their model, so that their sum is the joint likelihood ratio.
    Shifts of one cell have nothing to do with those of another, so that any may come together: a cell with
    fewer of them has some again.
    """
    groups: dict[tuple[str, str, str], list[TestedLink]] = {}
    for link in links:
        groups.setdefault((link.source, link.target, ", ".join(link.given)), []).append(link)
    random = np.random.default_rng(seed)
    rows = []
    for (source, target, given), some in groups.items():
        by_layer: dict[int, list[_CellGain]] = {}
        for link in some:
            for layer, one in _gains(link):
                by_layer.setdefault(layer, []).append(one)
        for layer, gains in sorted(by_layer.items()):
            names = {"source": source, "target": target, "given": given, "layer": layer}
            rows.append(names | _pooled(gains, random))
    table = pd.DataFrame(rows)
    if len(table):
        table["q"] = false_discovery(table["p"].to_numpy(dtype=np.float64))
        table["weaker"] = (table["q"] < SIGNIFICANT).to_numpy() & weaker_links(table)
    return table


def _gains(link: TestedLink) -> list[tuple[int, _CellGain]]:
    if link.raw is None:
        return []
    found = []
    for layer in link.raw["layer"].to_numpy():
        one = link.raw.sel(layer=layer)
        if np.isfinite(float(one["gain"])):
            n, gain, gain_reversed = (float(one[name]) for name in _OWN)
            null = one["gain_null"].to_numpy() if "gain_null" in one else np.empty(0)
            null = null[np.isfinite(null)]
            found.append((int(layer), _CellGain(n, gain, gain_reversed, null)))
    return found


def _pooled(cells: Sequence[_CellGain], random: np.random.Generator) -> dict[str, float]:
    weights = np.array([cell.n for cell in cells])
    weights = weights / weights.sum()
    gain = float(weights @ [cell.gain for cell in cells])
    count = min((len(cell.null) for cell in cells), default=0) and max(len(cell.null) for cell in cells)
    reversed_gains = np.array([cell.gain_reversed for cell in cells])
    found = {"cells": len(cells), "gain": gain, "gain_reversed": _mean(reversed_gains, weights)}
    if not count:
        return found | dict.fromkeys(("gain_excess", "p", "threshold"), np.nan)
    drawn = np.array([_drawn(cell.null, count, random) for cell in cells])
    null = weights @ drawn
    own = float(weights @ [cell.null.mean() for cell in cells])
    p = (1 + int((null >= gain).sum())) / (1 + count)
    return found | {"gain_excess": gain - own, "p": p, "threshold": float(np.quantile(null, _QUANTILE))}


def _mean(values: FloatArray, weights: FloatArray) -> float:
    """Weighted mean of what is known; NaN where nothing is."""
    known = np.isfinite(values)
    return float(np.average(values[known], weights=weights[known])) if known.any() else float("nan")


def _drawn(null: FloatArray, count: int, random: np.random.Generator) -> FloatArray:
    """So many of a cell's shifts in any order, each once before one comes again."""
    rounds = [random.permutation(null) for _ in range(-(-count // len(null)))]
    return np.concatenate(rounds)[:count]
