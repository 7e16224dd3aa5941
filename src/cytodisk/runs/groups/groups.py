"""`Groups`: which cells are of which condition and experiment, by file, label and frame."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa

from cytodisk.arrays import IntArray
from cytodisk.runs.given_tables.table_faults import Faults
from cytodisk.runs.groups.group_words import missing_words, summary_words
from cytodisk.runs.groups.known_cells import CELL, KnownCells
from cytodisk.runs.groups.row_matching import RowMatching
from cytodisk.store.tables import Columns

CONDITION, EXPERIMENT = "condition", "experiment"
WHAT = "table of groups"


@dataclass(frozen=True, eq=False)
class GroupedCells:
    """What a table of groups says of some cells.

    Attributes
    ----------
    values : DataFrame
        A row a row of the cells, with their index; None, <NA> or NaN where no row of the table is about it.
    warnings : tuple of str
        What a user should know: cells that no row is about, names that differ only in case or spaces.
    words : str
        The keys, and how many cells each condition and experiment has.
    """

    values: pd.DataFrame
    warnings: tuple[str, ...]
    words: str

    @property
    def texts(self) -> dict[str, list[str]]:
        """The values of each column as texts, "" for none."""
        return {str(name): [_text(value) for value in self.values[name]] for name in self.values}


def _text(value: Any) -> str:
    """A value as the table had it."""
    return "" if pd.isna(value) else f"{value:g}" if isinstance(value, float) else str(value)


@dataclass(frozen=True, eq=False)
class Groups:
    """A table of groups, as `read_groups` reads it.

    Attributes
    ----------
    path : Path
    columns : tuple of Column
        What it says of cells: condition, experiment and the user's own.
    keys : DataFrame
        By row of the table, those of file, cell and frame that it has; None or <NA> stands for all.
    values : DataFrame
        By row of the table, its columns.
    lines : ndarray of shape (rows,) and dtype int
        Where each row ends in the file, from 1.
    told : tuple of str
        Warnings on the table itself.
    """

    path: Path
    columns: Columns
    keys: pd.DataFrame
    values: pd.DataFrame
    lines: IntArray
    told: tuple[str, ...] = ()

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the columns."""
        return tuple(column.name for column in self.columns)

    def of(self, cells: pd.DataFrame) -> pd.DataFrame:
        """The columns of the table for each of some cells; see `match`."""
        return self.match(cells).values

    def check_files(self, cells: pd.DataFrame) -> None:
        """Raise ParameterError if a row names a file that some cells, or rows of mask files, do not have."""
        faults, known = Faults(), KnownCells.of(cells, self.path.absolute().parent)
        RowMatching(self.path, self.keys, self.lines, known).files(faults)
        faults.raise_if_any(self.path, WHAT)

    def match(self, cells: pd.DataFrame) -> GroupedCells:
        """What the table says of some cells.

        Parameters
        ----------
        cells : DataFrame
            A row a cell, or a frame of a cell. Of these columns it needs those that the table asks for:
            `source` (name of the mask file), `input` (of a batch), or both; `path` (of the mask file, by
            which paths are compared); `label` (0 stands for an image or a file without cells); `frame`.
            `cell`, its number in the study, is what cells are counted by.

        Returns
        -------
        GroupedCells

        Raises
        ------
        ParameterError
            A row of the table is about no cell, or a cell is in two rows; all faults are said at once.
        """
        faults, known = Faults(), KnownCells.of(cells, self.path.absolute().parent)
        matching = RowMatching(self.path, self.keys, self.lines, known)
        rows = matching.files(faults)
        faults.raise_if_any(self.path, WHAT)
        found = matching.cells(rows, faults)
        faults.raise_if_any(self.path, WHAT)
        matching.without_cells(rows, found, faults)
        faults.raise_if_any(self.path, WHAT)
        row_of = np.full(len(cells), -1, dtype=np.int64)
        row_of[found["at"]] = found["row"]
        values = self.values.reindex(row_of).set_index(cells.index)
        for name in (column.name for column in self.columns if column.kind == pa.string()):
            values[name] = values[name].astype("object").where(values[name].notna(), None)
        missing = (row_of < 0) & (known.table[CELL] != 0).to_numpy()
        keys = [str(key) for key in self.keys]
        lost = missing_words(self.path.name, keys, known, missing, CONDITION in self.names)
        words = summary_words(keys, values, known)
        return GroupedCells(values, (*self.told, *matching.remarks, *lost), words)
