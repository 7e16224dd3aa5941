"""The first start after an installation compiles: a user is told so, and two processes do it."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module

_OF_NUCLEI, _OF_EDGES = "cytodisk.windows.nucleus.nucleus_raster", "cytodisk.motion.swept_edge"
# For each kind of work modules whose kernels are compiled late in it.
_LATE = {
    "shapes": ("cytodisk.disk.blocks",),
    "map": ("cytodisk.windows.raster",),
    "map with nuclei": (_OF_NUCLEI,),
    "movie": (_OF_EDGES,),
    "movie with nuclei": (_OF_NUCLEI, _OF_EDGES),
}
_WORDS = (
    "First start: compiling numerical code, once. It takes about 20 s on an idle computer, "
    "longer on a busy one."
)


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
    from cytodisk.kernel_cache import has_kernels, keeps_kernels

    missing = not all(has_kernels(import_module(module)) for module in _LATE[work])
    if missing and not quiet and keeps_kernels():  # else the warning of `keep_kernels` has told
        print(_WORDS, file=sys.stderr, flush=True)
    return missing


def with_nuclei_or_not(work: str, nuclei: object) -> str:
    """The word for a kind of work, with nuclei where there are some: "map" or "map with nuclei"."""
    return f"{work} with nuclei" if nuclei else work


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
