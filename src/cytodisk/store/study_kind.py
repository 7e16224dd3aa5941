"""`StudyKind`: what a run writes into its folder; each command declares its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fnmatch import fnmatchcase
from typing import Any

from cytodisk.store.columns_file import COLUMNS_CSV
from cytodisk.store.csv_tables import csv_of
from cytodisk.store.nuclei.nucleus_columns import NUCLEI_COLUMNS, NUCLEUS_COLUMNS
from cytodisk.store.nuclei.summary_columns import PLACE_COLUMNS, channel_columns
from cytodisk.store.provenance_file import FORMAT
from cytodisk.store.tables import Columns
from cytodisk.store.window_columns import NUCLEUS_WINDOW_COLUMNS

PARAMETERS = "parameters.toml"
CELLS = "cells.parquet"
MAPS, FIGURES, PARTS = "maps", "figures", ".parts"
ACTIVITY = "activity.zarr.zip"
_WHICH = ("cell", "source", "frame", "time_s", "label")


@dataclass(frozen=True)
class StudyKind:
    """The tables and files of a run.

    Attributes
    ----------
    run : str
        Name of the run in the provenance.
    command : str
        Such as "cytodisk map".
    reader : str
        How to read the results, for whoever takes them for another kind.
    cells : tuple of Column
        Of the table with a row for each cell, or for each frame of a cell.
    others : dict of str to tuple of Column
        By name of the table.
    files : tuple of str
        Names, or patterns of names, of all else that it writes. With patterns it is told what may be the
        run's; the provenance names each file.
    cells_with_nuclei : tuple of Column
        More of the first table where cells have nuclei.
    csv : bool
        All tables are written as CSV too.
    in_parts : bool
        The tables are put together of the rows of parts; otherwise the run writes them whole.
    """

    run: str
    command: str
    reader: str
    cells: Columns
    others: dict[str, Columns]
    files: tuple[str, ...] = ()
    cells_with_nuclei: Columns = ()
    csv: bool = False
    in_parts: bool = True

    @property
    def tables(self) -> dict[str, Columns]:
        """Columns of all tables, by name."""
        return {"cells": self.cells, **self.others}

    @property
    def table_files(self) -> tuple[str, ...]:
        """Names of the files of all tables."""
        own = (file for file in self.files if file.endswith(".parquet"))
        return (*(f"{name}.parquet" for name in self.tables), *own)

    @property
    def with_csv(self) -> StudyKind:
        """The same where every table is written as CSV too."""
        new = tuple(name for name in map(csv_of, self.table_files) if name not in self.files)
        return replace(self, files=(*self.files, *new), csv=True)

    @property
    def with_nuclei(self) -> StudyKind:
        """The same where cells have nuclei: with a table of these, and windows have a compartment."""
        windows = (*self.others["windows"], *NUCLEUS_WINDOW_COLUMNS)
        others = {**self.others, "windows": windows, "nuclei": NUCLEI_COLUMNS}
        cells = (*self.cells, *NUCLEUS_COLUMNS, *self.cells_with_nuclei, *PLACE_COLUMNS)
        return replace(self, cells=cells, others=others)

    def with_channels(self, channels: Sequence[str]) -> StudyKind:
        """The same where cells have nuclei and a signal: numbers of each channel in nucleus and cytoplasm."""
        return replace(self, cells=(*self.cells, *channel_columns(channels)))

    def with_own(self, columns: Columns) -> StudyKind:
        """The same with columns of the user's, as of conditions, after those that say which cell it is."""
        first = 1 + max(place for place, column in enumerate(self.cells) if column.name in _WHICH)
        return replace(self, cells=(*self.cells[:first], *columns, *self.cells[first:]))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the files that every such run writes, beside the provenance."""
        tables = (f"{name}.parquet" for name in self.tables)
        return (PARAMETERS, COLUMNS_CSV, *tables, *(name for name in self.files if not _is_pattern(name)))

    @property
    def patterns(self) -> tuple[str, ...]:
        """Patterns of the names of files whose number depends on the input."""
        return tuple(name for name in self.files if _is_pattern(name))

    def may_write(self, name: str) -> bool:
        """Whether such a run, not a later command such as a report, writes a file of this name."""
        return name in self.names or any(fnmatchcase(name, pattern) for pattern in self.patterns)

    @property
    def provenance(self) -> dict[str, Any]:
        """What the provenance says of the kind of run."""
        return {"run": self.run, "command": self.command, "reader": self.reader, "format": FORMAT}


def is_derived(name: str) -> bool:
    """Whether a file follows from the tables of a study, so that nothing is computed to write it anew."""
    return name == PARAMETERS or name.endswith(".csv")


def _is_pattern(name: str) -> bool:
    return "[" in name or "*" in name
