"""What is said of groups: how many cells each has, and which cells have none."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pandas as pd

from cytodisk.arrays import BoolArray
from cytodisk.images.short_lists import shortened
from cytodisk.runs.groups.known_cells import CELL, FILE, KEYS, KnownCells

_MOST_NAMED = 8


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
    """The keys, and the number of cells by condition and experiment.

    Parameters
    ----------
    keys : sequence of str
        Columns of the table that say which cells a row is about.
    values : DataFrame
        By row of the cells.
    known : KnownCells
    """
    words = [f"by {' and '.join(keys)}"]
    is_cell = (known.table[CELL] != 0).to_numpy()
    number = known.table["number"].to_numpy()[is_cell]
    for name in ("condition", "experiment"):
        if name in values:
            given = pd.DataFrame({"number": number, name: values[name].to_numpy()[is_cell]})
            counts = given.drop_duplicates().groupby(name, sort=False).size()
            shown = [
                f"{group} ({count} {'cell' if count == 1 else 'cells'})" for group, count in counts.items()
            ]
            words.append(f"{name}s: {shortened(shown, _MOST_NAMED)}" if shown else f"no {name}")
    own = [str(name) for name in values if name not in ("condition", "experiment")]
    return "; ".join([*words, f"columns {', '.join(own)}"] if own else words)
