"""The folder of a batch: whose it is, and what stands in it."""

from __future__ import annotations

import hashlib
import json
import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cytodisk.disk.mapping_parameters import MAPS_VERSION
from cytodisk.errors import OtherRunError, StudyError
from cytodisk.runs.batch.batch_file import Batch
from cytodisk.runs.batch.input_row import ROWS, STUDIES
from cytodisk.runs.versions import NUMERIC, installed
from cytodisk.store.columns_file import COLUMNS_CSV
from cytodisk.store.csv_tables import csv_of, other_csv_words
from cytodisk.store.provenance_file import FORMAT, MAPS, PROVENANCE, command_of, own_files, parse_provenance
from cytodisk.store.study_room import check_room
from cytodisk.store.targets import Store
from cytodisk.store.url_store import is_url

_TABLES = tuple(f"{name}.parquet" for name in ("inputs", "cells", "windows", "edge", "consistency"))
_CSV = tuple(map(csv_of, _TABLES))
_FILES = (
    PROVENANCE,
    ROWS,
    STUDIES,
    *_TABLES,
    _CSV[0],
    COLUMNS_CSV,
)


def make_room(store: Store, provenance: dict[str, Any], target: str, resume: bool, overwrite: bool) -> None:
    """Check that a batch may write to a folder, and remove what it replaces.

    Parameters
    ----------
    store : Store
    provenance : dict
        Provenance of the batch.
    target : str
        Name of the folder, for messages.
    resume, overwrite : bool
        See `batch_study`.

    Raises
    ------
    StudyError
        The folder holds something else, or the results of another batch (`OtherRunError`).
    """
    there = parse_provenance(store.read_text(PROVENANCE) or "null")
    if there is None and all(name.startswith(".") for name in store.names("")):
        return
    if there is not None and there.get("run") != "batch":
        raise OtherRunError(
            f"output folder {target} holds a study of {command_of(there)}: pass another folder for a batch"
        )
    check_room(there, provenance, f"output folder {target}", resume, overwrite)
    if overwrite and there is not None:
        note(store, there | {"status": "being replaced", "fingerprint": {}})
        for name in own_files(there):
            store.remove(name)


def refuse_inputs_inside(batch: Batch, target: str) -> None:
    """Raise StudyError if a file of the batch lies where `--overwrite` removes results.

    Parameters
    ----------
    batch : Batch
    target : str
        Folder of the results, or a URL, where no input can be.
    """
    if is_url(target):
        return
    removed = {(Path(target) / name).resolve() for name in (ROWS, STUDIES)}
    for item in batch.inputs:
        for file in (item.masks, item.signal):
            if file is not None and removed & {file.resolve(), *file.resolve().parents}:
                raise StudyError(
                    f"input {file} lies among the results in {target}, which --overwrite removes: "
                    "move it, or pass another folder"
                )


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
    there = parse_provenance(store.read_text(PROVENANCE) or "null") or {}
    ours = {*_FILES, *own_files(there)}
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
    files = {"batch file": batch.path} | ({} if batch.table is None else {"table": batch.table})
    return {
        "run": "batch",
        "command": "cytodisk batch",
        "reader": f"open one of the studies in {STUDIES}/, or read its tables with pandas.read_parquet",
        "format": FORMAT,
        "files": list(dict.fromkeys((*_FILES, *(_CSV if csv else ())))),
        "status": "running",
        "fingerprint": {
            "cytodisk": installed(("cytodisk",))["cytodisk"],
            MAPS: MAPS_VERSION,
            "packages": installed(NUMERIC),
        },
        "inputs": {role: _described_file(path) for role, path in files.items()},
        "batch file": batch.path.read_text(encoding="utf-8-sig"),
        "number of inputs": len(batch.inputs),
        "columns": list(batch.columns),
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
    store.write_text(PROVENANCE, json.dumps(provenance, indent=2, ensure_ascii=False) + "\n")


def remove_left_overs(store: Store) -> None:
    """Remove what a run that was killed was about to write."""
    for folder in (ROWS, STUDIES):
        for name in list(store.names(folder)):
            if name.startswith("."):
                store.remove(f"{folder}/{name}")
