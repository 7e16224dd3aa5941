"""Heading of figures of pooled results: a title, and how many cells and experiments each condition has."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from cytodisk.pages.drawn_correlation import Heading
from cytodisk.pages.drawn_movie import LEFT_MM
from cytodisk.pages.sheet import broken_lines
from cytodisk.plot.style import SINGLE_COLUMN_MM

_TITLE_MM = 1.9  # width of a letter of the title


def pooled_heading(
    title: str, cells: pd.DataFrame, conditions: Sequence[str], width: float = SINGLE_COLUMN_MM
) -> Heading:
    """The heading of a figure.

    Parameters
    ----------
    title : str
    cells : DataFrame
        condition, experiment and status of each cell.
    conditions : sequence of str
    width : float
        Of the figure, in mm.
    """
    used = cells[cells["status"] == "ok"]
    units = used.loc[used["experiment"] != "", ["condition", "experiment"]].drop_duplicates()
    facts = []
    for name in conditions:
        own = f"{int((used['condition'] == name).sum())} cells"
        known = int((units["condition"] == name).sum())
        facts.append(f"{name}: {own}, " + (f"{known} experiments" if known else "experiments unknown"))
    room = width - 2 * LEFT_MM
    return Heading(broken_lines(title.split(" "), " ", room, _TITLE_MM), broken_lines(facts, " · ", room))
