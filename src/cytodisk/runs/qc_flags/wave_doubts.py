"""What speaks against the wave of a cell, by name and in words."""

from __future__ import annotations

from typing import Any

from cytodisk.analysis.correlation.jitter_mark import JITTERING_SHARE
from cytodisk.analysis.correlation.prepared_series import DRIFTING_SHARE
from cytodisk.analysis.waves.edge_waves import SIGNIFICANT
from cytodisk.number_words import rounded

NEAR_A_LIMIT = 1.15
"""A period so near the shortest or longest that is looked for may be one beyond it."""

WAVE_DOUBTS = (
    "few periods",
    "few frames a period",
    "waves of the cell's motion",
    "drifting waves",
    "waves over restarts",
    "cell's motion not tested",
)
"""Names of the QC flags of a wave, the gravest first."""

HIDING = "jitter hides waves"
"""Name of the QC flag of an edge without waves whose masks jitter."""

_SLOW = 0.5  # of the longest period: a slow trend passes for no faster wave


def doubts_of(row: Any) -> list[str]:
    """Names of the QC flags of a cell's waves.

    Parameters
    ----------
    row : mapping
        Of the table of cells of waves.

    Returns
    -------
    list of str
        What speaks against a wave; where there is none, what may hide one.
    """
    if row["status"] != "ok":
        return []
    if row["kind"] == "none" and not has_inside(row):
        return [HIDING] if row["jitter"] >= JITTERING_SHARE else []
    if row["kind"] == "none":
        return _of_inside(row)
    slow = row["period"] > _SLOW * row["longest_period"]
    raised = {
        "few periods": row["period"] * NEAR_A_LIMIT > row["longest_period"],
        "few frames a period": row["period"] < row["shortest_period"] * NEAR_A_LIMIT,
        "waves of the cell's motion": row["p_partial"] > SIGNIFICANT,
        "drifting waves": slow and row["drifting"] > DRIFTING_SHARE,
        "waves over restarts": row["restarts"] > 0,
        "cell's motion not tested": bool(row["geometry_not_tested"]),
    }
    return [name for name in WAVE_DOUBTS if raised[name]]


def has_inside(row: Any) -> bool:
    """Whether there is a wave through all layers."""
    return str(row.get("inside") or "none") != "none"


def _of_inside(row: Any) -> list[str]:
    """Names of the QC flags of a wave that shows in all layers together alone."""
    raised = {
        "waves of the cell's motion": row["p_inside_partial"] > SIGNIFICANT,
        "waves over restarts": row["restarts"] > 0,
        "cell's motion not tested": bool(row["geometry_not_tested"]),
    }
    return [name for name, is_raised in raised.items() if is_raised]


def wave_doubts(row: Any) -> list[str]:
    """The same in words, as parts of a sentence.

    Parameters
    ----------
    row : mapping
        Of the table of cells of waves.
    """
    words = {
        "few periods": f"the movie holds only {rounded(row['periods'], 2)} periods",
        "few frames a period": f"a period has only {rounded(row['period'], 2)} frames",
        "waves of the cell's motion": f"it is gone without what the motion of the cell alone gives "
        f"(p = {_left(row):.2g})",
        "drifting waves": "the level of many series drifts",
        "waves over restarts": "tracking started anew, so that sectors need not be the same places",
        "cell's motion not tested": "what the motion of the cell alone would give was not tested",
    }
    return [words[name] for name in doubts_of(row) if name in words]


def _left(row: Any) -> float:
    return float(row["p_inside_partial" if row["kind"] == "none" else "p_partial"])
