"""What may be a slip in a table of groups: names that may be one, misspelt columns, empty fields."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.runs.given_tables.given_table import GivenTable

_LIKE = 0.8  # from which likeness on a column may be a misspelt one
_LINES = 5


def name_warnings(table: GivenTable, known: Sequence[str]) -> Iterator[str]:
    """Sentences on columns that may be meant to be condition or experiment, where there is no such column.

    Parameters
    ----------
    table : GivenTable
    known : sequence of str
        As "condition".
    """
    for name in map(str, table.fields):
        for wanted in (one for one in known if one not in table.fields):
            if SequenceMatcher(None, name.lower(), wanted).ratio() >= _LIKE:
                yield f"{table.name}: column {name!r} is taken for one of your own: did you mean {wanted}?"


def empty_warnings(table: GivenTable, column: str) -> Iterator[str]:
    """A sentence on rows whose field of a column is empty."""
    if column not in table.fields:
        return
    empty = np.flatnonzero((table.fields[column] == "").to_numpy())
    if len(empty):
        lines = ", ".join(str(table.lines[row]) for row in empty[:_LINES]) + ", …" * (len(empty) > _LINES)
        rows = f"{len(empty)} rows have" if len(empty) > 1 else "1 row has"
        yield f"{table.name}: {rows} no {column} (line {lines}), without which their cells are not compared"


def spelling_warnings(table: str, columns: Mapping[str, pd.Series[Any]]) -> Iterator[str]:
    """Sentences on names of a column that differ only in case or spaces.

    Parameters
    ----------
    table : str
        Name of the table of groups.
    columns : mapping of str to Series
        By name, as "condition".

    Examples
    --------
    >>> import pandas as pd
    >>> from cytodisk.runs.groups.group_slips import spelling_warnings
    >>> list(spelling_warnings("t.csv", {"condition": pd.Series(["Drug", "control", "drug"])}))
    ["t.csv: conditions 'Drug' and 'drug' differ only in case or spaces, and count as 2: write them alike"]
    """
    for name, values in columns.items():
        alike: dict[str, list[str]] = {}
        for text in pd.unique(values.dropna()):
            alike.setdefault("".join(str(text).casefold().split()), []).append(str(text))
        for spellings in (found for found in alike.values() if len(found) > 1):
            *first, last = map(repr, spellings)
            yield (
                f"{table}: {name}s {', '.join(first)} and {last} differ only in case or spaces, and count as "
                f"{len(spellings)}: write them alike"
            )
