"""What ways to run tasks in other processes cost, and what a task that crashes, hangs or is killed costs.

    python benchmarks/executors.py

Compared: cytodisk's own processes, the standard library's pool, loky (in joblib) and Dask's LocalCluster.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import time
import timeit
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import contextmanager
from typing import Any, TypeAlias

import psutil

from cytodisk.runs.executor import Executor

WORKERS = 2
EMPTY_TASKS, GOOD_TASKS = 400, 8
PAYLOAD = bytes(100_000)  # about a cell's mask and signal
TIME_LIMIT_S, PATIENCE_S = 1.0, 10.0
LARGE_TASK = "bytearray(600_000_000)", "pass", time.perf_counter, 1  # as timeit takes it

Submit: TypeAlias = Callable[..., "Future[Any]"]


@contextmanager
def own() -> Iterator[Submit]:
    """cytodisk's processes."""
    with Executor(WORKERS, apart=True, largest_mb=500) as executor:
        yield lambda work, *arguments: executor.submit_thread(
            lambda: executor.processes.call(work, *arguments, time_limit=TIME_LIMIT_S)
        )


@contextmanager
def pool() -> Iterator[Submit]:
    """The standard library's processes."""
    with ProcessPoolExecutor(WORKERS, multiprocessing.get_context("spawn")) as executor:
        yield executor.submit
        _end_children(executor)


@contextmanager
def loky() -> Iterator[Submit]:
    """Processes of loky, as joblib has it."""
    from joblib.externals.loky import ProcessPoolExecutor as LokyExecutor

    executor = LokyExecutor(WORKERS)
    yield executor.submit
    executor.shutdown(kill_workers=True)


@contextmanager
def dask() -> Iterator[Submit]:
    """Processes of Dask's cluster on this machine."""
    from distributed import Client, LocalCluster

    with (
        LocalCluster(n_workers=WORKERS, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        yield lambda work, *arguments: client.submit(work, *arguments, pure=False)


WAYS = {"own processes": own, "ProcessPoolExecutor": pool, "loky": loky, "Dask LocalCluster": dask}


def main() -> None:
    """Print a line for each way and each question."""
    for name, way in WAYS.items():
        print(name)
        try:
            _costs(way)
        except ImportError as error:
            print(f"  not installed: {error}")
            continue
        print(f"  a task that crashes: {_harm(way, os.abort)}")
        print(f"  a task that is killed: {_harm(way, signal.raise_signal, signal.SIGKILL)}")
        print(f"  a task that hangs: {_harm(way, time.sleep, 1e6)}")
        print(f"  memory: {_memory(way)}")


def _costs(way: Callable[[], Any]) -> None:
    started = time.perf_counter()
    with way() as submit:
        submit(len, PAYLOAD).result()
        print(f"  {time.perf_counter() - started:.2f} s to start, until the first task is done")
        started = time.perf_counter()
        for future in [submit(len, PAYLOAD) for _ in range(EMPTY_TASKS)]:
            future.result()
        each = (time.perf_counter() - started) / EMPTY_TASKS
        print(f"  {1e3 * each:.2f} ms a task that does nothing, with 100 kB")


def _harm(way: Callable[[], Any], work: Callable[..., Any], *arguments: Any) -> str:
    """What becomes of eight good tasks beside a bad one."""
    with way() as submit:
        submit(len, PAYLOAD).result()
        started = time.perf_counter()
        bad = submit(work, *arguments)
        try:
            good = [submit(time.sleep, 0.1) for _ in range(GOOD_TASKS)]
            done = sum(_went_well(future, started) for future in good)
            ended = f"{time.perf_counter() - started:.1f} s"
            went = f"{done} of {GOOD_TASKS} others done within {ended}"
        except Exception as error:  # noqa: BLE001  a pool that is broken refuses more
            went = f"others are refused ({type(error).__name__})"
        try:
            bad.result(timeout=max(0.1, PATIENCE_S - (time.perf_counter() - started)))
        except TimeoutError:
            return f"{went}; it runs on for ever"
        except Exception as error:  # noqa: BLE001  each way has errors of its own
            return f"{went}; it ends with {type(error).__name__} after {time.perf_counter() - started:.1f} s"
        return f"{went}; it ends well"


def _went_well(future: Future[Any], started: float) -> bool:
    try:
        future.result(timeout=max(0.1, PATIENCE_S - (time.perf_counter() - started)))
    except Exception:  # noqa: BLE001  each way has errors of its own
        return False
    return True


def _memory(way: Callable[[], Any]) -> str:
    with way() as submit:
        for future in [submit(len, PAYLOAD) for _ in range(4 * WORKERS)]:
            future.result()
        idle = _megabytes()
        for future in [submit(timeit.timeit, *LARGE_TASK) for _ in range(WORKERS)]:
            future.result()
        return f"{idle:.0f} MB of all processes when idle, {_megabytes():.0f} MB after two tasks of 600 MB"


def _megabytes() -> float:
    here = psutil.Process()
    return sum(process.memory_info().rss for process in (here, *here.children(recursive=True))) / 1e6


def _end_children(executor: ProcessPoolExecutor) -> None:
    """End what hangs, for which the pool itself would wait."""
    for process in list((executor._processes or {}).values()):  # no public way
        process.kill()


if __name__ == "__main__":
    main()
