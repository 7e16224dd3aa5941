"""A task of a batch: a few inputs that are done one after the other, each in a process that may die."""

from __future__ import annotations

import atexit
import math
import shutil
import tempfile
import time as clock
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from cytodisk.errors import CytodiskError, StudyError, WriteError
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_folder_of_files
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.batch_target import is_latest, open_store
from cytodisk.runs.batch.compute_input import CANNOT_WRITE, RUNS, compute_input
from cytodisk.runs.batch.input_row import InputRow, files_mark, study_key, write_row
from cytodisk.runs.executor import Processes, WorkerDied
from cytodisk.store.targets import Store

LARGE_MB = 500.0  # a process that has been as large is not used again
_MOST_INPUTS = 100
# Time of a frame, with its cells: that of one cell, and what reading and more cells take in larger images.
_SECONDS_A_FRAME, _SECONDS_A_MEGAPIXEL = 0.1, 1.0


@dataclass(frozen=True)
class BatchTask:
    """A few inputs to be done one after the other; it can be pickled.

    Attributes
    ----------
    version : str
        Version of the cytodisk that made the task; a worker of another version refuses it.
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
        As `begin_run` returns it: a worker with a task of an earlier run publishes nothing. Empty: this is
        not looked at.
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


def make_tasks(
    inputs: Iterable[BatchInput], target: str, *, seconds: float, time_limit: float | None
) -> Iterator[BatchTask]:
    """Put inputs together, in their order, until a task takes about as long as wanted.

    Parameters
    ----------
    inputs : iterable of BatchInput
        Gone through as tasks are taken.
    target : str
    seconds : float
        How long a task should take at least; with 0 every input is a task.
    time_limit : float or None
        Of one input, in seconds.

    Yields
    ------
    BatchTask
    """
    here = version("cytodisk")
    some: list[BatchInput] = []
    expected = 0.0
    for item in inputs:
        some.append(item)
        expected += expected_seconds(item) if seconds > 0 else 0.0
        if expected >= seconds or len(some) == _MOST_INPUTS:
            yield BatchTask(here, tuple(some), target, time_limit)
            some, expected = [], 0.0
    if some:
        yield BatchTask(here, tuple(some), target, time_limit)


def expected_seconds(item: BatchInput) -> float:
    """A rough estimate of an input's time, from the number and size of its frames as the file's head says.

    Parameters
    ----------
    item : BatchInput

    Returns
    -------
    float
        0 for a file that cannot be read, which is soon found out. A folder counts as a task of its own.
    """
    if is_folder_of_files(item.masks):
        return math.inf
    if not item.masks.exists():
        return 0.0
    try:
        file = open_frames(item.masks, choice=item.parameters.mask_choice)
    except CytodiskError:
        return 0.0
    height, width = file.image_shape
    return file.n_frames * (_SECONDS_A_FRAME + _SECONDS_A_MEGAPIXEL * height * width / 1e6)


_SHARED = Processes(LARGE_MB, RUNS)
atexit.register(_SHARED.close)


def run_task(task: BatchTask, processes: Processes = _SHARED) -> TaskResult:
    """Do the inputs of a task, each in a process that may die; their rows are written one by one.

    Parameters
    ----------
    task : BatchTask
    processes : Processes
        By default some that live as long as this process.

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
    return TaskResult(tuple(_run_input(item, task, store, processes) for item in task.inputs))


def _run_input(item: BatchInput, task: BatchTask, store: Store, processes: Processes) -> InputRow:
    started, files = clock.monotonic(), files_mark(item)
    if task.scratch is None:
        facts = _compute(item, Path(task.target) / study_key(item.name), task, processes)
    else:
        with _scratch_folder(task.scratch) as place:
            facts = _compute(item, place / item.name, task, processes)
            if not is_latest(task.run, store):
                raise StudyError(
                    f"another run has begun at {task.target}: what this worker computed is thrown away"
                )
            if facts.get("complete"):
                store.put_folder(place / item.name, study_key(item.name))
    row = InputRow(item.name, item.kind, settings=item.settings, files=files, **facts)
    row = replace(row, seconds=round(clock.monotonic() - started, 3))
    write_row(store, row)
    return row


def _compute(item: BatchInput, folder: Path, task: BatchTask, processes: Processes) -> dict[str, Any]:
    """Fields of the input's row, whatever becomes of it."""
    try:
        facts = processes.call(compute_input, item, folder, time_limit=task.time_limit)
    except WorkerDied as death:
        return {"status": death.status, "reason": death.reason, "log": death.log}
    except MemoryError as error:
        words = {"status": "out of memory", "reason": f"memory ran out: {error}".rstrip(": ")}
        return words | {"log": "\n".join(error.__notes__)}
    if facts["status"] == CANNOT_WRITE:
        raise WriteError(facts["reason"])
    return facts


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
