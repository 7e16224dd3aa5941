"""A process that does one task after the other: both of its ends, and what they say to each other.

A message is its length in 8 bytes and a pickle. Tasks go in by stdin as (function, arguments), answers come
out by stdout as an `Answer`.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import traceback
from contextlib import suppress
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from queue import SimpleQueue
from threading import Thread, Timer
from typing import IO, Any

from cytodisk.stopping import Stopped, stopping_tidily

_LENGTH_BYTES = 8
_MOST_WORDS = 2000  # characters kept of the beginning and of the end of what a process said
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


@dataclass(frozen=True)
class Answer:
    """What became of a task.

    Attributes
    ----------
    result : object
    fault : Exception or None
        What the function raised, with its traceback as a note.
    peak_mb : float
        The most memory that the process has taken so far.
    """

    result: Any = None
    fault: Exception | None = None
    peak_mb: float = 0.0


class WorkerProcess:
    """The near end of a process in a group of its own, so that it can be killed with all that it started.

    Parameters
    ----------
    module : str
        What the process loads before it is ready.

    Attributes
    ----------
    timed_out : bool
        Whether it was killed because a task took too long.
    """

    def __init__(self, module: str) -> None:
        self.timed_out = False
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  is closed at the end of the process
        self._log_start = 0
        self._process = subprocess.Popen(
            # -P: modules are not taken from the folder that the user happens to be in.
            [sys.executable, "-P", "-X", "faulthandler", "-m", __name__, module],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            env=os.environ | _ONE_THREAD,
            start_new_session=True,
        )

    @property
    def pid(self) -> int:
        """Its number in the system."""
        return self._process.pid

    @property
    def alive(self) -> bool:
        """Whether it can be given a task."""
        return self._process.poll() is None and not self.timed_out

    def wait_until_ready(self) -> bool:
        """Whether it has started; the first second goes into loading code."""
        return _receive(self._process.stdout) is not None

    def answer(self, task: bytes, time_limit: float | None = None) -> Answer | None:
        """Do a task; None if the process died, or was killed because it took too long.

        Parameters
        ----------
        task : bytes
            Pickle of (function, arguments); the function must be of a module that the process can import.
        time_limit : float, optional
            In seconds.

        Returns
        -------
        Answer or None
        """
        self._log_start = os.fstat(self._log.fileno()).st_size
        watch = Timer(time_limit, self._time_out) if time_limit else None
        try:
            if watch is not None:
                watch.daemon = True
                watch.start()
            _send(self._process.stdin, task)
            found = _receive(self._process.stdout)
        except BrokenPipeError:
            return None
        finally:
            if watch is not None:
                watch.cancel()
        return None if found is None else pickle.loads(found)

    def ask_to_end(self) -> None:
        """Let it remove its locks and temporary files; in the middle of compiled code it does not hear."""
        with suppress(OSError):  # it has ended already
            self._process.terminate()

    def kill(self) -> None:
        """Kill it and all that it started."""
        with suppress(ProcessLookupError):  # it has ended already
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()

    def end(self) -> tuple[int, str]:
        """End it: its exit code (negative if it died of a signal) and what it said on its last task."""
        if self._process.poll() is None:
            self.kill()
        code = self._process.wait()
        for pipe in (self._process.stdin, self._process.stdout):
            with suppress(BrokenPipeError):  # what could not be sent to it is not missed
                if pipe is not None:
                    pipe.close()
        self._log.seek(self._log_start)
        words = self._log.read().decode(errors="replace").strip()
        self._log.close()
        if len(words) > 2 * _MOST_WORDS:
            words = f"{words[:_MOST_WORDS]}\n…\n{words[-_MOST_WORDS:]}"
        return code, words

    def _time_out(self) -> None:
        self.timed_out = True
        self.kill()


def _send(pipe: IO[bytes] | None, message: bytes) -> None:
    assert pipe is not None  # the process was started with pipes
    pipe.write(len(message).to_bytes(_LENGTH_BYTES))
    pipe.write(message)
    pipe.flush()


def _receive(pipe: IO[bytes] | None) -> bytes | None:
    """The next message; None at the end of the pipe."""
    assert pipe is not None  # the process was started with pipes
    head = pipe.read(_LENGTH_BYTES)
    if len(head) < _LENGTH_BYTES:
        return None
    size = int.from_bytes(head)
    message = pipe.read(size)
    return message if len(message) == size else None


def main() -> None:
    """The far end: answer until stdin ends, which it does when the process that started this one is gone."""
    _be_killed_first()
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # who started this one hears Ctrl-C, and ends it
    try:
        with stopping_tidily():
            _answer_all()
    except Stopped as stop:
        signal.signal(stop.number, signal.SIG_DFL)
        os.kill(os.getpid(), stop.number)


def _answer_all() -> None:
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print must not get between answers
    tasks: SimpleQueue[bytes] = SimpleQueue()
    Thread(target=_read_tasks, args=(sys.stdin.buffer, tasks), daemon=True).start()
    import_module(sys.argv[1])  # takes a second or two, in which the end of stdin counts
    _send(answers, b"ready")
    while True:
        _send(answers, _packed(_done(tasks.get())))


def _read_tasks(stdin: IO[bytes], tasks: SimpleQueue[bytes]) -> None:
    """Pass tasks on; at the end of stdin leave at once, in the middle of whatever it is."""
    while (task := _receive(stdin)) is not None:
        tasks.put(task)
    os._exit(0)


def _done(task: bytes) -> Answer:
    from cytodisk.runs.worker_process import Answer  # that of the near end: here this module is __main__

    try:
        work, arguments = pickle.loads(task)
        return Answer(work(*arguments), None, _peak_mb())
    except Exception as fault:  # noqa: BLE001  whatever it is belongs to whoever gave the task
        fault.add_note(traceback.format_exc())
        return Answer(None, fault, _peak_mb())


def _packed(answer: Answer) -> bytes:
    try:
        return pickle.dumps(answer, pickle.HIGHEST_PROTOCOL)
    except Exception as error:  # noqa: BLE001  results and errors of all libraries
        what = answer.fault if answer.fault is not None else error
        fault = RuntimeError(f"{type(what).__name__}: {what}")
        fault.add_note("\n".join(getattr(what, "__notes__", [])))
        return pickle.dumps(type(answer)(None, fault, answer.peak_mb))


def _be_killed_first() -> None:
    """Where memory runs short, let the system kill this process before the one that keeps the books."""
    with suppress(OSError):  # only Linux has it, and not in every container
        Path("/proc/self/oom_score_adj").write_text("1000", encoding="ascii")


def _peak_mb() -> float:
    if sys.platform == "win32":
        return 0.0
    import resource

    unit = 2**20 if sys.platform == "darwin" else 2**10
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / unit


if __name__ == "__main__":
    main()
