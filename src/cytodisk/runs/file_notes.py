"""What is wrong with the files of a run, in words, once for all that have it in common."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cytodisk.images.frame_file import FrameFile
from cytodisk.images.short_lists import shortened
from cytodisk.scale import Scale, alike


def file_notes(files: Iterable[FrameFile | None], given: Scale) -> tuple[str, ...]:
    """The notes of files, each with the names of the files in front.

    Parameters
    ----------
    files : iterable of (FrameFile or None)
    given : Scale
        By the user: a file that says another one is named.

    Returns
    -------
    tuple of str
        As "cells.tif: its pixels are not square, …".
    """
    by_note: dict[str, dict[str, None]] = {}
    for file in filter(None, files):
        for note in (*file.notes, *_other_scale(file.scale, given)):
            by_note.setdefault(note, {})[file.path.name or str(file.path)] = None
    return tuple(f"{shortened(list(names))}: {note}" for note, names in by_note.items())


def _other_scale(said: Scale, given: Scale) -> Iterator[str]:
    """What a file says of its scale where the user gave another one, which counts."""
    for name, there, here, unit in (
        ("pixel size", said.pixel_size_um, given.pixel_size_um, "µm"),
        ("frame interval", said.frame_interval_s, given.frame_interval_s, "s"),
    ):
        if there is not None and here is not None and not alike(there, here):
            yield f"it says that its {name} is {there:g} {unit}; {here:g} {unit} counts, as you passed it"
