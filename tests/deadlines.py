"""Waiting with an end: a test that waits for something in vain fails and says for what."""

import os
import signal
import subprocess
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

WAIT_S = 120.0
RUN_S = 200.0


def wait_until(ready: Callable[[], bool], what: str, within_s: float = WAIT_S) -> None:
    """Return as soon as `ready()` holds; fail after `within_s` seconds."""
    end = time.monotonic() + within_s
    while not ready():
        if time.monotonic() > end:
            pytest.fail(f"waited {within_s:g} s in vain until {what}")
        time.sleep(0.002)


def run_to_the_end(command: Sequence[str], within_s: float = RUN_S) -> None:
    """Run a command that ends well and in time, or fail."""
    try:
        subprocess.run(command, check=True, timeout=within_s)
    except subprocess.TimeoutExpired:
        pytest.fail(f"took longer than {within_s:g} s: {' '.join(command)}")


def kill_after_parts(command: Sequence[str], out: Path, parts: int, within_s: float = WAIT_S) -> int:
    """Kill a run with all its processes once so many parts are done.

    Returns
    -------
    int
        Parts that it had done.
    """
    started = subprocess.Popen(command, start_new_session=True)
    try:
        wait_until(
            lambda: parts_done(out) >= parts or started.poll() is not None,
            f"{parts} parts were done in {out}",
            within_s,
        )
    finally:
        os.killpg(started.pid, signal.SIGKILL)
        started.wait(timeout=30)
    assert started.returncode == -signal.SIGKILL, "the run had ended before it could be killed"
    return parts_done(out)


def parts_done(out: Path) -> int:
    """Cells or frames of an unfinished run that are done."""
    return len(list(out.glob(".parts/*.json")))
