"""TIFF files as tifffile opens them: whole, and with pages that are known from before."""

from __future__ import annotations

import logging
import re
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from contextvars import ContextVar
from functools import lru_cache
from pathlib import Path
from threading import get_ident
from typing import Any, TypeAlias

import tifffile

from cytodisk.errors import ReadError
from cytodisk.images.formats.tiff_chain import check_chain

_CUT_SHORT = re.compile("invalid (page|value) offset")
_FILE_WORDS = re.compile(r"<tifffile\.\w+ [^>]*> ?")
_TIFFS_KEPT = 4  # whose pages are known
_KINDS = [
    "shaped",
    "lsm",
    "mmstack",
    "ome",
    "imagej",
    "ndtiff",
    "fluoview",
    "stk",
    "sis",
    "svs",
    "scn",
    "qpi",
]
_KINDS += ["ndpi", "bif", "avs", "eer", "philips", "scanimage", "nih", "mdgel", "uniform"]
_NO_KIND: dict[str, Any] = {f"is_{kind}": False for kind in _KINDS}

States: TypeAlias = tuple[tuple[Path, int, int], ...]
"""Files, and when they were changed and how large they are."""

_CAUGHT: ContextVar[list[str] | None] = ContextVar("messages of tifffile", default=None)


class _Catch(logging.Filter):
    """Keeps from the terminal what tifffile logs while this package reads, which has words of its own."""

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a message is shown."""
        caught = _CAUGHT.get()
        if caught is not None:
            caught.append(_FILE_WORDS.sub("", record.getMessage()))
        return caught is None


logging.getLogger("tifffile").addFilter(_Catch())


@contextmanager
def caught_messages() -> Iterator[list[str]]:
    """What tifffile logs, which is then not shown."""
    caught: list[str] = []
    token = _CAUGHT.set(caught)
    try:
        yield caught
    finally:
        _CAUGHT.reset(token)


def tiff_opened(path: Path, plain: bool = False) -> tifffile.TiffFile:
    """Open a TIFF.

    Parameters
    ----------
    path : Path
    plain : bool
        Take its pages as they stand, and believe nothing that metadata say of their order.
    """
    return tifffile.TiffFile(path, **(_NO_KIND if plain else {}))


@contextmanager
def opened_tiff(path: Path, plain: bool = False) -> Iterator[tifffile.TiffFile]:
    """Open a TIFF whose pages may be known from the frame before."""
    with caught_messages(), ExitStack() as stack:
        state = path.stat()
        given = path, plain, state.st_mtime_ns, state.st_size, get_ident()
        tiff, beside = _with_pages(*given)
        if beside != _states(place for place, _, _ in beside):  # what this file does not say of the others
            _with_pages.cache_clear()
            tiff, beside = _with_pages(*given)
        tiff.filehandle.open()
        stack.callback(tiff.close)
        yield tiff


@lru_cache(maxsize=_TIFFS_KEPT)
def _with_pages(
    path: Path, plain: bool, changed_ns: int, size: int, thread: int
) -> tuple[tifffile.TiffFile, States]:
    """A closed TIFF with the list of its pages, which takes longer to read than a frame of a long movie.

    Each thread has its own, as one that is done closes the file. With it come the other files of its set.
    """
    with tiff_opened(path, plain) as tiff:
        pages: list[Any] = [page for series in tiff.series if series.is_multifile for page in series.pages]
        len(tiff.series[0].pages)
        files = {Path(page.parent.filehandle.path) for page in pages if page is not None}
        return tiff, _states(sorted(files - {path.absolute()}))


def _states(files: Any) -> States:
    return tuple((file, file.stat().st_mtime_ns, file.stat().st_size) for file in files)


@contextmanager
def whole_tiff(file: Path) -> Iterator[tuple[tifffile.TiffFile, list[str]]]:
    """Open a TIFF, and raise if it is cut short, of which tifffile only logs that pages or tags are lost.

    With it come the messages that tifffile logs meanwhile.
    """
    check_chain(file)
    with caught_messages() as logged, tiff_opened(file) as tiff:
        pages = len(tiff.pages)
        lost = [message for message in logged if _CUT_SHORT.search(message)]
        if lost:
            raise ReadError(
                f"{file}: the file is cut short after {pages} pages ({lost[0]}): copy it again, whole"
            )
        yield tiff, logged


def present_page(path: Path, tiff: tifffile.TiffFile, series: int, page: int) -> Any:
    """A page of a series; raises ReadError where it is in no file that is there."""
    found: Any = tiff.series[series].pages[page]
    if found is None:
        raise ReadError(
            f"{path} has no page for this frame, though its metadata speak of one: copy it again, with all "
            "files of its set beside it"
        )
    return found


@contextmanager
def opened_member(page: Any) -> Iterator[Any]:
    """The file that a page stands in, opened; it may be another one of a set."""
    file = page.parent.filehandle
    if not file.closed:
        yield file
        return
    file.open()
    try:
        yield file
    finally:
        file.close()
