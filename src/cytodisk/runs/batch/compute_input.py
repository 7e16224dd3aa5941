"""One input → its study, and what a row says of it; this runs in a process of its own."""

from __future__ import annotations

import errno
import platform
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cytodisk.errors import CytodiskError, OtherRunError, WriteError
from cytodisk.runs.batch.batch_input import BatchInput

if TYPE_CHECKING:
    from cytodisk.store.study import Study

RUNS = "cytodisk.runs.batch.input_runs"  # not imported here: who only hands out inputs has no need of it
CANNOT_WRITE = "cannot write"
_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def compute_input(item: BatchInput, folder: Path) -> dict[str, Any]:
    """Run `cytodisk movie` or `cytodisk map` over an input.

    Parameters
    ----------
    item : BatchInput
    folder : Path
        An unfinished study of the same run is finished, one of another run is replaced.

    Returns
    -------
    dict
        Fields of `InputRow`; with the status "cannot write" the run must stop.

    Raises
    ------
    MemoryError
        Memory ran out. Any other fault is told by the fields.
    """
    try:
        return {"status": "ok", "reason": "", **_compute(item, folder)}
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001  whatever it is costs this input a row, not the run
        if _cannot_write(error):
            return {"status": CANNOT_WRITE, "reason": str(error)}
        if isinstance(error, CytodiskError):
            return {"status": "refused", "reason": str(error)}
        reason = f"{type(error).__name__}: {error}".splitlines()[0]
        return {"status": "failed", "reason": reason, "log": traceback.format_exc()}


def _cannot_write(error: BaseException | None) -> bool:
    """Whether an error comes from a disk that is full, or from results that cannot be written at all."""
    while error is not None:
        if isinstance(error, WriteError) or (isinstance(error, OSError) and error.errno in _NO_ROOM):
            return True
        error = error.__cause__ or error.__context__
    return False


def _compute(item: BatchInput, folder: Path) -> dict[str, Any]:
    from cytodisk.runs.batch.input_runs import run_of

    run = run_of(item, folder)
    try:
        return _facts(run(resume=True))
    except OtherRunError:
        return _facts(run(overwrite=True))


def _facts(study: Study) -> dict[str, Any]:
    from cytodisk.runs.qc_flags.study_flags import qc_flags

    rows, provenance = study.cells, study.provenance
    mapped = int((rows["status"] == "ok").sum())
    facts = {
        "complete": True,
        "cells": int(rows.loc[rows["label"] != 0, "cell"].nunique()),
        "frames": len(rows),
        "mapped": mapped,
        "qc_flags": int((rows["qc_flags"].fillna("") != "").sum()),
        "flags": "; ".join(flag.name for flag in qc_flags(study)),
        "pixel_size_um": provenance["pixel_size_um"],
        "frame_interval_s": provenance["frame_interval_s"],
        "length_unit": provenance["length_unit"],
        "velocity_unit": provenance["velocity_unit"] if study.is_movie else "",
        "worker": {"host": platform.node(), "versions": provenance["versions"]},
    }
    if not mapped:
        reason = rows["reason"].iloc[0] if len(rows) else "the file holds no cell"
        facts |= {"status": "refused", "reason": f"nothing could be mapped: {reason}"}
    return facts
