"""Channels of an image file: a name for each, and some of them in the order that a user wants."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.frame_file import Cut, FrameFile, StoredFrames
from cytodisk.images.short_lists import shortened

_NAMED = 12  # channels that a message names
COLOURS = {2: ("grey", "alpha"), 3: ("red", "green", "blue"), 4: ("red", "green", "blue", "alpha")}
"""Names of the samples of a colour image, by their number."""


def channel_names(given: Sequence[str], count: int) -> tuple[str, ...]:
    """A name for each channel: those given, each made unique, or "0", "1", … where they are not as many."""
    if len(given) != count:
        return tuple(str(number) for number in range(count))
    again = [given[:place].count(name) for place, name in enumerate(given)]
    return tuple(f"{name} ({n + 1})" if n else name for name, n in zip(given, again, strict=True))


def with_names(file: FrameFile, name: str = "") -> FrameFile:
    """A file with names for its channels, those of the file, or else made of the file's own name.

    Parameters
    ----------
    file : FrameFile
        Without names its channels are "0", "1", ….
    name : str
        What to call channels without names; the name of the file if it is empty.

    Returns
    -------
    FrameFile
        With `unnamed` where the names are not those of the file.
    """
    if not file.unnamed and file.channels != tuple(map(str, range(len(file.channels)))):
        return file
    return replace(
        file, channels=names_after(name or stem_of(file.path.name), len(file.channels)), unnamed=True
    )


def names_after(name: str, count: int) -> tuple[str, ...]:
    """Names for channels without their own: that name, numbered from 1 if there are several."""
    shown = "".join(letter if letter.isprintable() else "_" for letter in name).strip() or "signal"
    return (shown,) if count == 1 else tuple(f"{shown} {number + 1}" for number in range(count))


def stem_of(name: str) -> str:
    """A file's name without the ending that says how it is stored: "a" of "a.ome.tif"."""
    return re.sub(r"(?<=.)(\.ome)?\.[A-Za-z0-9]{1,5}$", "", name, flags=re.IGNORECASE)


def with_channels(file: FrameFile, wanted: Sequence[str], flag: str) -> FrameFile:
    """A file with some of its channels, whatever its format.

    Parameters
    ----------
    file : FrameFile
    wanted : sequence of str
        Names, or numbers from 0; a name counts before a number.
    flag : str
        What a user passes to choose, for messages.

    Returns
    -------
    FrameFile
        Without an axis C if one channel is taken.

    Raises
    ------
    ReadError
        A channel is not there, or two of the wanted are the same one.
    """
    numbers = [_number(file, one, flag) for one in wanted]
    if len(set(numbers)) < len(numbers):
        raise ReadError(f"{file.path}: {flag} {','.join(wanted)} names one channel twice: name each once")
    if "C" not in file.axes:
        return file
    place = file.axes.index("C")
    sizes, axes = list(file.shape), file.axes
    sizes[place] = len(numbers)
    if len(numbers) == 1:
        sizes.pop(place)
        axes = axes.replace("C", "")
    names = tuple(file.channels[number] for number in numbers)
    stored = ChosenChannels(file.stored, tuple(numbers))
    return replace(file, axes=axes, shape=tuple(sizes), channels=names, stored=stored)


def _number(file: FrameFile, wanted: str, flag: str) -> int:
    if wanted in file.channels:
        return file.channels.index(wanted)
    if wanted.isdecimal() and int(wanted) < len(file.channels):
        return int(wanted)
    there = shortened([f"{number} ({name})" for number, name in enumerate(file.channels)], _NAMED)
    raise ReadError(f"{file.path} has no channel {wanted!r}: pass {flag} with one of those it has: {there}")


def filled_channels(file: FrameFile) -> tuple[int, ...]:
    """Numbers of the channels that hold something beside 0 in the first frame; none where it is damaged."""
    return _filled(file.stored)


def with_empty_note(file: FrameFile) -> FrameFile:
    """A file whose chosen channel is empty, with a note on those that hold something, if any does."""
    held = _filled(file.stored.stored) if isinstance(file.stored, ChosenChannels) else ()
    if not held:
        return file
    some = "channel" if len(held) == 1 else "channels"
    note = (
        f"the channel that was taken is empty; {some} {shortened(list(map(str, held)), _NAMED)} of the file "
        f"(from 0) hold{'s' if len(held) == 1 else ''} something: pass --mask-channel {held[0]}"
    )
    return replace(file, notes=(*file.notes, note))


def _filled(stored: StoredFrames) -> tuple[int, ...]:
    try:
        return tuple(number for number, plane in enumerate(stored.read(0)) if plane.any())
    except (ReadError, OSError, ValueError):
        return ()  # whoever reads the frame for good tells of it


@dataclass(frozen=True)
class ChosenChannels:
    """Frames of a file with some of its channels.

    Attributes
    ----------
    stored : StoredFrames
    numbers : tuple of int
    """

    stored: StoredFrames
    numbers: tuple[int, ...]

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        return self.stored.read(number)[list(self.numbers)]

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None where it must be read whole."""
        found = self.stored.by_piece(number)
        if found is None:
            return None
        cut, rows = found
        return partial(_cut, cut, self.numbers), rows


def _cut(cut: Cut, numbers: tuple[int, ...], rows: slice, columns: slice) -> np.ndarray[Any, Any]:
    return cut(rows, columns)[list(numbers)]
