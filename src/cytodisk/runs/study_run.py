"""What every run that writes a study does, from the check of its options to the study that it returns."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypeVar

from cytodisk.checks import is_path
from cytodisk.parameters import Parameters
from cytodisk.runs.parameters_file import write_parameters
from cytodisk.runs.run_options import FolderOptions
from cytodisk.store.csv_tables import check_csv_room, has_csv_tables
from cytodisk.store.study_folder import StudyFolder
from cytodisk.store.study_kind import PARAMETERS, StudyKind
from cytodisk.store.study_room import WRITES, alone_in, check_folder, is_empty, refuse_to_add

Result = TypeVar("Result")


@dataclass(frozen=True)
class StudyRun:
    """A run that is ready to start.

    Attributes
    ----------
    kind : StudyKind
    provenance : dict
        As `describe_run` returns it.
    parameters : Parameters
    options : FolderOptions
    writes : dict of str to str
        What it writes for each cell because its options say so, and how to do without.
    """

    kind: StudyKind
    provenance: dict[str, Any]
    parameters: Parameters
    options: FolderOptions
    writes: Mapping[str, str] = field(default_factory=dict)

    def into(
        self,
        out: str | os.PathLike[str],
        work: Callable[[StudyFolder], tuple[Sequence[str], Sequence[str]]],
        read: Callable[[Path], Result],
        tables: Callable[[StudyFolder], None] | None = None,
        prepare: Callable[[], None] | None = None,
    ) -> Result:
        """Do the work in a folder and mark the study as complete, unless it is.

        Parameters
        ----------
        out : path-like
            Is made if need be.
        work : callable
            Writes what is not there yet into the folder that it is given. Returns the keys of all parts, in
            the order of the tables, and warnings.
        read : callable
            Opens the complete study.
        tables : callable, optional
            Completes the tables when all parts are in them, before the study counts as complete.
        prepare : callable, optional
            Called before anything is written or removed, unless the study is complete: if it raises an
            error, the folder is as it was.

        Returns
        -------
        object
            What `read` returns.

        Raises
        ------
        StudyError
            The folder cannot be used, or results cannot be written.
        """
        is_path("out", out)
        options, place = self.options, Path(out)
        with alone_in(out):
            kind, provenance = self._kind(place), self.provenance | {WRITES: [*self.writes]}
            if options.resume:
                refuse_to_add(place, provenance, self.writes)
            complete = StudyFolder.complete(out, provenance, kind) if options.resume else None
            if complete is None:
                if prepare is not None:
                    if not is_empty(place):
                        check_folder(place, provenance | kind.provenance, kind, **options.again)
                    prepare()
                folder = StudyFolder.start(out, provenance, kind, **options.again)
                write_parameters(self.parameters, place / PARAMETERS)
                keys, warnings = work(folder)
                folder.note("warnings", [*self.provenance["warnings"], *warnings])
                folder.note("finished", datetime.now(UTC).isoformat(timespec="seconds"))
                folder.finish(list(keys), tables)
            elif not complete.is_whole:
                write_parameters(self.parameters, place / PARAMETERS)
                complete.mend(tables)
            return read(place)

    def _kind(self, place: Path) -> StudyKind:
        """The kind with its tables as CSV too: if asked for, or done by the run that goes on."""
        tables = self.kind.table_files
        if not (self.options.csv or (self.options.resume and has_csv_tables(place, tables))):
            return self.kind
        check_csv_room(place, tables)
        return self.kind.with_csv
