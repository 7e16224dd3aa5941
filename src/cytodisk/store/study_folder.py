"""A study: the folder that a run writes its results to, piece by piece."""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa

from cytodisk.arrays import FloatArray
from cytodisk.errors import StudyError, WriteError
from cytodisk.files import replacing
from cytodisk.store.columns_file import write_columns
from cytodisk.store.merging import merge_tables, read_part, write_part, write_rows
from cytodisk.store.provenance_file import (
    PROVENANCE,
    other_version,
    read_provenance,
    write_json,
)
from cytodisk.store.study_kind import CELLS, FIGURES, MAPS, PARTS, StudyKind
from cytodisk.store.study_room import is_left_over, make_room, remove_left_overs
from cytodisk.store.tables import Columns, schema

_DIGITS = (5, 6)  # of a cell or frame in a key; a folder never has a million
_UNITS = ("length_unit", "velocity_unit")  # of the provenance


def part_key(cell: int, frame: int | None = None) -> str:
    """Name of a part of a study: a cell, or a frame of a cell."""
    return f"{cell:05d}" if frame is None else f"{cell:05d}_t{frame:05d}"


def part_patterns(name: str, frames: bool = False) -> tuple[str, ...]:
    """Patterns of the files whose name holds the key of a part, which fit no other name.

    Parameters
    ----------
    name : str
        With "{}" for the key, as "maps/cell_{}.npz".
    frames : bool
        The parts are frames of cells.
    """
    cells = ["[0-9]" * digits for digits in _DIGITS]
    keys = [f"{cell}_t{frame}" for cell in cells for frame in cells] if frames else cells
    return tuple(name.format(key) for key in keys)


class StudyFolder:
    """The writing side of a study: one part a cell, or a frame of a cell, merged into the tables at the end.

    A part's last file marks it as done; every file is written under a temporary name and renamed. So a run
    that is killed at any moment loses only the cells it was at, and another run can do the rest. Use it
    within `alone_in`.
    """

    def __init__(self, path: Path, provenance: dict[str, Any], kind: StudyKind):
        self.path = path
        self.provenance = provenance
        self.kind = kind

    @classmethod
    def start(
        cls,
        path: str | os.PathLike[str],
        provenance: dict[str, Any],
        kind: StudyKind,
        *,
        resume: bool = False,
        overwrite: bool = False,
    ) -> StudyFolder:
        """Open a folder for a run.

        Parameters
        ----------
        path : path-like
            Is made if need be.
        provenance : dict
            Must hold "fingerprint": what the results depend on. Two runs with one fingerprint have the same
            results. Gets what `kind` says of the run.
        kind : StudyKind
        resume : bool
            Go on in a folder that holds part of the same run.
        overwrite : bool
            Remove a study that is there.

        Returns
        -------
        StudyFolder

        Raises
        ------
        StudyError
            The folder holds something else, or another run, or cannot be written.
        """
        folder = Path(path)
        study = cls(folder, provenance | kind.provenance, kind)
        try:
            if folder.exists() and not folder.is_dir():
                raise StudyError(f"output {folder} is a file: pass a folder")
            folder.mkdir(parents=True, exist_ok=True)
            if any(not is_left_over(file) for file in folder.iterdir()):
                make_room(folder, study.provenance, resume, overwrite)
            study.note("status", "running")  # first, so that a folder that stands is known as a study
            (folder / PARTS).mkdir(exist_ok=True)
            if any(name.startswith(f"{MAPS}/") for name in kind.files):
                (folder / MAPS).mkdir(exist_ok=True)
            places = (folder, *(folder / name for name in (MAPS, FIGURES, PARTS)))
            remove_left_overs(place for place in places if place.is_dir())
        except StudyError:
            raise
        except OSError as error:
            raise WriteError(f"output folder {folder} cannot be written: {error.strerror}") from error
        return study

    @staticmethod
    def is_complete(path: str | os.PathLike[str], provenance: dict[str, Any]) -> bool:
        """Whether a folder holds the whole of the same run already."""
        there = read_provenance(Path(path)) or {}
        same = there.get("fingerprint") == provenance["fingerprint"] and not other_version(there)
        return same and there.get("status") == "complete"

    def note(self, name: str, value: Any) -> None:
        """Set an entry of the provenance and write it."""
        self.provenance[name] = value
        write_json(self.path / PROVENANCE, self.provenance)

    def has(self, key: str) -> bool:
        """Whether a part is complete."""
        return self._part(key, "json").exists()

    def has_table(self, key: str, table: str) -> bool:
        """Whether a part has rows for a table."""
        return self._part(key, f"{table}.arrow").exists()

    def map_path(self, key: str) -> Path:
        """Where a part's map stands."""
        return self.path / MAPS / f"cell_{key}.npz"

    def for_workers(self) -> StudyFolder:
        """The same folder for other processes, without what only the main one needs."""
        units = {name: self.provenance[name] for name in _UNITS if name in self.provenance}
        return StudyFolder(self.path, units, self.kind)

    def add_table(self, key: str, table: str, *columns: dict[str, Any]) -> None:
        """Write a part's rows for a table.

        Parameters
        ----------
        key : str
            See `part_key`.
        table : str
            One of `self.kind.others`.
        *columns : dict of str to array
            One below the other, such as those of several cells.
        """
        columns_schema = self._schema(self.kind.others[table])
        rows = pa.concat_tables([pa.table(some, schema=columns_schema) for some in columns])
        with replacing(self._part(key, f"{table}.arrow")) as temporary:
            write_part(rows, temporary)

    def add_array(self, key: str, name: str, values: FloatArray) -> None:
        """Write numbers of a part that only its run needs; they go with the parts when it ends.

        Parameters
        ----------
        key : str
            See `part_key`.
        name : str
        values : ndarray and dtype float
        """
        with replacing(self._part(key, f"{name}.npy")) as temporary:
            np.save(temporary, values)

    def add(self, key: str, row: dict[str, Any], tables: dict[str, dict[str, Any]]) -> None:
        """Write a part: its rows for the tables, then its own row, which marks it as complete.

        Parameters
        ----------
        key : str
            See `part_key`.
        row : dict
            Values for the table of cells; missing ones are null.
        tables : dict of str to columns
            Empty for a cell without a map.
        """
        for table, columns in tables.items():
            self.add_table(key, table, columns)
        write_json(self._part(key, "json"), row)

    def add_cells(self, key: str, cells: Sequence[tuple[dict[str, Any], dict[str, dict[str, Any]]]]) -> None:
        """Write several cells as one part.

        Parameters
        ----------
        key : str
            See `part_key`; that of the first cell.
        cells : sequence of (row, tables)
            As `add` takes them.
        """
        for table in self.kind.others:
            columns = [tables[table] for _, tables in cells if table in tables]
            if columns:
                self.add_table(key, table, *columns)
        write_json(self._part(key, "json"), [row for row, _ in cells])

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
            A part is missing, or there are others.
        """
        complete = self._complete()
        if set(complete) != set(keys):
            raise StudyError(
                f"study {self.path} has {len(complete)} parts instead of {len(keys)}: "
                "run the same command again with --resume"
            )
        for key in keys:
            found = json.loads(self._part(key, "json").read_text(encoding="utf-8"))
            yield from found if isinstance(found, list) else [found]

    def rows(self) -> list[dict[str, Any]]:
        """The rows of all complete parts, by cell, then frame."""
        return sorted(self.read_rows(self._complete()), key=lambda row: (row["cell"], row["frame"]))

    def part_table(self, key: str, table: str) -> Any:
        """A part's rows for a table, as an Arrow table."""
        return read_part(self._part(key, f"{table}.arrow"))

    def part_array(self, key: str, name: str) -> FloatArray | None:
        """Numbers of a part as `add_array` wrote them; None if it did not."""
        path = self._part(key, f"{name}.npy")
        return np.load(path) if path.exists() else None

    def finish(self, keys: list[str], then: Callable[[StudyFolder], None] | None = None) -> None:
        """Merge the parts into the tables and mark the study as complete.

        Parameters
        ----------
        keys : list of str
            All parts of the run, in the order of the tables.
        then : callable, optional
            Called with this folder when the tables stand; a run that is killed in it can be resumed.

        Raises
        ------
        StudyError
            A part is missing.
        """
        with replacing(self.path / CELLS) as temporary:
            write_rows(self.read_rows(keys), self._schema(self.kind.cells), temporary)
        for name, columns in self.kind.others.items():
            parts = (self.part_table(key, name) for key in keys if self.has_table(key, name))
            with replacing(self.path / f"{name}.parquet") as temporary:
                merge_tables(parts, self._schema(columns), temporary)
        if then is not None:
            then(self)
        write_columns(self.path, self.kind.tables, self.provenance)
        self.note("status", "complete")
        shutil.rmtree(self.path / PARTS, ignore_errors=True)  # the tables stand; parts are only in the way

    def _complete(self) -> list[str]:
        return [part.stem for part in (self.path / PARTS).glob("[0-9]*.json")]

    def _part(self, key: str, suffix: str) -> Path:
        return self.path / PARTS / f"{key}.{suffix}"

    def _schema(self, columns: Columns) -> Any:
        return schema(columns, *(str(self.provenance.get(unit, "")) for unit in _UNITS))
