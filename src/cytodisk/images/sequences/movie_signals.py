"""The images of a movie: which file belongs to which frame of the masks."""

from __future__ import annotations

import glob
import os
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from cytodisk.errors import SignalError
from cytodisk.files import real_path
from cytodisk.images.chosen_channels import with_names
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.mask_names import ENDINGS, base_name, image_stem, visible_files
from cytodisk.images.sequences.file_sequence import open_sequence
from cytodisk.images.sequences.frame_names import FrameNames, series_of
from cytodisk.images.sequences.movie_files import (
    MovieMasks,
    left_out,
    not_masks,
    one_series,
    open_frame,
    readable,
    sequence,
)
from cytodisk.images.short_lists import shortened

_USUAL_ENDINGS = ("", "_img")  # of an image's name, after that of its mask file without the masks' ending
_FLAG = "--signal-channels"


def open_movie_signal(signal: Path, masks: MovieMasks, choice: FileChoice) -> FrameFile:
    """Open the images of a movie without reading their pixels.

    Parameters
    ----------
    signal : Path
        A file; a folder or a pattern of files of one frame each; or, for masks of one file a frame, how the
        names of the images go on beside them, as "_img".
    masks : MovieMasks
        The images that are taken are those of its frames.
    choice : FileChoice
        What to take of each file.

    Returns
    -------
    FrameFile

    Raises
    ------
    ReadError
        There is no such file, or the files of a folder are not those of one movie.
    SignalError
        The images are not those of the masks by their names.
    """
    beside = _beside(signal, masks)
    if beside is None and not is_folder_of_files(signal) and not is_pattern(signal):
        return open_frames(signal, unnamed="T", choice=choice)
    names, others = beside or _signal_frames(signal, masks)
    file = sequence(signal, names, partial(open_frame, choice=choice, flag=_FLAG), others)
    return with_names(file, _channel_name(names))


def _channel_name(names: FrameNames) -> str:
    """What to call a channel without a name: what the files have in common, or else their folder."""
    return names.series if len(names.series) > 1 else real_path(names.files[0]).parent.name


def open_movie_images(path: Path, choice: FileChoice) -> FrameFile:
    """The images of a movie without its masks: a file, or a folder or pattern of one file a frame."""
    if not is_folder_of_files(path) and not is_pattern(path):
        return open_frames(path, unnamed="T", choice=choice)
    names = one_series(path, {file.name: file for file in not_masks(readable(path))})
    return sequence(path, names, partial(open_frame, choice=choice, flag=_FLAG), "")


def reopened(path: Path, files: Sequence[Path], choice: FileChoice) -> FrameFile:
    """A movie of one file a frame, whose files are known; one that is not there is a missing frame."""
    missing = frozenset(file for file in files if not file.exists())
    return open_sequence(path, files, missing, partial(open_frame, choice=choice, flag=_FLAG))


def _signal_frames(place: Path, masks: MovieMasks) -> tuple[FrameNames, str]:
    """The images of the frames of masks, and which others there are."""
    files = not_masks(_without_masks(readable(place), masks))
    if not files:
        raise SignalError(f"signal {place} holds masks only: pass the folder or the pattern of the images")
    if masks.names is not None and is_folder_of_files(place):
        by_mask = _by_base_name(files, masks.names, _USUAL_ENDINGS)
        if by_mask is not None:
            return by_mask, left_out(files, by_mask)
    names = one_series(place, {file.name: file for file in files})
    if masks.names is None or masks.names.numbers is None or names.numbers is None:
        return names, ""
    return _aligned(place, names, masks.names)


def _without_masks(files: Sequence[Path], masks: MovieMasks) -> list[Path]:
    of_masks = set() if masks.names is None else {real_path(mask) for mask in masks.names.files}
    images = [file for file in files if not file.name.lower().endswith(ENDINGS)]
    return [file for file in images if real_path(file) not in of_masks]


def _by_base_name(files: Sequence[Path], masks: FrameNames, endings: Sequence[str]) -> FrameNames | None:
    """The image of each mask file by its name, as "t001.tif" of "t001_cp_masks.png"; None without any."""
    by_stem: dict[str, list[Path]] = {}
    for file in files:
        for name in {file.name, image_stem(file.name)}:
            by_stem.setdefault(name, []).append(file)
    found: list[Path] = []
    for mask in masks.files:
        fitting = [file for end in endings for file in by_stem.get(base_name(mask.name) + end, [])]
        if len(fitting) > 1:
            names = ", ".join(file.name for file in fitting)
            raise SignalError(
                f"{mask} has several images in {fitting[0].parent} ({names}): pass a pattern that fits one "
                "of them"
            )
        found += fitting or [files[0].parent / f"{base_name(mask.name)}{endings[0]}{files[0].suffix}"]
    known = set(files)
    there = [file for file in found if file in known]
    if not there or len(set(there)) < len(there):
        return None
    lost = [file for file in found if file not in known]
    series = series_of([file.name for file in there])
    return FrameNames(tuple(found), masks.numbers, frozenset(lost), series, _lost_words(lost))


def _lost_words(files: Sequence[Path]) -> str:
    if not files:
        return ""
    names, verb = shortened([file.name for file in files]), "is" if len(files) == 1 else "are"
    return f"{names} {verb} not there: frames without an image are not measured"


def _aligned(place: Path, names: FrameNames, masks: FrameNames) -> tuple[FrameNames, str]:
    """The images with the numbers of the masks."""
    assert names.numbers is not None  # only such are aligned
    assert masks.numbers is not None
    wanted, there = set(masks.numbers), set(names.numbers)
    if wanted <= there:
        others = len(there) - len(wanted)
        return names.taken(masks.numbers), f"{others} others have no mask" if others else ""
    if len(wanted) == len(there):
        first, other = masks.files[0].name, names.files[0].name
        note = f"numbers of masks and images differ: {first} goes with {other}, and so on by order"
        return replace(names, note="; ".join(filter(None, [names.note, note]))), ""
    if there < wanted:
        found = names.taken(masks.numbers)
        return replace(found, note=_lost_words([file for file in found.files if file in found.missing])), ""
    raise SignalError(
        f"signal {place} has {len(there)} images numbered {min(there)} to {max(there)}, and there are "
        f"{len(wanted)} masks numbered {min(wanted)} to {max(wanted)}: number images and masks alike"
    )


def _beside(signal: Path, masks: MovieMasks) -> tuple[FrameNames, str] | None:
    """The images whose names go on as the user says, beside the masks or in another folder."""
    if masks.names is None or os.path.lexists(signal) or not signal.name.startswith(("_", "-", ".")):
        return None
    folder = masks.names.files[0].parent if signal.parent == Path() else signal.parent
    if not folder.is_dir() or glob.has_magic(str(signal)):
        return None
    found = _by_base_name(visible_files(folder), masks.names, (signal.name,))
    if found is None:
        example = f"{base_name(masks.names.files[0].name)}{signal.name}"
        raise SignalError(f"signal {signal}: {folder} has no image such as {example}: check the ending")
    return found, ""
