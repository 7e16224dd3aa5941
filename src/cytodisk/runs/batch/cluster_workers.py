"""Workers of a cluster: how many there are, and whether each one fits."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from importlib.metadata import PackageNotFoundError, version
from typing import Any, TypeAlias

from cytodisk.errors import StudyError
from cytodisk.runs.batch.batch_target import what_is_hidden

Tell: TypeAlias = Callable[[str], None]
"""Called with a message for the user."""

LOOK_EVERY_S = 2.0
ANSWER_S = 15.0
_ROUNDING = ("numpy", "scipy", "numba", "qdldl")  # another version may round the last bit otherwise


class Workers:
    """Those that a scheduler has, looked at again and again, for they come and go.

    Parameters
    ----------
    client : distributed.Client
    address : str
        Address of the scheduler.
    tell : callable
    wait_s : float
        How long to wait while there is none.
    shared : sequence of str
        What each one must see; see `what_is_hidden`.
    """

    def __init__(self, client: Any, address: str, tell: Tell, wait_s: float, shared: Sequence[str]):
        self.address = address
        self._client = client
        self._tell = tell
        self._wait_s = wait_s
        self._shared = shared
        self._fitting: dict[str, int] = {}
        self._looked = -LOOK_EVERY_S

    def threads(self) -> int:
        """Threads of all workers; waits until there is one.

        Raises
        ------
        StudyError
            None comes, or one does not fit.
        """
        if time.monotonic() - self._looked >= LOOK_EVERY_S or not self._fitting:
            self._look()
        return sum(self._fitting.values())

    def check_all(self) -> None:
        """Look at every worker anew.

        Raises
        ------
        StudyError
            One does not fit.
        """
        self._fitting = {}
        self._look()

    def _look(self) -> None:
        started, told = time.monotonic(), False
        while not self._find():
            if time.monotonic() - started > self._wait_s:
                raise StudyError(
                    f"scheduler {self.address} has had no worker for {self._wait_s:.0f} s: start workers "
                    f"with `dask worker {self.address}`, and run the same command with --resume"
                )
            if not told:
                self._tell(f"waiting for a worker: `dask worker {self.address}` starts one")
            told = True
            time.sleep(LOOK_EVERY_S / 4)
        self._looked = time.monotonic()

    def _find(self) -> bool:
        """Whether there are workers; new ones must fit, and those that do not answer are not counted yet."""
        found = self._client.nthreads()
        new = [worker for worker in found if worker not in self._fitting]
        fitting = {*self._fitting, *(self._check(new) if new else ())}
        self._fitting = {worker: threads for worker, threads in found.items() if worker in fitting}
        return bool(self._fitting)

    def _check(self, workers: list[str]) -> set[str]:
        """Those workers that answer; it is an error if one of them does not fit."""
        here = version("cytodisk")
        versions = self._ask(workers, version, "cytodisk")
        workers = list(versions)
        for worker, there in versions.items():
            if isinstance(there, PackageNotFoundError):
                raise StudyError(f"worker {worker} has no cytodisk: install version {here} there, as here")
            if there != here:
                raise StudyError(
                    f"worker {worker} has cytodisk {there}, and here is {here}: "
                    "install the same version on both"
                )
        hidden = self._ask(workers, what_is_hidden, *self._shared)
        for worker, fault in hidden.items():
            if fault:
                raise StudyError(f"worker {worker} {fault}")
        for package in _ROUNDING:
            self._compare(package, self._ask(workers, version, package))
        return set(hidden)

    def _compare(self, package: str, found: dict[str, Any]) -> None:
        here = version(package)
        others = {str(there): worker for worker, there in found.items() if there != here}
        for there, worker in others.items():
            self._tell(
                f"some workers, such as {worker}, have {package} {there}, and here is {here}: results may "
                "differ in the last bits"
            )

    def _ask(self, workers: list[str], question: Any, *about: str) -> dict[str, Any]:
        """What workers answer, an exception included; those that have gone or hang do not answer."""
        found = self._client.sync(self._answers, workers, question, about)
        return {worker: answer for worker, answer in found.items() if not isinstance(answer, OSError)}

    async def _answers(self, workers: list[str], question: Any, about: tuple[str, ...]) -> dict[str, Any]:
        answers = await asyncio.gather(*(self._answer(worker, question, about) for worker in workers))
        return {worker: answer for some in answers for worker, answer in some.items()}

    async def _answer(self, worker: str, question: Any, about: tuple[str, ...]) -> dict[str, Any]:
        """The answer of one worker; each is waited for by itself, since one that hangs would hold up all."""
        try:
            async with asyncio.timeout(ANSWER_S):
                return dict(await self._client.run(question, *about, workers=[worker], on_error="return"))
        except TimeoutError as error:
            return {worker: error}
