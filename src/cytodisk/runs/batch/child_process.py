"""A process that inputs are computed in, one after the other; it ends with the one that started it."""

from __future__ import annotations

import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from threading import Timer
from typing import IO, Any

from cytodisk.errors import StudyError
from cytodisk.runs.batch.inputs import BatchInput

_MOST_WORDS = 2000  # characters kept of the beginning and of the end of what a process said
_ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")


class ChildProcess:
    """A process in a group of its own, so that it can be killed with all that it started.

    Attributes
    ----------
    timed_out : bool
        Whether it was killed because an input took too long.
    """

    def __init__(self) -> None:
        self.timed_out = False
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  is closed at the end of the process
        self._log_start = 0
        self._process = subprocess.Popen(
            # -P: modules are not taken from the folder that the user happens to be in.
            [sys.executable, "-P", "-X", "faulthandler", "-m", "cytodisk.runs.batch.child"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            env=os.environ | _ONE_THREAD,
            start_new_session=True,
        )

    @property
    def alive(self) -> bool:
        """Whether it can be given an input."""
        return self._process.poll() is None and not self.timed_out

    def wait_until_ready(self) -> bool:
        """Whether it has started; the first seconds go into loading code."""
        return self._read() is not None

    def answer(self, item: BatchInput, folder: Path, time_limit: float | None) -> dict[str, Any] | None:
        """Compute an input; None if the process died, or was killed because it took too long.

        Parameters
        ----------
        item : BatchInput
        folder : Path
        time_limit : float or None
            In seconds.

        Returns
        -------
        dict or None
            As `cytodisk.runs.batch.child` answers.
        """
        self._log_start = os.fstat(self._log.fileno()).st_size
        watch = Timer(time_limit, self._time_out) if time_limit else None
        try:
            if watch is not None:
                watch.daemon = True
                watch.start()
            self._stdin.write(pickle.dumps((item, folder)))
            self._stdin.flush()
            return self._read()
        except BrokenPipeError:
            return None
        finally:
            if watch is not None:
                watch.cancel()

    def kill(self) -> None:
        """Kill it and all that it started."""
        with suppress(ProcessLookupError):  # it has ended already
            if hasattr(os, "killpg"):
                os.killpg(self._process.pid, signal.SIGKILL)
            else:
                self._process.kill()

    def end(self) -> tuple[int, str]:
        """End it: its exit code (negative if it died of a signal) and what it said on its last input."""
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

    @property
    def _stdin(self) -> IO[bytes]:
        if self._process.stdin is None:
            raise StudyError("the process of an input has no input channel")
        return self._process.stdin

    def _read(self) -> dict[str, Any] | None:
        line = b"" if self._process.stdout is None else self._process.stdout.readline()
        return json.loads(line) if line.endswith(b"\n") else None

    def _time_out(self) -> None:
        self.timed_out = True
        self.kill()
