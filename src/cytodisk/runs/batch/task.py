"""What a worker is given: a few inputs, and where their results go."""

from __future__ import annotations

import atexit
import shutil
import tempfile
import time as clock
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path

from cytodisk.errors import StudyError
from cytodisk.runs.batch.child_pool import ChildPool
from cytodisk.runs.batch.inputs import BatchInput
from cytodisk.runs.batch.rows import InputRow, files_mark, study_key, write_row
from cytodisk.store.targets import FolderStore, Store
from cytodisk.store.url_store import UrlStore, is_url

RUN = ".run"


@dataclass(frozen=True)
class BatchTask:
    """A few inputs to be done one after the other; it can be pickled.

    Attributes
    ----------
    version : str
        Of the cytodisk that made the task; a worker of another version refuses it.
    inputs : tuple of BatchInput
    target : str
        Folder of the batch's results, or the URL of an object store.
    time_limit : float or None
        Seconds for one input.
    scratch : str or None
        Folder of the worker's own to compute in, from where a finished study moves to the target in one
        step; None to compute in the target, where a stopped movie goes on from its last frame. With ""
        the system's folder for temporary files.
    run : str
        A token that stands at the target as ".run" while this run is the last one that was started there;
        a worker with a task of an earlier run publishes nothing. Empty: this is not looked at.
    """

    version: str
    inputs: tuple[BatchInput, ...]
    target: str
    time_limit: float | None = None
    scratch: str | None = None
    run: str = ""


@dataclass(frozen=True)
class TaskResult:
    """How the inputs of a task went; it is small, and can be pickled."""

    rows: tuple[InputRow, ...]


_SHARED = ChildPool()
atexit.register(_SHARED.close)


def run_task(task: BatchTask, children: ChildPool = _SHARED) -> TaskResult:
    """Do the inputs of a task, each in a process that may die; their rows are written one by one.

    Parameters
    ----------
    task : BatchTask
    children : ChildPool
        By default one that lives as long as this process.

    Returns
    -------
    TaskResult
        A row for every input, also for those that failed.

    Raises
    ------
    StudyError
        This is another version of cytodisk, results cannot be written (a full disk), or a process cannot
        even start: the run must stop.
    """
    here = version("cytodisk")
    if task.version != here:
        raise StudyError(
            f"this worker has cytodisk {here}, the batch is run by cytodisk {task.version}: "
            "install the same version on all workers"
        )
    store = open_store(task.target)
    return TaskResult(tuple(_run_input(item, task, store, children) for item in task.inputs))


def open_store(target: str) -> Store:
    """The place that results are written to.

    Parameters
    ----------
    target : str
        A folder, or the URL of an object store.

    Returns
    -------
    Store

    Raises
    ------
    MissingPartError, StudyError
        As for `UrlStore`.
    """
    return UrlStore(target) if is_url(target) else FolderStore(target)


def _run_input(item: BatchInput, task: BatchTask, store: Store, children: ChildPool) -> InputRow:
    started, files = clock.monotonic(), files_mark(item)
    if task.scratch is None:
        outcome = children.compute(item, Path(task.target) / study_key(item.name), task.time_limit)
    else:
        with _scratch_folder(task.scratch) as place:
            outcome = children.compute(item, place / item.name, task.time_limit)
            _check_run(task, store)
            if outcome.facts.get("complete"):
                store.put_folder(place / item.name, study_key(item.name))
    row = InputRow(item.name, item.kind, outcome.status, outcome.reason, item.settings, files)
    row = replace(row, **outcome.facts, seconds=round(clock.monotonic() - started, 3))
    write_row(store, row)
    return row


def _check_run(task: BatchTask, store: Store) -> None:
    there = store.read_text(RUN) if task.run else None
    if there is not None and there != task.run:
        raise StudyError(f"another run has begun at {task.target}: what this worker computed is thrown away")


@contextmanager
def _scratch_folder(parent: str) -> Iterator[Path]:
    try:
        place = Path(tempfile.mkdtemp(prefix="cytodisk-", dir=parent or None))
    except OSError as error:
        raise StudyError(
            f"scratch folder {parent or tempfile.gettempdir()} cannot be written: {error.strerror}"
        ) from error
    try:
        yield place
    finally:
        shutil.rmtree(place, ignore_errors=True)
