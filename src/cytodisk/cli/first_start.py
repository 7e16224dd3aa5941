"""The first start after an installation compiles: a user is told so, and two processes do it."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager

from cytodisk.runs.told.compiling_words import compiles, compiling_words


def say_compiling(quiet: bool, work: str = "map") -> bool:
    """Say on stderr that compiled code is missing, and how long it takes to make it.

    Parameters
    ----------
    quiet : bool
        Say nothing.
    work : {"map", "map with nuclei", "movie", "movie with nuclei", "shapes"}
        What the command does.

    Returns
    -------
    bool
        Whether it is missing.
    """
    missing = compiles(work)
    if missing and not quiet and (words := compiling_words(work)):
        print(words, file=sys.stderr, flush=True)
    return missing


@contextmanager
def compiling(quiet: bool, work: str, workers: int) -> Iterator[None]:
    """Where compiled code is missing, say so, and let another process make half of it while the block runs.

    Parameters
    ----------
    quiet : bool
        Say nothing.
    work : {"map", "map with nuclei", "movie", "movie with nuclei"}
        What the command does.
    workers : int
        Processes of the command; several keep all cores busy by themselves.
    """
    if not say_compiling(quiet, work) or workers > 1 or (os.cpu_count() or 1) == 1:
        yield
        return
    from cytodisk.runs.executor import Executor
    from cytodisk.runs.warm_up import warm_up

    with Executor(1, apart=True) as beside:
        beside.submit(warm_up, work.startswith("movie"), work.endswith("with nuclei"))
        yield
