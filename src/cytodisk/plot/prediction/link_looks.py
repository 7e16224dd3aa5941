"""What pictures of predictions have in common: colours, marks, gains in percent, rows of a cell."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.correlation.lag_axis import rows_of_cell

THERE_COLOUR, BACK_COLOUR = "#D55E00", "#0072B2"
"""Of the direction that was asked for, and of the way back: vermilion and blue, of Okabe and Ito."""
MORE_COLOUR, LESS_COLOUR = "#D55E00", "#0072B2"
"""Where more of the source is followed by more of the target, and by less."""
FAINT_COLOUR = "0.6"
ALPHA = 0.05

_NEEDED = {"cell", "source", "target", "layer"}


def percent(gain: Any) -> FloatArray:
    """Gains (nats) as percent of the squared error that the source takes away.

    Parameters
    ----------
    gain : array_like

    Returns
    -------
    ndarray of dtype float
    """
    return np.asarray(-100.0 * np.expm1(-np.maximum(np.asarray(gain, dtype=np.float64), 0.0)))


def percent_words(gain: float) -> str:
    """A gain in percent with two digits, as "4.2 %" or "73 %"."""
    share = float(percent(gain))
    return f"{share:.2g} %" if share < 10.0 else f"{share:.0f} %"


def rows_of(table: Any, cell: int, columns: set[str], name: str) -> pd.DataFrame:
    """Rows of a cell in a table of a prediction, which must have these columns and those of its keys."""
    return rows_of_cell(table, cell, columns | _NEEDED, name)


def pairs_in(rows: pd.DataFrame) -> list[tuple[str, str]]:
    """Sources and targets, in the order of the table."""
    known = rows[["source", "target"]].drop_duplicates()
    return [(str(source), str(target)) for source, target in known.itertuples(index=False)]


def of_pair(rows: pd.DataFrame, pair: tuple[str, str]) -> pd.DataFrame:
    """Rows of a source and a target, from the edge in.

    Raises
    ------
    ParameterError
        There are none.
    """
    found = rows[(rows["source"] == pair[0]) & (rows["target"] == pair[1])].sort_values("layer")
    if found.empty:
        there = ", ".join(f"{a} → {b}" for a, b in pairs_in(rows))
        raise ParameterError(f"pair {pair[0]} → {pair[1]} is not in the table: it has {there}")
    return found


NOT_COUNTED = "not counted"
"""Words for links that do not survive without geometry, or that noise of measurement alone would make."""


def lost_in(rows: pd.DataFrame) -> pd.Series[bool]:
    """Which rows do not count: none where neither column is there.

    Parameters
    ----------
    rows : DataFrame
        geometry says that a link does not survive without geometry, weaker that noise of measurement alone
        would make it.
    """
    lost = pd.Series(False, index=rows.index)
    for name in ("geometry", "weaker"):
        if name in rows:
            lost |= rows[name].fillna(False).astype(bool)
    return lost


def arrow_words(pair: tuple[str, str], names: Mapping[str, str] | None = None) -> str:
    """As "Rac1 → edge velocity"."""
    shown = names or {}
    return " → ".join(shown.get(name, name) for name in pair)
