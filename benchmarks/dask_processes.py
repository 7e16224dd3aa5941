"""A Dask scheduler and its workers, each a process of its own, on this machine."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
import time
from collections.abc import Mapping
from pathlib import Path

_START_S = 120.0
_COMMON = ("--no-dashboard", "--dashboard-address", "127.0.0.1:0")


class DaskProcesses:
    """Starts them as a user does, by `dask scheduler` and `dask worker`; none is left when the block ends.

    Parameters
    ----------
    folder : Path
        For what workers write while they run, and what all processes say.
    """

    def __init__(self, folder: Path):
        self.folder = folder
        self.address = f"tcp://127.0.0.1:{free_port()}"
        self._processes: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> DaskProcesses:
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._processes:
            process.kill()
            process.wait(timeout=60)

    def scheduler(self) -> subprocess.Popen[bytes]:
        """Start the scheduler, always at the same address."""
        return self._start("scheduler", "--host", "127.0.0.1", "--port", self.address.rsplit(":", 1)[1])

    def worker(
        self, threads: int = 1, environment: Mapping[str, str] | None = None
    ) -> subprocess.Popen[bytes]:
        """Start a worker."""
        flags = ("--nthreads", str(threads), "--no-nanny", "--memory-limit", "0")
        folder = ("--local-directory", str(self.folder))
        return self._start("worker", self.address, *flags, *folder, environment=environment)

    def wait_for_workers(self) -> None:
        """Wait until the scheduler knows all workers that were started."""
        logs = list(self.folder.glob("*_worker.log"))
        end = time.monotonic() + _START_S
        while not all("Registered to:" in log.read_text(errors="replace") for log in logs):
            if any(process.poll() is not None for process in self._processes):
                raise RuntimeError("".join(log.read_text(errors="replace") for log in logs))
            if time.monotonic() > end:
                raise TimeoutError(f"no worker after {_START_S:g} s, see {self.folder}")
            time.sleep(0.05)

    def _start(
        self, command: str, *flags: str, environment: Mapping[str, str] | None = None
    ) -> subprocess.Popen[bytes]:
        with (self.folder / f"{len(self._processes)}_{command}.log").open("wb") as log:
            process = subprocess.Popen(
                [sys.executable, "-m", "dask", command, *flags, *_COMMON],
                stdout=log,
                stderr=log,
                env=os.environ | (environment or {}),
            )
        self._processes.append(process)
        return process


def free_port() -> int:
    """A port of this machine that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])
