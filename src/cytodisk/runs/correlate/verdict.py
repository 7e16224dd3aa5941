"""What speaks against the significant layers and clusters of a cell's correlation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import groupby
from operator import itemgetter
from typing import Any

import pandas as pd

from cytodisk.analysis.correlation.jitter_mark import JITTERED_DIFFERENCES, JITTERED_LAGS
from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.lag_words import lag_words
from cytodisk.runs.partial_words import SIGNIFICANT, lost_clusters, lost_rows, without_words
from cytodisk.store.correlation_store import Correlation

_CURED_BY_RANKS = ("common pulse", "restless episode", "variance change", "heavy tails")


def jittered_rows(found: Correlation, rows: pd.DataFrame) -> pd.Series[bool]:
    """Which peaks of a cell lie at a lag that jitter of the masks makes, where jitter was seen.

    Parameters
    ----------
    found : Correlation
    rows : DataFrame
        Of its layers or clusters, with cell and lag.

    Returns
    -------
    Series of bool
    """
    step = found.cells.set_index("cell")["jitter"].reindex(rows["cell"]).abs().to_numpy()
    return _at_lag_of_jitter(found, rows) & pd.Series(step > 0, index=rows.index)


def verdict_words(found: Correlation, cell: int) -> str:
    """What of a cell's correlation nothing known speaks against, and what it waits for.

    Parameters
    ----------
    found : Correlation
    cell : int

    Returns
    -------
    str
        As "Nothing speaks against: layer 0 (lag −6 s). Only after flags are settled: layer 1 (jitter)." Empty
        without surrogates, and of a cell that was left out.
    """
    row = found.cells[found.cells["cell"] == cell].iloc[0]
    if row["status"] != "ok" or "q" not in found.layers:
        return ""
    general = list(_doubts(found, row))
    clear: list[str] = []
    lost: list[str] = []
    waiting: list[tuple[str, str]] = []
    for name, lag, doubts, is_lost in _significant(found, cell):
        if is_lost:
            lost.append(name)
        elif every := [*general, *doubts]:
            waiting.append((name, ", ".join(every)))
        else:
            clear.append(f"{name} ({lag})")
    if not (clear or waiting or lost):
        return "No layer and no cluster is significant."
    words = f"Nothing speaks against: {', '.join(clear)}." if clear else "None is free of doubt."
    if waiting:
        alike = groupby(waiting, key=itemgetter(1))
        told = [f"{', '.join(name for name, _ in some)} ({why})" for why, some in alike]
        words += f" Only after flags are settled: {', '.join(told)}."
    return f"{words} Not {without_words(found, cell)}: {', '.join(lost)}." if lost else words


def _significant(found: Correlation, cell: int) -> Iterator[tuple[str, str, list[str], bool]]:
    """Name, lag, doubts of each significant layer and cluster, and whether it is lost without controls."""
    layers = found.layers[(found.layers["cell"] == cell) & (found.layers["q"] < SIGNIFICANT)]
    yield from _told("layer", found, layers, lost_rows(layers).tolist())
    if found.clusters is not None:
        clusters = found.clusters[found.clusters["cell"] == cell]
        lost = set(lost_clusters(clusters))
        yield from _told("cluster", found, clusters, [number in lost for number in clusters["cluster"]])


def _told(
    kind: str, found: Correlation, rows: pd.DataFrame, lost: list[bool]
) -> Iterator[tuple[str, str, list[str], bool]]:
    unknown = "correlation_partial" if kind == "layer" else "p_partial"
    jittered, near = jittered_rows(found, rows).tolist(), _at_lag_of_jitter(found, rows).tolist()
    for row, is_lost, jitters, is_near in zip(rows.to_dict("records"), lost, jittered, near, strict=True):
        unseen = is_near and not math.isfinite(_row(found, row["cell"])["jitter"])
        doubts = ["jitter"] * jitters + ["jitter not known"] * unseen
        without = without_words(found, row["cell"])
        if without and not math.isfinite(row.get(unknown, math.nan)):
            doubts.append(f"{without} not known")
        yield f"{kind} {row[kind]}", lag_words(row["lag"], row.get("lag_s", math.nan)), doubts, is_lost


def _doubts(found: Correlation, row: Any) -> Iterator[str]:
    """What speaks against all of a cell's correlations."""
    if "geometry" in found.settings and not _geometry_tested(found, row["cell"]):
        yield "geometry not tested"
    ranks = row.get("statistic") == "spearman"
    for mark in filter(None, str(row.get("stress") or "").split(", ")):
        if not (ranks and mark in _CURED_BY_RANKS):
            yield mark
    if max(row["drifting_signal"], row["drifting_with"]) > DRIFTING_SHARE:
        yield "drifting series"
    if row["restarts"]:
        yield "tracking started anew"


def _geometry_tested(found: Correlation, cell: int) -> bool:
    return bool(found.settings.get("geometry")) and _row(found, cell).get("geometry_not_tested", "") == ""


def _at_lag_of_jitter(found: Correlation, rows: pd.DataFrame) -> pd.Series[bool]:
    lags = JITTERED_DIFFERENCES if found.settings.get("difference") else JITTERED_LAGS
    return rows["lag"].isin(lags) & (found.with_ in VELOCITIES)


def _row(found: Correlation, cell: int) -> Any:
    return found.cells[found.cells["cell"] == cell].iloc[0]
