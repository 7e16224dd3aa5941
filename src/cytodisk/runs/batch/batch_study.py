"""A batch: many inputs in one go, and their tables merged."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing
from dataclasses import dataclass, field, replace
from threading import TIMEOUT_MAX
from typing import Any, TypeAlias

from cytodisk.errors import OtherRunError, StudyError, WriteError
from cytodisk.runs.batch.batch_file import Batch
from cytodisk.runs.batch.batch_folder import (
    describe_batch,
    make_room,
    note,
    now,
    remove_left_overs,
    wants_csv,
)
from cytodisk.runs.batch.batch_input import BatchInput
from cytodisk.runs.batch.batch_target import begin_run, open_store
from cytodisk.runs.batch.batch_task import LARGE_MB, BatchTask, TaskResult, make_tasks, run_task
from cytodisk.runs.batch.compute_input import RUNS
from cytodisk.runs.batch.input_row import ROWS, InputRow, files_mark, read_row, row_key, study_key
from cytodisk.runs.batch.merged_tables import merge_batch
from cytodisk.runs.executor import Executor
from cytodisk.runs.map.map_kind import MAP
from cytodisk.runs.movie.movie_kind import MOVIE
from cytodisk.runs.run_options import BatchOptions, Progress, silent
from cytodisk.store.provenance_file import PROVENANCE, parse_provenance
from cytodisk.store.study_kind import PARTS
from cytodisk.store.targets import Store
from cytodisk.store.url_store import is_url
from cytodisk.store.written_files import FILES, recorded
from cytodisk.taking import takes

_CLUSTER_TASK_S = 10.0
_MOST_NAMED = 5
_MOST_FAILED = 20

Results: TypeAlias = Generator[TaskResult, None, None]
Tell: TypeAlias = Callable[[str], None]
"""Called with a sentence for the user."""


@dataclass
class BatchSummary:
    """How a batch went.

    Attributes
    ----------
    out : str
        Folder of the results.
    statuses : Counter of str
        Number of inputs by status.
    failed : list of InputRow
        The first twenty that are not "ok".
    remarks : list of str
        What else the user should know.
    flags : Counter of str
        Number of inputs by the name of a QC flag that their study has.
    """

    out: str
    statuses: Counter[str] = field(default_factory=Counter)
    failed: list[InputRow] = field(default_factory=list)
    remarks: list[str] = field(default_factory=list)
    flags: Counter[str] = field(default_factory=Counter)

    def count(self, row: InputRow) -> None:
        """Take an input into account."""
        self.statuses[row.status] += 1
        self.flags.update(filter(None, row.flags.split("; ")))
        if row.status != "ok" and len(self.failed) < _MOST_FAILED:
            self.failed.append(row)


@takes(BatchOptions)
def batch_study(
    batch: Batch,
    out: str | os.PathLike[str],
    *,
    progress: Progress | None = None,
    tell: Tell = print,
    **settings: Any,
) -> BatchSummary:
    """Run all inputs of a batch, each in a process of its own, and merge their tables.

    Parameters
    ----------
    batch : Batch
        As `read_batch` returns it.
    out : path-like
        Folder of the results: a study for each input in inputs/, its row in rows/, and the merged tables.
    progress : callable, optional
        Called with (inputs done, inputs in all).
    tell : callable
        Called with sentences on workers of a cluster.
    **settings
        See `BatchOptions`.

    Returns
    -------
    BatchSummary

    Raises
    ------
    ParameterError
        `workers` is below 1, `time_limit` is no time, or both `resume` and `overwrite` are set.
    StudyError
        The folder cannot be used, or results cannot be written, as on a full disk.
    """
    options = BatchOptions.of(**settings)
    scheduler, resume = options.scheduler, options.resume
    limit = None if options.time_limit is None else min(options.time_limit, TIMEOUT_MAX)
    if scheduler is not None and not resume:
        _reach(scheduler)  # before the folder is touched
    target = os.fspath(out)
    store = open_store(target)
    with store.alone():
        csv = wants_csv(store, target, options.csv, resume)
        provenance = describe_batch(batch, csv)
        before = make_room(store, batch, provenance, target, resume=resume, overwrite=options.overwrite)
        provenance[FILES] = before | provenance[FILES]
        summary = BatchSummary(target)
        pending = list(batch.inputs)
        if resume:
            pending = pending_inputs(store, batch, summary)
            remove_left_overs(store)
        note(store, provenance)
        if scheduler is None:
            tasks = make_tasks(pending, target, seconds=0, time_limit=limit)
            results = _run_here(_started(tasks, target), min(options.workers, max(1, len(pending))))
        else:
            tasks = make_tasks(pending, target, seconds=_CLUSTER_TASK_S, time_limit=limit)
            results = _on_cluster(tasks, scheduler, target, tell)
        try:
            _take(results, len(pending), len(batch.inputs), progress or silent)
            summary.remarks += merge_batch(store, batch, summary.count, csv)
            note(store, provenance | {"status": "complete", "finished": now(), "warnings": summary.remarks})
        except WriteError as error:
            raise WriteError(
                f"{error}: the run stops, what was done is kept; mend this (is the disk full?), then run the "
                "command again with --resume"
            ) from error
    return summary


def _take(results: Results, pending: int, total: int, report: Progress) -> None:
    """Count what is done; the rows are written already."""
    with closing(results):  # whatever happens, no process stays behind
        done = total - pending
        report(done, total)
        for result in results:
            done += len(result.rows)
            report(done, total)


def _run_here(tasks: Iterator[BatchTask], workers: int) -> Results:
    """Do tasks on this machine, as they come, each input in a process of its own."""
    with Executor(workers, apart=True, largest_mb=LARGE_MB, module=RUNS) as executor:
        submitted = (executor.submit_thread(run_task, task, executor.processes) for task in tasks)
        yield from executor.results(submitted, in_order=False)


def _started(tasks: Iterator[BatchTask], target: str) -> Iterator[BatchTask]:
    """Tasks of a run that takes over from workers of a cluster which may still be at an earlier one."""
    run = begin_run(target)
    for task in tasks:
        yield replace(task, scratch="", run=run) if is_url(target) else task


def _on_cluster(tasks: Iterator[BatchTask], scheduler: str, target: str, tell: Tell) -> Results:
    from cytodisk.runs.batch.cluster import run_on_cluster

    yield from run_on_cluster(tasks, scheduler, target=target, tell=tell)


def _reach(scheduler: str) -> None:
    from cytodisk.runs.batch.cluster import connected

    with connected(scheduler):
        return


def pending_inputs(store: Store, batch: Batch, summary: BatchSummary) -> list[BatchInput]:
    """Inputs that are still to be done; what was done must be what the batch file says now."""
    pending, changed, others, damaged = [], [], [], []
    for item in batch.inputs:
        row = _whole_row(store, item.name)
        if row is None and store.read_text(row_key(item.name)) is not None:
            damaged.append(item.name)
            pending.append(item)
        elif row is None or row.status != "ok":
            pending.append(item)
        elif row.settings != item.settings:
            others.append(item.name)
        elif row.files != files_mark(item):
            changed.append(item.name)
            pending.append(item)
    if others:
        raise OtherRunError(
            f"output folder {summary.out} holds results with other parameters for {_named(others)}: "
            "pass --overwrite to replace all, or another folder; to do only these anew, remove their rows "
            f"(as {row_key(others[0])}) and pass --resume"
        )
    if damaged:
        summary.remarks.append(f"damaged since they were done, so they are done anew: {_named(damaged)}")
    names = {item.name for item in batch.inputs}
    gone = sorted(name for name in _with_row(store) if name not in names)
    if changed:
        summary.remarks.append(
            f"files changed since they were done, so they are looked at again: {_named(changed)}"
        )
    if gone:
        summary.remarks.append(
            f"not in the batch file any more, so not in the tables, though their results stay: {_named(gone)}"
        )
    return pending


def _whole_row(store: Store, name: str) -> InputRow | None:
    """The row of an input; None if it was not done, or it or the study is not as it was written."""
    try:
        row = read_row(store, name)
        there = parse_provenance(store.read_text(f"{study_key(name)}/{PROVENANCE}") or "null") or {}
    except StudyError:
        return None
    if row is None or not row.complete:
        return row
    kind = MOVIE if row.kind == MOVIE.run else MAP
    marks = {file: mark for file, mark in recorded(there).items() if kind.with_nuclei.may_write(file)}
    whole = there.get("status") == "complete" and not any(store.names(f"{study_key(name)}/{PARTS}"))
    whole = whole and not store.lost_files(study_key(name), marks)
    return row if whole else None


def _with_row(store: Store) -> Iterator[str]:
    found = (name for name in store.names(ROWS) if name.endswith(".json") and not name.startswith("."))
    return (name.removesuffix(".json") for name in found)


def _named(names: Sequence[str]) -> str:
    shown = ", ".join(names[:_MOST_NAMED])
    return shown if len(names) <= _MOST_NAMED else f"{shown} and {len(names) - _MOST_NAMED} more"
