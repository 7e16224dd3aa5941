"""The cells of a run as a table of groups can name them: by file, label and frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pandas as pd

from cytodisk.runs.groups.named_files import NamedFiles

FILE, CELL, FRAME = KEYS = ("file", "cell", "frame")
"""Columns of a table of groups that say which cells a row is about."""
_FILES = ("input", "source", "path")
_MOST_RUNS = 8


@dataclass(frozen=True, eq=False)
class KnownCells:
    """Cells by number of the file, label and frame.

    Attributes
    ----------
    files : NamedFiles
    table : DataFrame
        By row of the cells: "file" (row in `files`), "cell" (label; 0 where a file or image has no cell),
        "frame", "at" (number of the row), "number" (of the cell in the study).
    """

    files: NamedFiles
    table: pd.DataFrame

    @classmethod
    def of(cls, cells: pd.DataFrame, folder: Path) -> KnownCells:
        """The cells of a table.

        Parameters
        ----------
        cells : DataFrame
            As `Groups.match` takes it.
        folder : Path
            What paths of the user are relative to.
        """
        having = [name for name in _FILES if name in cells]
        named = cells[having].fillna("") if having else pd.DataFrame({"source": [""] * len(cells)})
        place = named.groupby(list(named), sort=False).ngroup()
        table = pd.DataFrame({FILE: place.to_numpy(dtype=np.int64)})
        for key, name, instead in ((CELL, "label", 1), (FRAME, "frame", 0)):
            table[key] = cells[name].to_numpy(dtype=np.int64) if name in cells else instead
        table["at"] = np.arange(len(cells))
        table["number"] = cells["cell"].to_numpy() if "cell" in cells else table["at"]
        return cls(NamedFiles(named.drop_duplicates().reset_index(drop=True), folder), table)

    def place(self, at: int, keys: Sequence[str] = KEYS) -> str:
        """Where a cell is, in words, as "label 4 of a.tif"; without its label if that is no key."""
        row = self.table.iloc[at]
        name = self.files.names[int(row[FILE])]
        there = self.table.loc[self.table[FILE] == row[FILE], FRAME]
        parts = [f"label {row[CELL]}"] if CELL in keys else []
        if FRAME in keys and there.nunique() > 1:
            parts.append(f"in frame {row[FRAME]}" if parts else f"frame {row[FRAME]}")
        words = " ".join(parts)
        return f"{words} of {name}" if words and name else words or name or f"cell {row['number']}"


def numbers_words(numbers: Sequence[int]) -> str:
    """As "0–4, 7" for numbers in any order.

    Examples
    --------
    >>> from cytodisk.runs.groups.known_cells import numbers_words
    >>> numbers_words([3, 1, 2, 7])
    '1–3, 7'
    """
    given = sorted(set(numbers))
    breaks = [0, *(k + 1 for k, (one, two) in enumerate(pairwise(given)) if two > one + 1), len(given)]
    runs = [(given[first], given[last - 1]) for first, last in pairwise(breaks) if last > first]
    words = [f"{first}" if first == last else f"{first}–{last}" for first, last in runs[:_MOST_RUNS]]
    return ", ".join([*words, "…"] if len(runs) > _MOST_RUNS else words)
