"""One executor for all runs: order, bounds, and what a task that fails, crashes or hangs costs."""

import operator
import os
import signal
import time
from collections.abc import Iterator
from concurrent.futures import Future

import numpy as np
import pytest

from cytodisk.errors import EmptyMaskError, StudyError
from cytodisk.geometry.mask import clean_mask
from cytodisk.runs.executor import Executor, Processes, WorkerDied

posix = pytest.mark.skipif(not hasattr(os, "killpg"), reason="signals are POSIX")


@pytest.mark.parametrize("workers", [1, 2])
def test_results_come_in_the_order_of_tasks(workers: int) -> None:
    with Executor(workers) as executor:
        assert list(executor.each(abs, range(-20, 0))) == list(range(20, 0, -1))


def test_results_can_be_taken_as_they_come() -> None:
    with Executor(2) as executor:
        submitted = (executor.submit(time.sleep, seconds) for seconds in (1.5, 0.0, 0.0, 0.0))
        results = executor.results(submitted, in_order=False)
        started = time.perf_counter()
        for _ in range(3):
            next(results)
        assert time.perf_counter() - started < 1.4
        assert list(results) == [None]


@pytest.mark.parametrize(("workers", "ahead"), [(1, 1), (2, 4)])
def test_few_tasks_are_on_their_way_at_a_time(workers: int, ahead: int) -> None:
    taken: list[int] = []
    with Executor(workers) as executor:

        def submitted() -> Iterator[Future[int]]:
            for number in range(50):
                taken.append(number)
                yield executor.submit(abs, number)

        for done, _ in enumerate(executor.results(submitted()), 1):
            assert len(taken) < done + ahead


def test_one_worker_is_this_process_unless_it_is_set_apart() -> None:
    with Executor(1) as here, Executor(1, apart=True) as apart:
        assert here.submit(os.getpid).result() == os.getpid()
        assert apart.submit(os.getpid).result() != os.getpid()


def test_what_a_task_raises_comes_with_where_it_was() -> None:
    with Processes() as processes:
        with pytest.raises(ZeroDivisionError) as caught:
            processes.call(operator.truediv, 1, 0)
        assert "Traceback" in caught.value.__notes__[0]
        with pytest.raises(RuntimeError, match="cannot pickle"):
            processes.call(operator.methodcaller("items"), {})  # its result cannot come here
        with pytest.raises(TypeError, match="cannot pickle"):
            processes.call(len, {}.items())
        assert processes.call(abs, -1) == 1


@posix
def test_a_task_that_crashes_or_hangs_harms_no_other() -> None:
    with Executor(2) as executor:
        crashing = executor.submit(os.abort)
        assert list(executor.each(abs, range(10))) == list(range(10))
        with pytest.raises(WorkerDied, match=r"died of SIGABRT.*--resume") as caught:
            crashing.result()
        assert caught.value.status == "crashed"
        assert "Fatal Python error: Aborted" in caught.value.log
        with pytest.raises(WorkerDied, match=r"longer than the time limit of 0\.2 s"):
            executor.processes.call(time.sleep, 60, time_limit=0.2)
        with pytest.raises(WorkerDied, match=r"signal 9"):
            executor.processes.call(signal.raise_signal, signal.SIGKILL)


def test_a_process_that_was_large_or_ran_out_of_memory_is_not_used_again() -> None:
    with Processes(largest_mb=1.0) as processes:
        assert processes.call(os.getpid) != processes.call(os.getpid)
    with Processes() as processes:
        first = processes.call(os.getpid)
        assert processes.call(os.getpid) == first
        with pytest.raises(MemoryError):
            processes.call(bytearray, 2**62)
        assert processes.call(os.getpid) != first


def test_closed_it_takes_no_more() -> None:
    with Processes() as processes:
        pass
    with pytest.raises(StudyError, match="--resume"):
        processes.call(abs, 1)


def test_errors_of_the_package_stay_what_they_are() -> None:
    mask = np.zeros((5, 5), dtype=bool)
    with Processes() as processes, pytest.raises(EmptyMaskError, match="empty"):
        processes.call(clean_mask, mask)
