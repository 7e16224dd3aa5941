"""The one way to work on many tasks: in this process, or in others that may die without harm to the rest."""

from __future__ import annotations

import pickle
import signal
import time as clock
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack
from threading import Lock
from types import TracebackType
from typing import Any, TypeVar

from cytodisk.errors import StudyError
from cytodisk.runs.worker_process import Answer, WorkerProcess

Task = TypeVar("Task")
Result = TypeVar("Result")

_TIME_TO_TIDY_S = 2.0  # of a process that is asked to end, before it is killed
_STARTS = 3  # of a process that is killed before it is ready
_WAITING = 2  # tasks a worker, so that a long list of tasks takes no memory


class WorkerDied(StudyError):
    """A process died of a task, twice, or was killed because it took too long.

    Attributes
    ----------
    status : {"crashed", "killed", "timed out"}
    reason : str
    log : str
        What the process said last.
    """

    def __init__(self, status: str, reason: str, log: str = ""):
        super().__init__(
            f"a worker process died ({reason}), perhaps for want of memory: what was done is kept; "
            "run the same command with --resume, and with fewer --workers"
        )
        self.status, self.reason, self.log = status, reason, log

    def __reduce__(self) -> tuple[Any, ...]:
        return WorkerDied, (self.status, self.reason, self.log)


class Processes:
    """Processes for the threads of this one: each thread that has a task has a process for itself.

    A process is kept for the next task, since starting one takes a second.

    Parameters
    ----------
    largest_mb : float, optional
        A process that has been larger is not used again, so that its memory is given back.
    module : str
        What a process loads before it is ready; by default the module of its first task.
    """

    def __init__(self, largest_mb: float = float("inf"), module: str = "") -> None:
        self._module = module
        self._largest_mb = largest_mb
        self._lock = Lock()
        self._all: set[WorkerProcess] = set()
        self._idle: list[WorkerProcess] = []
        self._closed = False

    def __enter__(self) -> Processes:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """End all processes; what they were at can be resumed."""
        with self._lock:
            self._closed = True
            idle, busy = self._idle, self._all - set(self._idle)
            self._idle = []
        for process in busy:
            process.ask_to_end()
        end = clock.monotonic() + _TIME_TO_TIDY_S
        while any(process.alive for process in busy) and clock.monotonic() < end:
            clock.sleep(0.01)
        for process in busy:
            process.kill()  # the thread that waits for it does the rest
        for process in idle:
            self._end(process)

    def call(self, work: Callable[..., Result], *arguments: Any, time_limit: float | None = None) -> Result:
        """Do a task; where a process dies of itself, once more in a fresh one.

        Parameters
        ----------
        work : callable
            Function of a module that can be imported.
        *arguments
            Can be pickled.
        time_limit : float, optional
            In seconds.

        Returns
        -------
        object
            What `work` returns; what it raises is raised here, with its traceback as a note.

        Raises
        ------
        WorkerDied
            The process died, and so did the second one; or the task took longer than the limit.
        StudyError
            A process cannot start, or the processes were closed.
        """
        task = pickle.dumps((work, arguments), pickle.HIGHEST_PROTOCOL)
        try:
            answer = self._answer(self._idle_process(work.__module__), task, time_limit)
        except WorkerDied as death:
            if death.status == "timed out":
                raise
            answer = self._answer(self._new_process(work.__module__), task, time_limit)
        if answer.fault is not None:
            raise answer.fault
        result: Result = answer.result
        return result

    def _answer(self, process: WorkerProcess, task: bytes, time_limit: float | None) -> Answer:
        answer = process.answer(task, time_limit)
        if answer is None:
            raise self._death(process, time_limit)
        if answer.peak_mb > self._largest_mb or isinstance(answer.fault, MemoryError):
            self._end(process)
        else:
            self._give_back(process)
        return answer

    def _death(self, process: WorkerProcess, time_limit: float | None) -> WorkerDied:
        code, words = self._end(process)
        self._check_open()
        if process.timed_out:
            return WorkerDied("timed out", f"took longer than the time limit of {time_limit:g} s")
        if code == -signal.SIGKILL:
            reason = "its process was killed (signal 9), as the system does when memory is short"
            return WorkerDied("killed", reason, words)
        return WorkerDied("crashed", f"its process {_cause(code)}", words)

    def _idle_process(self, module: str) -> WorkerProcess:
        with self._lock:
            process = self._idle.pop() if self._idle else None
        if process is not None and process.alive:
            return process
        if process is not None:
            self._end(process)
        return self._new_process(module)

    def _new_process(self, module: str) -> WorkerProcess:
        for _ in range(_STARTS):
            with self._lock:
                self._check_open()
                process = _start(self._module or module)
                self._all.add(process)
            if process.wait_until_ready():
                return process
            code, words = self._end(process)
            self._check_open()
            if code >= 0:
                break  # it was not killed: there is something wrong with it
        raise StudyError(f"no worker process can be started ({_cause(code)}): {words or 'no message'}")

    def _give_back(self, process: WorkerProcess) -> None:
        with self._lock:
            kept = not self._closed
            if kept:
                self._idle.append(process)
        if not kept:
            self._end(process)

    def _end(self, process: WorkerProcess) -> tuple[int, str]:
        with self._lock:
            self._all.discard(process)
        return process.end()

    def _check_open(self) -> None:
        if self._closed:
            raise StudyError("the run was stopped: run the same command again with --resume")


class Executor:
    """Works on tasks, several at a time; use it in a `with` block, at whose end no process stays behind.

    Parameters
    ----------
    workers : int
        Processes; with 1 everything runs in this one, at once.
    apart : bool
        Use a process of its own for 1 worker, too, so that a task which crashes or hangs does no harm.
    largest_mb : float, optional
    module : str
        See `Processes`.
    """

    def __init__(
        self, workers: int, *, apart: bool = False, largest_mb: float = float("inf"), module: str = ""
    ) -> None:
        self.processes = Processes(largest_mb, module)
        self._here = workers == 1 and not apart
        self._at_most = 1 if self._here else _WAITING * workers
        self._threads = ThreadPoolExecutor(workers)
        self._stack = ExitStack()

    def __enter__(self) -> Executor:
        self._stack.enter_context(self._threads)
        self._stack.enter_context(self.processes)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._threads.shutdown(wait=False, cancel_futures=True)
        self._stack.close()

    def submit(self, work: Callable[..., Result], *arguments: Any) -> Future[Result]:
        """Do a task; see `Processes.call` for what becomes of it in a process."""
        if not self._here:
            return self._threads.submit(self.processes.call, work, *arguments)
        return finished(work(*arguments))

    def each(self, work: Callable[[Task], Result], tasks: Iterable[Task]) -> Iterator[Result]:
        """Results of one function for many tasks, in their order; see `results`."""
        return self.results(self.submit(work, task) for task in tasks)

    def submit_thread(self, work: Callable[..., Result], *arguments: Any) -> Future[Result]:
        """Do a task in a thread of this process, which can call upon `processes`."""
        return self._threads.submit(work, *arguments)

    def results(self, submitted: Iterable[Future[Result]], *, in_order: bool = True) -> Iterator[Result]:
        """Results of tasks, at most two a worker on their way at a time, so that memory is bounded.

        Parameters
        ----------
        submitted : iterable of Future
            As `submit` returns them; gone through as results are taken.
        in_order : bool
            In the order of tasks, or else as they are done.

        Yields
        ------
        Result

        Raises
        ------
        WorkerDied
            See `Processes.call`.
        """
        waiting: list[Future[Result]] = []
        for future in submitted:
            waiting.append(future)
            if len(waiting) >= self._at_most:
                yield _next_of(waiting, in_order)
        while waiting:
            yield _next_of(waiting, in_order)


def finished(result: Result) -> Future[Result]:
    """A task that is done already."""
    future: Future[Result] = Future()
    future.set_result(result)
    return future


def _next_of(waiting: list[Future[Result]], in_order: bool) -> Result:
    place = 0
    if not in_order:
        wait(waiting, return_when=FIRST_COMPLETED)
        place = next(number for number, future in enumerate(waiting) if future.done())
    return waiting.pop(place).result()


def _start(module: str) -> WorkerProcess:
    try:
        return WorkerProcess(module)
    except OSError as error:
        raise StudyError(f"no worker process can be started: {error}") from error


def _cause(code: int) -> str:
    return f"died of {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"
