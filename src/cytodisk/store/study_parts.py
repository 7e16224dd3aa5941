"""The parts of a run in its study's folder, each a cell or a few, or a frame of a cell."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Iterable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from cytodisk.arrays import FloatArray
from cytodisk.errors import DamagedPartWarning, StudyError
from cytodisk.files import flushed_later, mark_of, replacing
from cytodisk.store.merging import read_part, write_part
from cytodisk.store.part_file import DonePart, read_done, write_done
from cytodisk.store.provenance_file import json_bytes
from cytodisk.store.removal import BEGUN, parts_of
from cytodisk.store.study_kind import PARTS, StudyKind
from cytodisk.store.tables import Columns, schema
from cytodisk.store.written_files import lost_files, some_of

_CHECKED_AT_ONCE = 8  # parts
UNITS = ("length_unit", "velocity_unit")  # of the provenance


class StudyParts:
    """The parts of a run.

    A part's last file marks it as done, and holds checksums of the others; every file is written under a
    temporary name and renamed. So a run that is killed at any moment loses only the cells it was at, and
    another run can do the rest, and what was damaged since.

    Parameters
    ----------
    path : Path
        Of the study.
    provenance : dict
        With the units of its tables.
    kind : StudyKind
    """

    def __init__(self, path: Path, provenance: dict[str, Any], kind: StudyKind):
        self.path = path
        self.provenance = provenance
        self.kind = kind
        self._done: dict[str, dict[str, str]] = {}  # marks of the files of each part that is whole
        self._noted: set[str] = set()  # names of these files, and of what was written since

    def expect(self, keys: Collection[str]) -> None:
        """Look which parts of the run are there, and whole.

        Parameters
        ----------
        keys : collection of str
            Of all parts of the run.

        Raises
        ------
        StudyError
            There are parts of something else.

        Warns
        -----
        DamagedPartWarning
            Some were damaged since they were written, and so are not done.
        """
        there = {file.stem for file in parts_of(self.path, ".json")}
        if more := sorted(there - set(keys)):
            raise StudyError(
                f"study {self.path} holds parts that are not of this run: {some_of(more)}. Remove them from "
                f"{self.path / PARTS}, or pass --overwrite to do all anew"
            )
        with ThreadPoolExecutor(_CHECKED_AT_ONCE) as threads:
            found = dict(zip(there, threads.map(self._whole_part, there), strict=True))
        for key, part in found.items():
            if part is not None:
                self._note(key, part.files)
        if damaged := sorted(there - set(self._done)):
            words = f"study {self.path}: damaged parts are made anew: {some_of(damaged)}"
            warnings.warn(words, DamagedPartWarning, stacklevel=2)

    def _whole_part(self, key: str) -> DonePart | None:
        """A part whose row, tables and other files are as they were written."""
        part = read_done(self._part(key, "json"))
        return None if part is None or lost_files(self.path, part.files) else part

    def has(self, key: str) -> bool:
        """Whether a part is done; see `expect`."""
        return key in self._done

    def has_table(self, key: str, table: str) -> bool:
        """Whether a part that is done, or this run, wrote rows for a table."""
        return self._name(self._part(key, f"{table}.arrow")) in self._noted

    def files_of(self, key: str) -> list[Path]:
        """What a part that is done wrote beside its row."""
        return [self.path / name for name in self._done[key]]

    def begin(self, key: str, files: Iterable[Path]) -> None:
        """Note what a part may write beside its rows, before it does: so that it is known as the run's.

        Parameters
        ----------
        key : str
            See `part_key`.
        files : iterable of Path
        """
        with flushed_later(), replacing(self._part(key, BEGUN[1:])) as temporary:
            temporary.write_bytes(json_bytes([self._name(file) for file in files]))

    def add_table(self, key: str, table: str, *columns: dict[str, Any], name: str = "") -> Path:
        """Write a part's rows for a table.

        Parameters
        ----------
        key : str
            See `part_key`.
        table : str
            One of `self.kind.others`.
        *columns : dict of str to array
            One below the other, such as those of several cells.
        name : str
            Under another name, for rows that do not go into the table as they are.

        Returns
        -------
        Path
            The file written.
        """
        columns_schema = self._schema(self.kind.others[table])
        rows = pa.concat_tables([pa.table(some, schema=columns_schema) for some in columns])
        path = self._part(key, f"{name or table}.arrow")
        with flushed_later(), replacing(path) as temporary:
            write_part(rows, temporary)
        self._noted.add(self._name(path))
        return path

    def add_array(self, key: str, name: str, values: FloatArray) -> Path:
        """Write numbers of a part that only its run needs; they go with the parts when it ends.

        Parameters
        ----------
        key : str
            See `part_key`.
        name : str
        values : ndarray and dtype float

        Returns
        -------
        Path
            The file written.
        """
        path = self._part(key, f"{name}.npy")
        with flushed_later(), replacing(path) as temporary:
            np.save(temporary, values)
        return path

    def add(
        self, key: str, row: dict[str, Any], tables: dict[str, dict[str, Any]], files: Iterable[Path] = ()
    ) -> None:
        """Write a part: its rows for the tables, then its own row, which marks it as done.

        Parameters
        ----------
        key : str
            See `part_key`.
        row : dict
            Values for the table of cells; missing ones are null.
        tables : dict of str to columns
            Empty for a cell without a map.
        files : iterable of Path
            What else was written for it, which it is not done without.
        """
        self.add_cells(key, [(row, tables)], files)

    def add_cells(
        self,
        key: str,
        cells: Sequence[tuple[dict[str, Any], dict[str, dict[str, Any]]]],
        files: Iterable[Path] = (),
    ) -> None:
        """Write several cells as one part.

        Parameters
        ----------
        key : str
            See `part_key`; that of the first cell.
        cells : sequence of (row, tables)
            As `add` takes them.
        files : iterable of Path
            As `add` takes them.
        """
        written = list(files)
        for table in self.kind.others:
            columns = [tables[table] for _, tables in cells if table in tables]
            if columns:
                written.append(self.add_table(key, table, *columns))
        marks = {self._name(file): mark_of(file) for file in written}
        write_done(self._part(key, "json"), [row for row, _ in cells], marks)
        self._note(key, marks)

    def _note(self, key: str, marks: dict[str, str]) -> None:
        self._done[key] = marks
        self._noted.update(marks)

    def read_rows(self, keys: Collection[str]) -> Iterator[dict[str, Any]]:
        """The rows of all parts, one after the other.

        Parameters
        ----------
        keys : collection of str

        Yields
        ------
        dict
            As it was passed to `add` or `add_cells`.

        Raises
        ------
        StudyError
            A part is missing, or damaged.
        """
        for key in keys:
            found = read_done(self._part(key, "json"))
            if found is None:
                raise StudyError(
                    f"study {self.path} has no part {key} any more: run the same command again with --resume"
                )
            self._note(key, found.files)
            yield from found.rows

    def rows(self) -> list[dict[str, Any]]:
        """The rows of all parts that are there, by cell, then frame."""
        keys = [file.stem for file in parts_of(self.path, ".json")]
        return sorted(self.read_rows(keys), key=lambda row: (row["cell"], row["frame"]))

    def part_table(self, key: str, table: str) -> Any:
        """A part's rows for a table, as an Arrow table."""
        return read_part(self._part(key, f"{table}.arrow"))

    def part_array(self, key: str, name: str) -> FloatArray | None:
        """Numbers of a part as `add_array` wrote them; None if it did not."""
        path = self._part(key, f"{name}.npy")
        return np.load(path) if path.exists() else None

    def _part(self, key: str, suffix: str) -> Path:
        return self.path / PARTS / f"{key}.{suffix}"

    def _name(self, file: Path) -> str:
        return file.relative_to(self.path).as_posix()

    def _schema(self, columns: Columns) -> Any:
        return schema(columns, *(str(self.provenance.get(unit, "")) for unit in UNITS))
