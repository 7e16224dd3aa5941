"""Trials of `honest.py`: seeds, processes, and studies of simulated movies in a temporary folder."""

import multiprocessing
import sys
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import tifffile

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.runs.movie.run_movie import run_movie
from cytodisk.store.study import Study

THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
FIRST_SEED = 1000
"""No threshold was tuned on it or a later one."""

_MOVIES_A_PROCESS = 40  # then a fresh one, so that memory stays small
Job = TypeVar("Job")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Trials:
    """How many movies are measured, and in how many processes.

    Attributes
    ----------
    quick : bool
    given : (int, int) or None
        First and last seed of each case, in place of the block's.
    workers : int
    """

    quick: bool
    given: tuple[int, int] | None
    workers: int

    def seeds(self, full: int, quick: int) -> range:
        """Seeds of a case, of which a full run has so many and a quick one so many."""
        if self.given is not None:
            return range(self.given[0], self.given[1] + 1)
        return range(FIRST_SEED, FIRST_SEED + (quick if self.quick else full))

    def run(self, name: str, work: Callable[[Job], Result], jobs: Sequence[Job]) -> list[Result]:
        """Results of all jobs in their order, with progress on the error stream."""
        context = multiprocessing.get_context("spawn")
        found: list[Result] = []
        size = _MOVIES_A_PROCESS * self.workers
        for first in range(0, len(jobs), size):  # an executor that renews its processes itself can hang
            with ProcessPoolExecutor(self.workers, context) as pool:
                for result in pool.map(work, jobs[first : first + size]):
                    found.append(result)
                    print(f"{name}: {len(found)}/{len(jobs)}", end="\033[K\r", file=sys.stderr, flush=True)
        return found


@contextmanager
def quiet_study(masks: BoolArray, channels: Mapping[str, FloatArray], **settings: Any) -> Iterator[Study]:
    """The study that `cytodisk movie` makes of masks and signals; it and its files are removed at the end."""
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        here = Path(folder)
        tifffile.imwrite(here / "masks.tif", masks.astype(np.uint8), metadata={"axes": "TYX"})
        stack = np.stack([np.asarray(values, dtype=np.float32) for values in channels.values()], axis=1)
        tifffile.imwrite(here / "signal.tif", stack, imagej=True, metadata={"axes": "TCYX"})
        yield run_movie(
            here / "masks.tif",
            here / "study",
            signal=here / "signal.tif",
            channels=tuple(channels),
            **settings,
        )


def percent(flags: Sequence[bool] | FloatArray) -> float:
    """Share in percent."""
    return 100.0 * float(np.mean(flags))
