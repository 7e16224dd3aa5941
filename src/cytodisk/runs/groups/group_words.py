"""What is said of groups: how many cells each has, and which cells have none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pandas as pd

from cytodisk.arrays import BoolArray
from cytodisk.images.short_lists import shortened
from cytodisk.runs.groups.known_cells import CELL, FILE, KEYS, KnownCells

_MOST_NAMED = 8
_NUMBER = "\nnumber"  # which no user can write as the name of a column


def missing_words(
    table: str, keys: Sequence[str], known: KnownCells, missing: BoolArray, of_condition: bool
) -> Iterator[str]:
    """A sentence on cells that no row is about, if there are any.

    Parameters
    ----------
    table : str
        Name of the table of groups.
    keys : sequence of str
        Its columns that say which cells a row is about.
    known : KnownCells
    missing : ndarray of bool
        By row of the cells.
    of_condition : bool
        The table has conditions.
    """
    lost = known.table[missing].drop_duplicates("number")
    if lost.empty:
        return
    total = known.table.loc[known.table[CELL] != 0, "number"].nunique()
    named = lost.drop_duplicates([key for key in KEYS if key in keys or key == FILE])
    shown = [known.place(int(at), keys) for at in named["at"].iloc[:_MOST_NAMED]]
    names = shortened([*shown, *[""] * (len(named) - len(shown))], _MOST_NAMED)
    what = "condition" if of_condition else "values"
    yield f"{table}: {len(lost)} of {total} cells are in no row, so they have no {what}: {names}"


def summary_words(keys: Sequence[str], values: pd.DataFrame, known: KnownCells) -> str:
    """The keys, and the number of cells and experiments by condition.

    Parameters
    ----------
    keys : sequence of str
        Columns of the table that say which cells a row is about.
    values : DataFrame
        By row of the cells.
    known : KnownCells
    """
    is_cell = (known.table[CELL] != 0).to_numpy()
    cells = values[is_cell].assign(**{_NUMBER: known.table["number"].to_numpy()[is_cell]})
    words = [f"by {' and '.join(keys)}"]
    if "condition" in values:
        by_condition = cells.dropna(subset="condition").groupby("condition", sort=False)
        shown = [f"{name} ({_counts(some)})" for name, some in by_condition]
        words.append(f"conditions: {shortened(shown, _MOST_NAMED)}" if shown else "no condition")
    else:
        words.append(f"no column condition; {_counts(cells)}")
    if "experiment" not in values:
        words.append("no column experiment")
    own = [str(name) for name in values if name not in ("condition", "experiment")]
    return "; ".join([*words, f"columns {', '.join(own)}"] if own else words)


def _counts(cells: pd.DataFrame) -> str:
    """As "12 cells of 3 experiments"."""
    words = [_count(cells[_NUMBER].nunique(), "cell")]
    if "experiment" in cells:
        words.append(_count(cells["experiment"].nunique(), "experiment"))
    return " of ".join(words)


def _count(number: int, of: str) -> str:
    return f"{number} {of}" if number == 1 else f"{number} {of}s"
