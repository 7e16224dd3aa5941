"""Worker processes of a run."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait
from threading import Thread
from typing import Any, TypeVar

from cytodisk.errors import StudyError

Task = TypeVar("Task")
Result = TypeVar("Result")


@contextmanager
def worker_pool(workers: int) -> Iterator[Executor]:
    """Processes to submit work to; with one worker everything runs in this process at once.

    Parameters
    ----------
    workers : int

    Yields
    ------
    Executor

    Raises
    ------
    StudyError
        A worker died.
    """
    if workers == 1:
        yield _Here()
        return
    try:
        with ProcessPoolExecutor(workers, get_context("spawn"), _leave_with_parent) as pool:
            yield pool
    except BrokenProcessPool as error:
        raise StudyError(
            "a worker process died, perhaps for want of memory: what was done is kept; "
            "run the same command with --resume, and with fewer --workers"
        ) from error


def in_order(work: Callable[[Task], Result], tasks: Iterable[Task], workers: int) -> Iterator[Result]:
    """Work on tasks; at most two tasks a worker wait at a time, so memory is bounded.

    Parameters
    ----------
    work : callable
        Can be pickled.
    tasks : iterable
        Gone through as results are taken.
    workers : int
        Processes; with 1 everything runs in this one.

    Yields
    ------
    Result
        In the order of tasks.

    Raises
    ------
    StudyError
        A worker died.
    """
    waiting: deque[Future[Result]] = deque()
    with worker_pool(workers) as pool:
        for task in tasks:
            waiting.append(pool.submit(work, task))
            if workers == 1 or len(waiting) >= 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


class _Here(Executor):
    """Runs what is submitted at once, in this process."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(fn(*args, **kwargs))
        return future


def _leave_with_parent() -> None:
    """Let a worker end when the main process is gone, even if that was killed."""
    parent = parent_process()
    if parent is not None:
        sentinel = parent.sentinel
        Thread(target=lambda: (wait([sentinel]), os._exit(1)), daemon=True).start()
