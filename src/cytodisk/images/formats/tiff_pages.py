"""TIFF files as tifffile opens them: whole, and with pages that are known from before."""

import logging
import re
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache
from pathlib import Path
from threading import get_ident

import tifffile

from cytodisk.errors import ReadError

_CUT_SHORT = re.compile("invalid (page|value) offset")
_TIFFS_KEPT = 4  # whose pages are known


@contextmanager
def opened_tiff(path: Path) -> Iterator[tifffile.TiffFile]:
    """Open a TIFF whose pages may be known from the frame before."""
    state = path.stat()
    tiff = _with_pages(path, state.st_mtime_ns, state.st_size, get_ident())
    if tiff.series[0].is_multifile:  # whether its other files are as they were, this one does not say
        with tifffile.TiffFile(path) as anew:
            yield anew
        return
    tiff.filehandle.open()
    try:
        yield tiff
    finally:
        tiff.close()


@lru_cache(maxsize=_TIFFS_KEPT)
def _with_pages(path: Path, changed_ns: int, size: int, thread: int) -> tifffile.TiffFile:
    """A closed TIFF with the list of its pages, which takes longer to read than a frame of a long movie.

    Each thread has its own, as one that is done closes the file.
    """
    with tifffile.TiffFile(path) as tiff:
        len(tiff.series[0].pages)
        return tiff


@contextmanager
def whole_tiff(file: Path) -> Iterator[tifffile.TiffFile]:
    """Open a TIFF, and raise if it is cut short, of which tifffile only logs that pages or tags are lost."""
    logged: list[str] = []
    watch = logging.Handler(logging.ERROR)
    watch.emit = lambda record: logged.append(record.getMessage())  # type: ignore[method-assign]
    log = logging.getLogger("tifffile")
    log.addHandler(watch)
    try:
        with tifffile.TiffFile(file) as tiff:
            pages = len(tiff.pages)
            lost = [message for message in logged if _CUT_SHORT.search(message)]
            if lost:
                raise ReadError(
                    f"{file}: the file is cut short after {pages} pages ({lost[0]}): copy it again, whole"
                )
            yield tiff
    finally:
        log.removeHandler(watch)
