"""A movie of one file a frame."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError, as_data
from cytodisk.images.frame_file import Cut, FrameFile, StoredFrames
from cytodisk.images.short_lists import shortened
from cytodisk.scale import Scale, alike

_SHOWN = 3  # damaged files that are told


class MissingFrameError(ReadError):
    """The file of a frame is not there."""


@dataclass(frozen=True)
class SequenceFrames:
    """Frames of a movie, each in a file of its own.

    Attributes
    ----------
    files : tuple of (StoredFrames or ReadError)
        By frame; the error of a file that is missing or damaged.
    dtype : numpy.dtype
        Of all frames.
    """

    files: tuple[StoredFrames | ReadError, ...]
    dtype: np.dtype[Any]

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        return self._file(number).read(0).astype(self.dtype, copy=False)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None where it must be read whole."""
        found = self._file(number).by_piece(0)
        if found is None:
            return None
        cut, rows = found
        return partial(_cut, cut, self.dtype), rows

    def _file(self, number: int) -> StoredFrames:
        found = self.files[number]
        if isinstance(found, ReadError):
            raise type(found)(*found.args)  # a new one, without the way that it took before
        return found


def _cut(cut: Cut, dtype: np.dtype[Any], rows: slice, columns: slice) -> np.ndarray[Any, Any]:
    return cut(rows, columns).astype(dtype, copy=False)


def open_sequence(
    place: Path, files: Sequence[Path], missing: frozenset[Path], opened: Callable[[Path], FrameFile]
) -> FrameFile:
    """Look at a movie of one file a frame without reading its pixels.

    Parameters
    ----------
    place : Path
        The folder or pattern, for messages.
    files : sequence of Path
        In the order of time.
    missing : frozenset of Path
        Those of them that are not there.
    opened : callable
        Opens one of the others.

    Returns
    -------
    FrameFile
        With a frame for each file; that of a file that is missing or damaged cannot be read.

    Raises
    ------
    ReadError
        No file can be read, one holds several frames, or they are not of one size or have other channels.
    """
    found = [_opened(file, file in missing, opened) for file in files]
    frames = [one for one in found if isinstance(one, FrameFile)]
    if not frames:
        raise next(one for one in found if isinstance(one, ReadError))
    _check_single(place, frames)
    _check_same(place, frames, "size", lambda file: file.image_shape, _size_words)
    _check_same(place, frames, "number of channels", lambda file: len(file.channels), str)
    first = frames[0]
    _check_channels(place, frames)
    dtype, notes = _common_type(place, frames)
    scale, differing = _common_scale(frames)
    stored = tuple(one.stored if isinstance(one, FrameFile) else one for one in found)
    damaged = [str(one) for one in found if type(one) is ReadError]
    return replace(
        first,
        path=place,
        axes=f"T{first.axes}",
        shape=(len(found), *first.shape),
        dtype=dtype,
        stored=SequenceFrames(stored, dtype),
        scale=scale,
        notes=(*_notes_of(frames), *notes, *differing, *damaged[:_SHOWN]),
        files=tuple(files),
    )


def _opened(file: Path, is_missing: bool, opened: Callable[[Path], FrameFile]) -> FrameFile | ReadError:
    if is_missing:
        return MissingFrameError(f"{file.name} is not there, while files before and after it are")
    try:
        return opened(file)
    except ReadError as fault:
        return as_data(fault)


def _check_single(place: Path, frames: Sequence[FrameFile]) -> None:
    stacks = [file for file in frames if "T" in file.axes]
    if stacks:
        raise ReadError(
            f"{place} has files of several frames ({_names(stacks)}), where one file is one frame: "
            f"pass such a file alone, as {stacks[0].path}"
        )


def _check_same(
    place: Path,
    frames: Sequence[FrameFile],
    what: str,
    of: Callable[[FrameFile], Hashable],
    words: Callable[[Any], str],
) -> None:
    """Raise ReadError unless all files have one size, or the like; it names those that differ from most."""
    usual, count = Counter(of(file) for file in frames).most_common(1)[0]
    odd = [file for file in frames if of(file) != usual]
    if odd:
        raise ReadError(
            f"{place}: {_names(odd)} {_have(odd)} another {what} "
            f"({words(of(odd[0]))}) than the other {count} files ({words(usual)}): move "
            f"{'it' if len(odd) == 1 else 'them'} elsewhere, or pass the others as a pattern, in quotes"
        )


def _size_words(shape: tuple[int, int]) -> str:
    return f"{shape[0]} × {shape[1]} pixels"


def _check_channels(place: Path, frames: Sequence[FrameFile]) -> None:
    """Raise ReadError where channels of some names would be read as those of others."""
    named = [file for file in frames if not file.unnamed]
    odd = [file for file in named if file.channels != named[0].channels]
    if odd:
        raise ReadError(
            f"{place}: {_names(odd)} {_have(odd)} the channels "
            f"{', '.join(odd[0].channels)}, {named[0].path.name} has {', '.join(named[0].channels)}: "
            "all frames of a movie must have the same"
        )


def _common_type(place: Path, frames: Sequence[FrameFile]) -> tuple[np.dtype[Any], list[str]]:
    """A type that holds the values of all files, and words where they differ."""
    usual, _ = Counter(file.dtype for file in frames).most_common(1)[0]
    odd = [file for file in frames if file.dtype != usual]
    if not odd:
        return usual, []
    common = np.result_type(*{file.dtype for file in frames})
    if {file.dtype.kind for file in frames} <= set("biu") and common.kind == "f":
        raise ReadError(
            f"{place}: {_names(odd)} {_have(odd)} the type {odd[0].dtype}, most others {usual}, and no type "
            "holds both: save all in one type, as uint16"
        )
    return common, [
        f"{_names(odd)} {_have(odd)} another type ({odd[0].dtype}) than the others ({usual}): all are read "
        f"as {common}; save all in one type if their values do not mean the same"
    ]


def _common_scale(frames: Sequence[FrameFile]) -> tuple[Scale, list[str]]:
    """What the files say of their scale, and words where they contradict each other."""
    size, notes = _agreed(frames, "pixel_size_um", "pixel sizes", "µm", "--pixel-size")
    interval, more = _agreed(frames, "frame_interval_s", "frame intervals", "s", "--frame-interval")
    return Scale(size, interval), [*notes, *more]


def _agreed(
    frames: Sequence[FrameFile], quantity: str, name: str, unit: str, flag: str
) -> tuple[float | None, list[str]]:
    said = {file.path.name: getattr(file.scale, quantity) for file in frames}
    known = {file: value for file, value in said.items() if value is not None}
    if not known:
        return None, []
    least, most = min(known, key=known.__getitem__), max(known, key=known.__getitem__)
    if not alike(known[least], known[most]):
        return None, [
            f"{name} differ ({least} {known[least]:g} {unit}, {most} {known[most]:g} {unit}), so none is "
            f"taken: pass the right one as {flag}"
        ]
    return next(iter(known.values())), []


def _notes_of(frames: Sequence[FrameFile]) -> list[str]:
    """What was found wrong in single files, once for all that have it in common."""
    by_note: dict[str, list[FrameFile]] = {}
    for file in frames:
        for note in file.notes:
            by_note.setdefault(note, []).append(file)
    return [f"{_names(files)}: {note}" for note, files in by_note.items()]


def _have(files: Sequence[FrameFile]) -> str:
    return "has" if len(files) == 1 else "have"


def _names(files: Sequence[FrameFile]) -> str:
    return shortened([file.path.name for file in files])
