"""What a cluster's workers are asked to do, and what stands in for one that died."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from uuid import uuid4

from cytodisk.errors import CytodiskError
from cytodisk.runs.batch.inputs import BatchInput
from cytodisk.runs.batch.rows import InputRow, files_mark, write_row
from cytodisk.runs.batch.task import RUN, BatchTask, TaskResult, open_store


def begin_run(target: str) -> str:
    """Take a folder or URL over: workers of an earlier run that are still at it publish nothing any more.

    Parameters
    ----------
    target : str

    Returns
    -------
    str
        The name of the run, which stands in the target now.

    Raises
    ------
    StudyError
        The target cannot be written.
    """
    run = uuid4().hex
    open_store(target).write_text(RUN, run)
    return run


def what_is_hidden(target: str, run: str, *files: str) -> str:
    """What a worker, which this runs on, does not see; in words, empty if it sees all.

    Parameters
    ----------
    target : str
    run : str
        As `begin_run` returns it.
    *files : str
        Some of the inputs.

    Returns
    -------
    str
    """
    try:
        found = open_store(target).read_text(RUN)
    except CytodiskError as error:
        return f"does not reach the results: {error}"
    if found != run:
        return (
            f"does not see the results in {target}: pass a folder that is shared by all workers, under the "
            "same name everywhere, or the URL of an object store"
        )
    for file in files:
        if not Path(file).exists():
            return f"does not see input {file}: inputs must be on a folder that is shared by all workers"
    return ""


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
    inputs = (replace(item, masks=item.masks.absolute(), signal=_signal(item)) for item in task.inputs)
    return replace(task, inputs=tuple(inputs), target=target, run=run)


def _signal(item: BatchInput) -> Path | None:
    """The signal's full path; how names of images go on beside a folder's masks, as "_img", is no path."""
    if item.signal is None or (item.masks.is_dir() and not item.signal.exists()):
        return item.signal
    return item.signal.absolute()


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
