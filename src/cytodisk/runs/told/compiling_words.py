"""The first start after an installation compiles: how long that takes, in words."""

from importlib import import_module

_OF_NUCLEI, _OF_EDGES = "cytodisk.windows.nucleus.nucleus_raster", "cytodisk.motion.swept_edge"
# For each kind of work modules whose kernels are compiled late in it.
LATE = {
    "shapes": ("cytodisk.disk.blocks",),
    "map": ("cytodisk.windows.pixel_shares.raster",),
    "map with nuclei": (_OF_NUCLEI,),
    "movie": (_OF_EDGES,),
    "movie with nuclei": (_OF_NUCLEI, _OF_EDGES),
}
_WORDS = (
    "First start: compiling numerical code, once. It takes about 20 s on an idle computer, "
    "longer on a busy one."
)


def compiles(work: str) -> bool:
    """Whether compiled code is missing.

    Parameters
    ----------
    work : {"map", "map with nuclei", "movie", "movie with nuclei", "shapes"}
        What is done with it.
    """
    from cytodisk.kernel_cache import has_kernels

    return not all(has_kernels(import_module(module)) for module in LATE[work])


def compiling_words(work: str) -> str:
    """What to tell where compiled code is missing and will be kept; empty elsewhere.

    Parameters
    ----------
    work : {"map", "map with nuclei", "movie", "movie with nuclei", "shapes"}
        What is done with it.
    """
    from cytodisk.kernel_cache import keeps_kernels

    return _WORDS if keeps_kernels() and compiles(work) else ""  # else a warning of `keep_kernels` has told


def with_nuclei_or_not(work: str, nuclei: object) -> str:
    """The word for a kind of work, with nuclei where there are some: "map" or "map with nuclei"."""
    return f"{work} with nuclei" if nuclei else work
