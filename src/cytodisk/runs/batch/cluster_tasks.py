"""Tasks of a batch as a cluster does them, and what stands in for one that its workers died of."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from cytodisk.images.image_paths import is_folder_of_files
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.batch_target import open_store
from cytodisk.runs.batch.batch_task import BatchTask, TaskResult
from cytodisk.runs.batch.input_row import InputRow, files_mark, write_row


def as_seen_by_all(task: BatchTask, target: str, run: str) -> BatchTask:
    """A task of a run with full paths, since workers are in other folders.

    Parameters
    ----------
    task : BatchTask
    target : str
    run : str
        As `begin_run` returns it.

    Returns
    -------
    BatchTask
    """
    return replace(task, inputs=tuple(map(_with_full_paths, task.inputs)), target=target, run=run)


def _with_full_paths(item: BatchInput) -> BatchInput:
    signal, nuclei = (None if path is None else _full_path(item, path) for path in (item.signal, item.nuclei))
    return replace(item, masks=item.masks.absolute(), signal=signal, nuclei=nuclei)


def _full_path(item: BatchInput, path: Path) -> Path:
    """The full path of a file; how names go on beside a folder's masks, as "_img", is no path."""
    if is_folder_of_files(item.masks) and not path.exists():
        return path
    return path.absolute()


def single_inputs(task: BatchTask) -> list[BatchTask]:
    """Tasks of one input each; none if it has no more than one."""
    return [replace(task, inputs=(item,)) for item in task.inputs] if len(task.inputs) > 1 else []


def give_up(task: BatchTask, reason: str) -> TaskResult:
    """Write rows for inputs that workers died of.

    Parameters
    ----------
    task : BatchTask
    reason : str

    Returns
    -------
    TaskResult

    Raises
    ------
    StudyError
        They cannot be written.
    """
    rows = [
        InputRow(item.name, item.kind, "killed", reason, item.settings, files_mark(item))
        for item in task.inputs
    ]
    for row in rows:
        write_row(open_store(task.target), row)
    return TaskResult(tuple(rows))
