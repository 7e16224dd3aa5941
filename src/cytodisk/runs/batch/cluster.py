"""Tasks of a batch on a Dask cluster: a few on their way for each thread, whatever their number in all."""

from __future__ import annotations

import asyncio
import logging
import pickle
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import replace
from itertools import chain, count, islice
from pathlib import Path
from queue import Empty, SimpleQueue
from struct import error as StructError
from typing import Any, Generic, TypeVar
from uuid import uuid4

from cytodisk.errors import CytodiskError, MissingPartError, ParameterError, StudyError
from cytodisk.runs.batch.batch_target import begin_run
from cytodisk.runs.batch.batch_task import BatchTask, TaskResult, run_task
from cytodisk.runs.batch.cluster_tasks import as_seen_by_all, give_up, single_inputs
from cytodisk.runs.batch.cluster_workers import Tell, Workers
from cytodisk.store.url_store import is_url

Task = TypeVar("Task")
Result = TypeVar("Result")

CONNECT_S = 10.0
WAIT_FOR_WORKERS_S = 3600.0  # the queue of a computing centre may be long
PER_THREAD = 3  # one at work, one that waits at the worker, one that waits at the scheduler
_LOOK_EVERY_S = 2.0
_RESULT_S = 30.0


def run_on_cluster(
    tasks: Iterable[BatchTask],
    address: str,
    *,
    target: str,
    tell: Tell,
    wait_s: float = WAIT_FOR_WORKERS_S,
) -> Iterator[TaskResult]:
    """Run tasks on the workers of a Dask cluster.

    A task whose worker dies is tried on another one, as often as the scheduler's setting
    "allowed-failures" says; after that its inputs are tried one by one, and those that fail have a row.

    Parameters
    ----------
    tasks : iterable of BatchTask
        Gone through as results are taken.
    address : str
        Address of the scheduler, as "tcp://10.0.0.1:8786".
    target : str
        Where all tasks write: folder that all workers see, or URL of an object store. Inputs must stand where
        all workers see them.
    tell : callable
    wait_s : float
        How long to wait while there is no worker, in seconds.

    Yields
    ------
    TaskResult
        In order of completion.

    Raises
    ------
    MissingPartError
        distributed is not installed.
    ParameterError
        `address` is not an address.
    StudyError
        The scheduler does not answer or is lost, no worker comes, or a worker has another version of
        cytodisk or does not see the target.
    """
    target = target if is_url(target) else str(Path(target).absolute())
    rest = iter(tasks)
    first = next(rest, None)
    if first is None:
        return
    with connected(address) as client:
        run = begin_run(target)
        shared = (target, run, *(str(item.masks.absolute()) for item in first.inputs))
        workers = Workers(client, address, tell, wait_s, shared)
        flight = Flight(client, workers, _run_in_scratch, single_inputs, give_up)
        yield from flight.results(as_seen_by_all(task, target, run) for task in chain([first], rest))


@contextmanager
def connected(address: str) -> Iterator[Any]:
    """A client of a scheduler.

    Parameters
    ----------
    address : str

    Yields
    ------
    distributed.Client

    Raises
    ------
    MissingPartError, ParameterError, StudyError
        As for `run_on_cluster`.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise MissingPartError.of("a cluster needs distributed", "cluster") from error
    for name in ("distributed", "distributed.client"):  # each has a level of its own
        logging.getLogger(name).setLevel(logging.CRITICAL)  # what matters is raised
    try:
        with ThreadPoolExecutor(1) as thread:  # there may be an event loop in this one
            who = thread.submit(asyncio.run, _greet(address)).result()
        if who != "Scheduler":
            raise LookupError(f"its type is {who}")
        client = Client(address, timeout=CONNECT_S, set_as_default=False)
    except ValueError as error:
        raise ParameterError(
            f"scheduler must be an address as tcp://10.0.0.1:8786, got {address!r}: {error}"
        ) from error
    except TypeError as error:  # "tls" without certificates, "ucx" without its library
        raise ParameterError(f"scheduler {address} cannot be reached from here: {error}") from error
    except OSError as error:
        raise StudyError(
            f"scheduler {address} does not answer within {CONNECT_S:.0f} s: check the address, that "
            "`dask scheduler` runs there, and that this machine can reach it"
        ) from error
    except (MemoryError, LookupError, StructError) as error:  # a worker, or an answer in another protocol
        raise StudyError(
            f"what answers at {address} is no Dask scheduler: pass the address that `dask scheduler` prints "
            "behind `Scheduler at:`, not that of its dashboard or of a worker"
        ) from error
    try:
        yield client
    finally:
        client.close(timeout=CONNECT_S)


async def _greet(address: str) -> str:
    """Ask who is there, because `Client` waits for ever where something listens that never answers."""
    from distributed.comm import connect  # type: ignore[attr-defined]
    from distributed.core import send_recv

    async with asyncio.timeout(CONNECT_S):
        comm = await connect(address, timeout=CONNECT_S)
        try:
            return str((await send_recv(comm, op="identity"))["type"])
        finally:
            comm.abort()


class Flight(Generic[Task, Result]):
    """Tasks on their way, never more than a few for each thread of the cluster.

    Parameters
    ----------
    client : distributed.Client
    workers : Workers
    work : callable
        Runs on a worker; its result must be small.
    parts : callable
        Parts of a task to try one by one when workers died of it; empty if it has none.
    given_up : callable
        (task, reason) → result of a task that workers died of.
    """

    def __init__(
        self,
        client: Any,
        workers: Workers,
        work: Callable[[Task], Result],
        parts: Callable[[Task], list[Task]],
        given_up: Callable[[Task, str], Result],
    ):
        self._client = client
        self._workers = workers
        self._work = work
        self._parts = parts
        self._given_up = given_up
        self._again: list[Task] = []
        self._flying: dict[str, tuple[Any, Task]] = {}
        self._landed: SimpleQueue[Any] = SimpleQueue()
        self._keys = map(f"batch-{uuid4().hex[:8]}-{{}}".format, count())

    def results(self, tasks: Iterable[Task]) -> Iterator[Result]:
        """Run tasks, gone through as results are taken, and give results in order of completion.

        Raises
        ------
        StudyError
            The scheduler was lost, no worker is left, or one of them does not fit.
        """
        rest = iter(tasks)
        while True:
            with self._not_lost():
                self._send(rest)
            if not self._flying:
                return
            for future in self._arrived():
                with self._not_lost():
                    found = self._result(future)
                yield from found

    def _send(self, rest: Iterator[Task]) -> None:
        room = max(0, PER_THREAD * self._workers.threads() - len(self._flying))
        some, self._again = self._again[:room], self._again[room:]
        some += islice(rest, room - len(some))
        if not some:
            return
        from distributed.protocol.pickle import dumps

        keys = list(islice(self._keys, len(some)))
        calls = [dumps(_Call(self._work, task)) for task in some]
        futures = self._client.map(pickle.loads, calls, key=keys, pure=False)
        for key, future, task in zip(keys, futures, some, strict=True):
            self._flying[key] = future, task
            future.add_done_callback(self._landed.put)

    def _arrived(self) -> Iterator[Any]:
        """All that have come by now, or come within a moment."""
        try:
            yield self._landed.get(timeout=_LOOK_EVERY_S)
            while True:
                yield self._landed.get_nowait()
        except Empty:
            return

    def _result(self, future: Any) -> list[Result]:
        """The result of a task; none if it is on its way again."""
        from distributed import KilledWorker

        if future.status == "error":
            fault = future.exception(timeout=_RESULT_S)
            _, task = self._flying.pop(future.key)
            if not isinstance(fault, KilledWorker):
                self._workers.check_all()  # a worker that does not fit is the likely cause
                raise fault if not _of_system(fault) else StudyError(f"a worker failed: {fault}") from fault
            self._again += self._parts(task)
            if self._parts(task):
                return []
            deaths, last = fault.allowed_failures + 1, fault.last_worker.address
            return [self._given_up(task, f"its workers died ({deaths}, the last one {last})")]
        try:
            found = future.result(timeout=_RESULT_S)
        except TimeoutError:  # its worker died with the result, and another one is at it
            future.add_done_callback(self._landed.put)
            return []
        del self._flying[future.key]
        return [found]

    @contextmanager
    def _not_lost(self) -> Iterator[None]:
        try:
            yield
        except CytodiskError:
            raise
        except (OSError, CancelledError) as error:
            raise StudyError(
                f"scheduler {self._workers.address} was lost: what was done is kept; start it again and run "
                "the same command with --resume"
            ) from error


def _of_system(fault: BaseException) -> bool:
    """Whether it is an error of the worker's system, not to be taken for a loss of the scheduler."""
    return isinstance(fault, OSError) and not isinstance(fault, CytodiskError)


class _Call:
    """A call that is made by whoever unpickles it.

    A scheduler unpickles the functions and arguments that it passes on. As bytes for `pickle.loads` they cost
    it nothing, and it need not have cytodisk.
    """

    def __init__(self, work: Callable[[Any], Any], task: Any):
        self._call = work, (task,)

    def __reduce__(self) -> tuple[Callable[[Any], Any], tuple[Any]]:
        return self._call


def _run_in_scratch(task: BatchTask) -> TaskResult:
    """Run a task on a worker, in the folder that is removed with the worker."""
    from distributed import get_worker

    return run_task(replace(task, scratch=get_worker().local_directory))
