"""What every run begins and ends with."""

from __future__ import annotations

from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

from cytodisk.errors import ParameterError
from cytodisk.io.frames import FrameFile
from cytodisk.io.study_folder import StudyFolder


def check_options(workers: int, resume: bool, overwrite: bool) -> None:
    """Raise ParameterError if `workers` is below 1, or both `resume` and `overwrite` are set."""
    if workers < 1:
        raise ParameterError(f"workers must be at least 1, got {workers}")
    if resume and overwrite:
        raise ParameterError("resume and overwrite exclude each other: pass one of them")


def input_paths(masks: FrameFile, signal: FrameFile | None) -> dict[str, Path]:
    """Files of a run by their role."""
    return {"masks": masks.path} | ({"signal": signal.path} if signal is not None else {})


def finish_run(folder: StudyFolder, keys: Sequence[str], warnings: Sequence[str]) -> None:
    """Note warnings and the time, merge the tables and mark the study as complete.

    Parameters
    ----------
    folder : StudyFolder
    keys : sequence of str
        All parts of the run, in the order of the tables.
    warnings : sequence of str

    Raises
    ------
    StudyError
        A part is missing.
    """
    folder.note("warnings", list(warnings))
    folder.note("finished", datetime.now(UTC).isoformat(timespec="seconds"))
    folder.finish(list(keys))
