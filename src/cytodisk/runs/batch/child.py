"""What a process for inputs does: reads one after the other from stdin, answers on stdout.

A line of JSON for each: "status", "reason", "peak_mb" and other fields of `InputRow`.
"""

from __future__ import annotations

import errno
import json
import os
import pickle
import sys
import traceback
from contextlib import suppress
from pathlib import Path
from queue import SimpleQueue
from threading import Thread
from typing import IO, TYPE_CHECKING, Any

from cytodisk.errors import CytodiskError, WriteError

if TYPE_CHECKING:
    from cytodisk.runs.batch.inputs import BatchInput

_NO_ROOM = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


def main() -> None:
    """Answer until stdin ends, which it does when the process that started this one is gone."""
    _be_killed_first()
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb", buffering=0)
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # what libraries print must not get between answers
    jobs: SimpleQueue[tuple[BatchInput, Path]] = SimpleQueue()
    Thread(target=_read_jobs, args=(sys.stdin.buffer, jobs), daemon=True).start()
    import cytodisk.runs.batch.compute  # noqa: F401  takes a second or two, in which the end of stdin counts

    _say(answers, {"ready": True})
    while True:
        item, folder = jobs.get()
        _say(answers, _answer(item, folder) | {"peak_mb": _peak_mb()})


def _read_jobs(stdin: IO[bytes], jobs: SimpleQueue[tuple[BatchInput, Path]]) -> None:
    """Pass inputs on; at the end of stdin leave at once, in the middle of whatever it is."""
    while stdin.peek(1):  # type: ignore[attr-defined]
        jobs.put(pickle.load(stdin))
    os._exit(0)


def _say(answers: IO[bytes], answer: dict[str, Any]) -> None:
    answers.write(json.dumps(answer).encode() + b"\n")


def _answer(item: BatchInput, folder: Path) -> dict[str, Any]:
    from cytodisk.runs.batch.compute import compute_input

    try:
        return {"status": "ok", "reason": "", **compute_input(item, folder)}
    except MemoryError as error:
        words = {"status": "out of memory", "reason": f"memory ran out: {error}".rstrip(": ")}
        return words | {"log": traceback.format_exc()}
    except Exception as error:  # noqa: BLE001  whatever it is costs this input a row, not the run
        if _cannot_write(error):
            return {"status": "cannot write", "reason": str(error)}
        if isinstance(error, CytodiskError):
            return {"status": "refused", "reason": str(error)}
        reason = f"{type(error).__name__}: {error}".splitlines()[0]
        return {"status": "failed", "reason": reason, "log": traceback.format_exc()}


def _cannot_write(error: BaseException | None) -> bool:
    """Whether an error comes from a disk that is full, or from results that cannot be written at all."""
    while error is not None:
        if isinstance(error, WriteError) or (isinstance(error, OSError) and error.errno in _NO_ROOM):
            return True
        error = error.__cause__ or error.__context__
    return False


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
