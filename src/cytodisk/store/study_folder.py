"""A study: the folder that a run writes its results to, piece by piece."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

from cytodisk.errors import DamagedPartWarning, StudyError, WriteError
from cytodisk.files import flush, make_folder, mark_of, replacing
from cytodisk.store.columns_file import write_columns
from cytodisk.store.csv_tables import csv_of, parquet_to_csv
from cytodisk.store.merging import merge_tables, write_rows
from cytodisk.store.provenance_file import PROVENANCE, other_version, read_provenance, write_json
from cytodisk.store.removal import remove_left_overs, remove_parts
from cytodisk.store.study_kind import CELLS, FIGURES, MAPS, PARTS, StudyKind, is_derived
from cytodisk.store.study_parts import UNITS, StudyParts
from cytodisk.store.study_room import is_empty, make_room
from cytodisk.store.written_files import FILES, lost_files, recorded, some_of, writing_files

_DIGITS = (5, 6)  # of a cell or frame in a key; a folder never has a million


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


class StudyFolder(StudyParts):
    """The writing side of a study: one part a cell, or a frame of a cell, merged into the tables at the end.

    Use it within `alone_in`.
    """

    is_whole = False
    """Whether a complete study lacks nothing that follows from its tables."""

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
            make_folder(folder)
            if not is_empty(folder):
                make_room(folder, study.provenance, kind, resume, overwrite)
            there = (read_provenance(folder) if resume else None) or {}
            study.provenance[FILES] = recorded(there) | dict.fromkeys(kind.names, "")
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

    @classmethod
    def complete(
        cls, path: str | os.PathLike[str], provenance: dict[str, Any], kind: StudyKind
    ) -> StudyFolder | None:
        """A folder that holds the whole of the same run already; else None.

        Parameters
        ----------
        path : path-like
        provenance : dict
            Of the run.
        kind : StudyKind

        Returns
        -------
        StudyFolder or None
            What follows from its tables alone may be missing; see `mend`.

        Warns
        -----
        DamagedPartWarning
            It would hold it, but files of it are gone or damaged.
        """
        folder = Path(path)
        there = read_provenance(folder) or {}
        same = there.get("fingerprint") == provenance["fingerprint"] and not other_version(there)
        if not same or there.get("status") != "complete":
            return None
        study, files = cls(folder, there, kind), recorded(there)
        lost = lost_files(folder, {name: mark for name, mark in files.items() if kind.may_write(name)})
        anew = not all(map(is_derived, lost))
        if lost:
            what = "it is made anew" if anew else "these are made anew"
            words = f"study {path} is not whole any more, {some_of(lost)} gone or damaged: {what}"
            warnings.warn(words, DamagedPartWarning, stacklevel=3)
        if not anew:
            remove_parts(folder)  # of a run that was killed when all else was done
        study.is_whole = not lost and all(name in files for name in kind.names)
        return None if anew else study

    def mend(self, then: Callable[[StudyFolder], None] | None = None) -> None:
        """Write what follows from the tables of a complete study.

        Parameters
        ----------
        then : callable, optional
            As `finish` takes it.
        """
        with writing_files(self.path, *self.kind.names):
            self._derive(then)

    def _derive(self, then: Callable[[StudyFolder], None] | None) -> None:
        write_columns(self.path, self.kind.tables, self.provenance)
        if then is not None:
            then(self)
        for table in self.kind.table_files if self.kind.csv else ():
            parquet_to_csv(self.path / table, self.path / csv_of(table))

    def note(self, name: str, value: Any) -> None:
        """Set an entry of the provenance and write it."""
        self.provenance[name] = value
        write_json(self.path / PROVENANCE, self.provenance)

    def map_path(self, key: str) -> Path:
        """Where a part's map stands."""
        return self.path / MAPS / f"cell_{key}.npz"

    def for_workers(self) -> StudyFolder:
        """The same folder for other processes, without what only the main one needs."""
        units = {name: self.provenance[name] for name in UNITS if name in self.provenance}
        return StudyFolder(self.path, units, self.kind)

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
        if self.kind.in_parts:
            self._merge(keys)
        self._derive(then)
        self.provenance[FILES] = self._written(keys)
        self.note("status", "complete")
        remove_parts(self.path)  # the tables stand; parts are only in the way

    def _merge(self, keys: list[str]) -> None:
        with replacing(self.path / CELLS) as temporary:
            write_rows(self.read_rows(keys), self._schema(self.kind.cells), temporary)
        for name, columns in self.kind.others.items():
            parts = (self.part_table(key, name) for key in keys if self.has_table(key, name))
            with replacing(self.path / f"{name}.parquet") as temporary:
                merge_tables(parts, self._schema(columns), temporary)

    def _written(self, keys: Iterable[str]) -> dict[str, str]:
        """Marks of all files of the study, which outlast a loss of power from here on."""
        parts = (self._done[key] for key in keys)
        of_parts = {name: mark for part in parts for name, mark in part.items() if not name.startswith(PARTS)}
        written = [name for name in self.kind.names if (self.path / name).exists()]
        there = {name: mark for name, mark in self.provenance[FILES].items() if (self.path / name).exists()}
        # Of this run alone the marks are known; what another one wrote with other options stays its own.
        others = {name: "" if self.kind.may_write(name) else mark for name, mark in there.items()}
        try:
            flush(self.path / name for name in (*written, *of_parts))
        except OSError as error:
            raise WriteError(f"cannot write {self.path}: {error.strerror or error}") from error
        marks = others | of_parts | {name: mark_of(self.path / name) for name in written}
        return dict(sorted(marks.items()))
