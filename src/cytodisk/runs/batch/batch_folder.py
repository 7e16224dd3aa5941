"""The folder of a batch: whose it is, and what stands in it."""

from __future__ import annotations

import hashlib
import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import OtherRunError, StudyError
from cytodisk.files import is_temporary
from cytodisk.runs.batch.batch_file import Batch
from cytodisk.runs.batch.batch_target import RUN
from cytodisk.runs.batch.input_row import ROWS, STUDIES, row_key, study_key
from cytodisk.runs.versions import NUMERIC, installed
from cytodisk.store.columns_file import COLUMNS_CSV
from cytodisk.store.csv_tables import csv_of, other_csv_words
from cytodisk.store.provenance_file import (
    FORMAT,
    MAPS,
    PROVENANCE,
    command_of,
    json_bytes,
    parse_provenance,
)
from cytodisk.store.removal import input_files
from cytodisk.store.study_room import check_room
from cytodisk.store.targets import Store
from cytodisk.store.written_files import FILES, recorded, some_of

_TABLES = tuple(f"{name}.parquet" for name in ("inputs", "cells", "windows", "nuclei", "edge", "consistency"))
_CSV = tuple(map(csv_of, _TABLES))
_FILES = (*_TABLES, _CSV[0], COLUMNS_CSV, RUN)


def make_room(
    store: Store, batch: Batch, provenance: dict[str, Any], target: str, *, resume: bool, overwrite: bool
) -> dict[str, str]:
    """Check that a batch may write to a folder, and remove what it replaces.

    All is checked before anything is removed.

    Parameters
    ----------
    store : Store
    batch : Batch
    provenance : dict
        Provenance of the batch.
    target : str
        Name of the folder, for messages.
    resume, overwrite : bool
        See `batch_study`.

    Returns
    -------
    dict of str to str
        What the list of the batch's files holds from before.

    Raises
    ------
    StudyError
        The folder holds something else, or the results of another batch (`OtherRunError`); or files are in
        the way, or would be removed, that are not the batch's.
    """
    there = parse_provenance(store.read_text(PROVENANCE) or "null", f"{target}/{PROVENANCE}")
    if there is None and all(name.startswith(".") for name in store.names("")):
        return {}
    if there is not None and there.get("run") != "batch":
        raise OtherRunError(
            f"output folder {target} holds a study of {command_of(there)}: pass another folder for a batch"
        )
    check_room(there, provenance, f"output folder {target}", resume, overwrite)
    assert there is not None  # it was checked
    known = recorded(there)
    places = [*store.names(""), *(f"{ROWS}/{name}" for name in store.names(ROWS))]
    if strange := sorted({*places} & {*provenance[FILES]} - {*known}):
        raise StudyError(
            f"output folder {target} holds {some_of(strange)}, which its batch did not write but this "
            "one may: move what is yours, or pass another folder"
        )
    if not overwrite:
        return known
    studies = [study_key(Path(name).stem) for name in known if name.startswith(f"{ROWS}/")]
    names = [*known, *(name for study in studies for name in store.files_of_study(study))]
    files = [file for item in batch.inputs for file in item.files.values()]
    store.refuse_removal(names, [*files, *input_files(provenance)])
    note(store, there | {"status": "being replaced", "fingerprint": {}})
    store.remove(names)
    for study in studies:
        if any(store.names(study)):  # what is left is the user's, and the study comes back
            replaced = there | {"status": "being replaced", "fingerprint": {}, FILES: {}}
            store.write_text(f"{study}/{PROVENANCE}", json_bytes(replaced, indent=2).decode() + "\n")
    return {}


def wants_csv(store: Store, target: str, asked: bool, resume: bool) -> bool:
    """Whether all tables are to be written as CSV too: if asked for, or done by the run that goes on.

    Parameters
    ----------
    store : Store
    target : str
        Name of the folder, for messages.
    asked, resume : bool

    Raises
    ------
    StudyError
        A file that no batch wrote stands in the place of a table.
    """
    there = parse_provenance(store.read_text(PROVENANCE) or "null", f"{target}/{PROVENANCE}") or {}
    ours = {*_FILES, *recorded(there)}
    if ours >= {*_CSV}:
        return asked or resume
    if asked and (others := [name for name in store.names("") if name in _CSV and name not in ours]):
        raise StudyError(other_csv_words(f"{target.rstrip('/')}/{others[0]}"))
    return asked


def describe_batch(batch: Batch, csv: bool = False) -> dict[str, Any]:
    """Provenance of a batch that starts now.

    Parameters
    ----------
    batch : Batch
    csv : bool
        All tables are written as CSV too.

    Returns
    -------
    dict
        Its "fingerprint" holds what all results depend on; parameters and files stand in each input's row.
    """
    names = [item.name for item in batch.inputs]
    files = {"batch file": batch.path} | ({} if batch.table is None else {"table": batch.table})
    files |= {} if batch.groups is None else {"groups": batch.groups.path}
    return {
        "run": "batch",
        "command": "cytodisk batch",
        "reader": f"open one of the studies in {STUDIES}/, or read its tables with pandas.read_parquet",
        "format": FORMAT,
        FILES: dict.fromkeys([*_FILES, *(_CSV if csv else ()), *map(row_key, names)], ""),
        "status": "running",
        "fingerprint": {
            "cytodisk": installed(("cytodisk",))["cytodisk"],
            MAPS: MAPS_VERSION,
            "packages": installed(NUMERIC),
        },
        "inputs": {role: _described_file(path) for role, path in files.items()},
        "batch file": batch.path.read_text(encoding="utf-8-sig"),
        "number of inputs": len(batch.inputs),
        "columns": list(dict.fromkeys([*batch.columns, *(batch.groups.names if batch.groups else ())])),
        "versions": installed(),
        "python": platform.python_version(),
        "platform": platform.platform(),
        "started": now(),
    }


def _described_file(path: Path) -> dict[str, str]:
    return {"path": str(path), "sha256": hashlib.sha256(path.read_bytes()).hexdigest()}


def now() -> str:
    """The time, as provenance has it."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def note(store: Store, provenance: dict[str, Any]) -> None:
    """Write the provenance."""
    store.write_text(PROVENANCE, json_bytes(provenance, indent=2).decode() + "\n")


def remove_left_overs(store: Store) -> None:
    """Remove what a run that was killed was about to write."""
    for folder in ("", ROWS, STUDIES):
        for name in list(store.names(folder)):
            if is_temporary(name):
                store.remove_left_over(f"{folder}/{name}" if folder else name)
