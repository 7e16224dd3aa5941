"""Names of conditions and experiments that may be meant to be one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd


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
    >>> from cytodisk.runs.groups.group_spellings import spelling_warnings
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
