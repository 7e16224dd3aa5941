"""The folder of a batch: whose it is, and what stands in it."""

from __future__ import annotations

import hashlib
import json
import platform
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from cytodisk.errors import OtherRunError, StudyError
from cytodisk.runs.batch.batch_file import Batch
from cytodisk.runs.batch.input_row import ROWS, STUDIES
from cytodisk.runs.versions import NUMERIC, installed
from cytodisk.store.provenance_file import PROVENANCE, command_of, differences
from cytodisk.store.targets import Store

_OWN = (
    ROWS,
    STUDIES,
    *(f"{name}.parquet" for name in ("inputs", "cells", "windows", "edge", "consistency")),
    "inputs.csv",
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
    there = _read_provenance(store)
    if there is None:
        if any(not name.startswith(".") for name in store.names("")):
            raise StudyError(f"output folder {target} is not empty and holds no batch: pass another folder")
    elif there.get("run") != "batch":
        raise OtherRunError(
            f"output folder {target} holds a study of {command_of(there)}: pass another folder for a batch"
        )
    elif overwrite:
        note(store, there | {"status": "being replaced", "fingerprint": {}})
        for name in _OWN:
            store.remove(name)
    elif not resume:
        raise StudyError(
            f"output folder {target} holds a batch: pass --resume to go on, --overwrite to replace it"
        )
    elif there.get("fingerprint") != provenance["fingerprint"]:
        raise OtherRunError(
            f"output folder {target} holds another run ({differences(there, provenance)}): "
            "pass --overwrite to replace it, or another folder"
        )


def _read_provenance(store: Store) -> dict[str, Any] | None:
    """What the folder says of its run; None if that cannot be read, or is none."""
    try:
        found = json.loads(store.read_text(PROVENANCE) or "null")
    except json.JSONDecodeError:
        return None
    return found if isinstance(found, dict) and "fingerprint" in found else None


def describe_batch(batch: Batch) -> dict[str, Any]:
    """Provenance of a batch that starts now.

    Parameters
    ----------
    batch : Batch

    Returns
    -------
    dict
        Its "fingerprint" holds what all results depend on; parameters and files stand in each input's row.
    """
    files = {"batch file": batch.path} | ({} if batch.table is None else {"table": batch.table})
    return {
        "run": "batch",
        "status": "running",
        "fingerprint": {"cytodisk": installed(("cytodisk",))["cytodisk"], "packages": installed(NUMERIC)},
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
