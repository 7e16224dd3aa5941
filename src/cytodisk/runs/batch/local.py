"""A batch on this machine."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from itertools import islice

from cytodisk.runs.batch.child_pool import ChildPool
from cytodisk.runs.batch.task import BatchTask, TaskResult, run_task

_WAITING = 2  # tasks a worker, so that a long list of inputs takes no memory


def run_here(tasks: Iterable[BatchTask], workers: int) -> Generator[TaskResult, None, None]:
    """Do tasks, several at a time.

    Parameters
    ----------
    tasks : iterable of BatchTask
        Gone through as results are taken.
    workers : int
        Processes.

    Yields
    ------
    TaskResult
        In the order in which they are done.

    Raises
    ------
    StudyError
        Results cannot be written, or no process can be started.
    """
    rest = iter(tasks)
    waiting: set[Future[TaskResult]] = set()
    with ThreadPoolExecutor(workers) as threads, ChildPool() as children:
        try:
            while True:
                more = islice(rest, _WAITING * workers - len(waiting))
                waiting |= {threads.submit(run_task, task, children) for task in more}
                if not waiting:
                    return
                done, waiting = wait(waiting, return_when=FIRST_COMPLETED)
                for future in done:
                    yield future.result()
        finally:
            threads.shutdown(wait=False, cancel_futures=True)
