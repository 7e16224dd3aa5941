"""Processes that inputs are computed in: one may crash, hang or be killed without harm to the run."""

from __future__ import annotations

import signal
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock
from types import TracebackType
from typing import Any

from cytodisk.errors import StudyError, WriteError
from cytodisk.runs.batch.child_process import ChildProcess
from cytodisk.runs.batch.inputs import BatchInput

_STARTS = 3  # of a process that is killed before it is ready
_LARGE_MB = 500.0  # a process that has been as large is not used again, so that its memory is given back


@dataclass(frozen=True)
class Outcome:
    """How an input went.

    Attributes
    ----------
    status, reason : str
        As in `InputRow`.
    facts : dict
        Other fields of `InputRow`.
    """

    status: str
    reason: str = ""
    facts: dict[str, Any] = field(default_factory=dict)


class ChildPool:
    """Processes for the threads of this one: each thread that computes an input has a process for itself.

    A process is kept for the next input, since starting one takes a second or two.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._all: set[ChildProcess] = set()
        self._idle: list[ChildProcess] = []
        self._closed = False

    def __enter__(self) -> ChildPool:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Kill all processes; inputs they were at can be resumed."""
        with self._lock:
            self._closed = True
            idle, busy = self._idle, self._all - set(self._idle)
            self._idle = []
        for child in busy:
            child.kill()  # the thread that waits for it does the rest
        for child in idle:
            self._end(child)

    def compute(self, item: BatchInput, folder: Path, time_limit: float | None) -> Outcome:
        """Compute one input; where a process dies of itself, once more in a fresh one.

        Parameters
        ----------
        item : BatchInput
        folder : Path
            Of the input's study; what an earlier run left there is used.
        time_limit : float or None
            In seconds.

        Returns
        -------
        Outcome

        Raises
        ------
        StudyError
            Results cannot be written, a process cannot start, or the pool was closed.
        """
        outcome = self._compute_in(self._idle_child(), item, folder, time_limit)
        if outcome.status in ("crashed", "killed"):
            outcome = self._compute_in(self._new_child(), item, folder, time_limit)
        if outcome.status == "cannot write":
            raise WriteError(outcome.reason)
        return outcome

    def _compute_in(
        self, child: ChildProcess, item: BatchInput, folder: Path, time_limit: float | None
    ) -> Outcome:
        answer = child.answer(item, folder, time_limit)
        if answer is None:
            return self._death(child, time_limit)
        if answer.pop("peak_mb") > _LARGE_MB or answer["status"] == "out of memory":
            self._end(child)
        else:
            self._give_back(child)
        return Outcome(answer.pop("status"), answer.pop("reason"), answer)

    def _death(self, child: ChildProcess, time_limit: float | None) -> Outcome:
        code, words = self._end(child)
        self._check_open()
        if child.timed_out:
            return Outcome("timed out", f"took longer than the time limit of {time_limit:g} s")
        if code == -signal.SIGKILL:
            reason = "its process was killed (signal 9), as the system does when memory is short"
            return Outcome("killed", reason, {"log": words})
        return Outcome("crashed", f"its process {_cause(code)}", {"log": words})

    def _idle_child(self) -> ChildProcess:
        with self._lock:
            child = self._idle.pop() if self._idle else None
        if child is not None and child.alive:
            return child
        if child is not None:
            self._end(child)
        return self._new_child()

    def _new_child(self) -> ChildProcess:
        for _ in range(_STARTS):
            with self._lock:
                self._check_open()
                child = _start()
                self._all.add(child)
            if child.wait_until_ready():
                return child
            code, words = self._end(child)
            self._check_open()
            if code >= 0:
                break  # it was not killed: there is something wrong with it
        raise StudyError(
            f"no process for the inputs can be started ({_cause(code)}): {words or 'no message'}"
        )

    def _give_back(self, child: ChildProcess) -> None:
        with self._lock:
            kept = not self._closed
            if kept:
                self._idle.append(child)
        if not kept:
            self._end(child)

    def _end(self, child: ChildProcess) -> tuple[int, str]:
        with self._lock:
            self._all.discard(child)
        return child.end()

    def _check_open(self) -> None:
        if self._closed:
            raise StudyError("the run was stopped: run the same command again with --resume")


def _start() -> ChildProcess:
    try:
        return ChildProcess()
    except OSError as error:
        raise StudyError(f"no process for the inputs can be started: {error}") from error


def _cause(code: int) -> str:
    return f"died of {signal.Signals(-code).name}" if code < 0 else f"ended with exit code {code}"
