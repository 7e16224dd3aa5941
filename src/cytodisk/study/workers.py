"""Worker processes of a run."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import get_context, parent_process
from multiprocessing.connection import wait
from threading import Thread
from typing import Any

from cytodisk.errors import StudyError


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
