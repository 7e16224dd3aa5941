"""What was regressed out of a correlation, and what that left, in words."""

from __future__ import annotations

from typing import Any

import pandas as pd

from cytodisk.runs.channel_names import shown_name
from cytodisk.store.correlation_store import Correlation

SIGNIFICANT = 0.05


def without_words(found: Correlation, cell: int) -> str:
    """What was regressed out of a cell's signals.

    Parameters
    ----------
    found : Correlation
    cell : int

    Returns
    -------
    str
        As "without geometry and volume"; empty for nothing.
    """
    settings, cells = found.settings, found.cells
    names = [shown_name(name) for name in settings.get("control") or ()]
    if settings.get("geometry") and "geometry_not_tested" in cells:
        reasons = cells.loc[cells["cell"] == cell, "geometry_not_tested"]
        names = ["geometry"] * bool((reasons == "").any()) + names
    words = " and ".join(filter(None, [", ".join(names[:-1]), *names[-1:]]))
    return f"without {words}" if words else ""


def not_tested(found: Correlation) -> str:
    """That geometry was not to be regressed out, in words; empty if it was."""
    skipped = found.settings.get("geometry") is False
    return "geometry was not tested (--no-geometry)" if skipped else ""


def lost_rows(rows: pd.DataFrame) -> pd.Series[bool]:
    """Which rows of a table of layers, or of windows, do not survive; none without surrogates."""
    if "geometry" not in rows:
        return pd.Series(False, index=rows.index)
    return rows["geometry"].fillna(False).astype(bool)


def region_lost(p_partial: Any) -> Any:
    """Whether a cluster does not survive: those that are told all have p <= 0.05; False where it is NaN."""
    return p_partial > SIGNIFICANT


def region_left(row: Any, without: str) -> str:
    """How significant a cluster is once the controls are regressed out.

    Parameters
    ----------
    row : object
        A row of the table of clusters, as of `itertuples`.
    without : str
        Of `without_words`.

    Returns
    -------
    str
        As "not without geometry (p = 0.4)" or "without geometry p = 0.01"; empty where that is not known.
    """
    p = getattr(row, "p_partial", None)
    if p is None or pd.isna(p):
        return ""
    return f"not {without} (p = {p:.2g})" if region_lost(p) else f"{without} p = {p:.2g}"


def lost_clusters(clusters: pd.DataFrame) -> list[int]:
    """Numbers of the clusters of a cell that do not survive."""
    if "p_partial" not in clusters:
        return []
    return [int(number) for number in clusters.loc[region_lost(clusters["p_partial"]), "cluster"]]


def windows_lost(windows: pd.DataFrame, without: str) -> str:
    """How many windows of a cell do not survive.

    Parameters
    ----------
    windows : DataFrame
        Its rows of the table of windows.
    without : str
        Of `without_words`.

    Returns
    -------
    str
        As "12 of 61 windows with q < 0.05 do not survive without geometry"; empty if all do.
    """
    lost = int(lost_rows(windows).sum())
    if not lost:
        return ""
    found = int((windows["q"] < SIGNIFICANT).sum())
    return f"{lost} of {found} windows with q < {SIGNIFICANT:g} do not survive {without}"
