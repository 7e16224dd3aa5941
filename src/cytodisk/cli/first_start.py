"""What a user is told while the first start after an installation compiles."""

import sys
from importlib import import_module

# For each kind of work a module whose kernels are compiled late in it, and seconds for all of them.
_LATE = {
    "shapes": ("cytodisk.disk.blocks", 8),
    "map": ("cytodisk.windows.raster", 12),
    "movie": ("cytodisk.motion.swept_edge", 15),
}


def say_compiling(quiet: bool, work: str = "map") -> None:
    """Say on stderr that compiled code is missing, and how long it takes to make it.

    Parameters
    ----------
    quiet : bool
        Say nothing.
    work : {"map", "movie", "shapes"}
        What the command does.
    """
    if quiet:
        return
    from cytodisk.files import has_kernels

    module, seconds = _LATE[work]
    if not has_kernels(import_module(module)):
        words = f"First start: compiling numerical code, about {seconds} s, once."
        print(words, file=sys.stderr, flush=True)
