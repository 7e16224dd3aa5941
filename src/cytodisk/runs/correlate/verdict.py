"""What speaks against the significant layers and clusters of a cell's correlation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import groupby
from operator import itemgetter
from typing import Any, Literal

import pandas as pd

from cytodisk.analysis.correlation.jitter_mark import JITTERED_DIFFERENCES, JITTERED_LAGS
from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE
from cytodisk.runs.channel_names import VELOCITIES
from cytodisk.runs.correlate.lag_words import lag_words
from cytodisk.runs.partial_words import SIGNIFICANT, lost_clusters, lost_rows, without_words
from cytodisk.store.correlation_store import Correlation

JITTER, JITTER_UNKNOWN, GEOMETRY_UNTESTED = "jitter", "jitter not known", "geometry not tested"
DRIFTING, RESTARTED = "drifting series", "tracking started anew"
NOTHING = "No layer and no cluster is significant."

_CURED_BY_RANKS = ("common pulse", "restless episode", "variance change", "heavy tails")


@dataclass(frozen=True)
class JudgedPeak:
    """A layer, or a cluster of windows, whose correlation is significant.

    Attributes
    ----------
    kind : {"layer", "cluster"}
    row : dict
        Its row of the table of layers or clusters.
    doubts : tuple of str
        What speaks against it, as "jitter".
    lost : bool
        Whether it is not significant without geometry, or without the controls.
    """

    kind: Literal["layer", "cluster"]
    row: dict[Any, Any]
    doubts: tuple[str, ...]
    lost: bool

    @property
    def name(self) -> str:
        """As "layer 0"."""
        return f"{self.kind} {self.row[self.kind]}"

    @property
    def lag_s(self) -> float:
        """Its lag in seconds; NaN if the frame interval is unknown."""
        return float(self.row.get("lag_s", math.nan))

    @property
    def lag_words(self) -> str:
        """As "lag −20 s"."""
        return lag_words(self.row["lag"], self.lag_s)


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
    clear: list[str] = []
    lost: list[str] = []
    waiting: list[tuple[str, str]] = []
    for peak in judged_peaks(found, cell):
        if peak.lost:
            lost.append(peak.name)
        elif peak.doubts:
            waiting.append((peak.name, ", ".join(peak.doubts)))
        else:
            clear.append(f"{peak.name} ({peak.lag_words})")
    if not (clear or waiting or lost):
        return NOTHING
    words = f"Nothing speaks against: {', '.join(clear)}." if clear else "None is free of doubt."
    if waiting:
        alike = groupby(waiting, key=itemgetter(1))
        told = [f"{', '.join(name for name, _ in some)} ({why})" for why, some in alike]
        words += f" Only after flags are settled: {', '.join(told)}."
    return f"{words} Not {without_words(found, cell)}: {', '.join(lost)}." if lost else words


def judged_peaks(found: Correlation, cell: int) -> list[JudgedPeak]:
    """Each significant layer and cluster of a cell, with what speaks against it.

    Parameters
    ----------
    found : Correlation
        With surrogates.
    cell : int
        That is not left out.

    Returns
    -------
    list of JudgedPeak
        Layers from the edge in, then clusters from the largest on.
    """
    general = tuple(_doubts(found, _row(found, cell)))
    layers = found.layers[(found.layers["cell"] == cell) & (found.layers["q"] < SIGNIFICANT)]
    peaks = list(_judged("layer", found, layers, lost_rows(layers).tolist(), general))
    if found.clusters is not None:
        clusters = found.clusters[found.clusters["cell"] == cell]
        gone = set(lost_clusters(clusters))
        lost = [number in gone for number in clusters["cluster"]]
        peaks += _judged("cluster", found, clusters, lost, general)
    return peaks


def _judged(
    kind: Literal["layer", "cluster"],
    found: Correlation,
    rows: pd.DataFrame,
    lost: list[bool],
    general: tuple[str, ...],
) -> Iterator[JudgedPeak]:
    unknown = "correlation_partial" if kind == "layer" else "p_partial"
    jittered, near = jittered_rows(found, rows).tolist(), _at_lag_of_jitter(found, rows).tolist()
    for row, is_lost, jitters, is_near in zip(rows.to_dict("records"), lost, jittered, near, strict=True):
        unseen = is_near and not math.isfinite(_row(found, row["cell"])["jitter"])
        own = (JITTER,) * jitters + (JITTER_UNKNOWN,) * unseen
        without = without_words(found, row["cell"])
        if without and not math.isfinite(row.get(unknown, math.nan)):
            own += (f"{without} not known",)
        yield JudgedPeak(kind, row, (*general, *own), is_lost)


def _doubts(found: Correlation, row: Any) -> Iterator[str]:
    """What speaks against all of a cell's correlations."""
    if "geometry" in found.settings and not _geometry_tested(found, row["cell"]):
        yield GEOMETRY_UNTESTED
    ranks = row.get("statistic") == "spearman"
    for mark in filter(None, str(row.get("stress") or "").split(", ")):
        if not (ranks and mark in _CURED_BY_RANKS):
            yield mark
    if max(row["drifting_signal"], row["drifting_with"]) > DRIFTING_SHARE:
        yield DRIFTING
    if row.get("restarts", 0):
        yield RESTARTED


def _geometry_tested(found: Correlation, cell: int) -> bool:
    return bool(found.settings.get("geometry")) and _row(found, cell).get("geometry_not_tested", "") == ""


def _at_lag_of_jitter(found: Correlation, rows: pd.DataFrame) -> pd.Series[bool]:
    lags = JITTERED_DIFFERENCES if found.settings.get("difference") else JITTERED_LAGS
    return rows["lag"].isin(lags) & (found.with_ in VELOCITIES)


def _row(found: Correlation, cell: int) -> Any:
    return found.cells[found.cells["cell"] == cell].iloc[0]
