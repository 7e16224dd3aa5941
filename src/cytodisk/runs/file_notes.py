"""What is wrong with the files of a run, in words, once for all that have it in common."""

from __future__ import annotations

from collections.abc import Iterable

from cytodisk.images.frame_file import FrameFile
from cytodisk.images.short_lists import shortened


def file_notes(files: Iterable[FrameFile | None]) -> tuple[str, ...]:
    """The notes of files, each with the names of the files in front.

    Parameters
    ----------
    files : iterable of (FrameFile or None)

    Returns
    -------
    tuple of str
        As "cells.tif: its pixels are not square, …".
    """
    by_note: dict[str, dict[str, None]] = {}
    for file in filter(None, files):
        for note in file.notes:
            by_note.setdefault(note, {})[file.path.name or str(file.path)] = None
    return tuple(f"{shortened(list(names))}: {note}" for note, names in by_note.items())
