"""The files of a movie: one file, or a folder or pattern of files of one frame each."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from cytodisk.errors import ReadError
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.mask_names import ENDINGS, IMAGES, base_name, best_masks, files_of, image_stem
from cytodisk.images.sequences.file_sequence import open_sequence
from cytodisk.images.sequences.frame_names import FrameNames, by_series, frame_names
from cytodisk.images.short_lists import shortened

_OF_MASKS = re.compile(r"(^|[^a-z])(masks?|labels?|segmentations?|segmented|seg)([^a-z]|$)", re.IGNORECASE)


@dataclass(frozen=True)
class MovieMasks:
    """The masks of a movie.

    Attributes
    ----------
    file : FrameFile
    names : FrameNames or None
        Of its files, where each frame has its own.
    """

    file: FrameFile
    names: FrameNames | None = None


def open_movie_masks(path: Path, choice: FileChoice, sampled: bool = True) -> MovieMasks:
    """Open the masks of a movie without reading their pixels.

    Parameters
    ----------
    path : Path
        A file; a folder or a pattern of files of one frame each.
    choice : FileChoice
        What to take of each file.
    sampled : bool
        There is a signal; without one, images beside the masks are pointed out.

    Returns
    -------
    MovieMasks

    Raises
    ------
    ReadError
        There is no such file, or the files of a folder are not those of one movie.
    """
    flag = "--mask-channel"
    if not is_folder_of_files(path) and not is_pattern(path):
        return MovieMasks(open_frames(path, unnamed="T", choice=choice, flag=flag))
    names, others = _mask_frames(path)
    if others and not sampled:
        others += f" (sample images with --signal {path})"
    opened = partial(open_frame, choice=choice, flag=flag)
    return MovieMasks(sequence(path, names, opened, others), names)


def open_frame(file: Path, choice: FileChoice, flag: str) -> FrameFile:
    """One frame; axes that are said of the whole movie have a T before."""
    axes = choice.axes and choice.axes.replace("T", "")
    like = choice.like and (1, *choice.like[1:])
    return open_frames(file, unnamed="C", choice=replace(choice, axes=axes, like=like), flag=flag)


def sequence(path: Path, names: FrameNames, opened: Callable[[Path], FrameFile], others: str) -> FrameFile:
    """A movie of files with known names; `others` says which files are left out."""
    file = open_sequence(path, names.files, names.missing, opened)
    notes = (names.note, *file.notes) if names.note else file.notes
    evidence = "; ".join(filter(None, [names.words, others]))
    return replace(file, notes=notes, evidence=evidence)


def _mask_frames(place: Path) -> tuple[FrameNames, str]:
    """The files of masks, and which others there are."""
    files = readable(place)
    named = [file for file in files if file.name.lower().endswith(ENDINGS)]
    if named:
        chosen = {base_name(first.name): first for first, _ in best_masks(named)}
        names = one_series(place, chosen)
        return names, left_out(files, names)
    images = set(not_masks(files))
    of_masks = files if len(images) == len(files) else [file for file in files if file not in images]
    names = one_series(place, {file.name: file for file in of_masks})
    return names, left_out(files, names)


def not_masks(files: Sequence[Path]) -> list[Path]:
    """Files without "mask" or the like in their names; all where all have it."""
    return [file for file in files if not _OF_MASKS.search(image_stem(file.name))] or list(files)


def readable(place: Path) -> list[Path]:
    """Images of a folder or a pattern, in natural order; raises ReadError without any."""
    files = files_of(place)
    images = [file for file in files if file.suffix.lower() in IMAGES]
    if images:
        return images
    if is_pattern(place):
        return files  # whoever opens them says what they are
    raise ReadError(
        f"folder {place} holds no frames, which are images ({', '.join(IMAGES)}) of one frame each: "
        "check the path, or pass a pattern in quotes, as 'frames/t*.tif'"
    )


def one_series(place: Path, named: dict[str, Path]) -> FrameNames:
    """The files of one movie in the order of time; raises ReadError where there is another, or but one."""
    series = by_series(named)
    if len(series) > 1:
        kinds = [[named[name].name for name in names] for names in series.values()]
        kinds.sort(key=len, reverse=True)
        listed = [_series_words(names) for names in kinds]
        first = (place if place.is_dir() else place.parent) / re.sub(r"\d+", "*", kinds[0][0])
        raise ReadError(
            f"{place} holds images of {len(series)} kinds of names ({shortened(listed)}): pass those of one "
            f"movie as a pattern, in quotes, as '{first}'"
        )
    if len(named) == 1:
        raise ReadError(f"{place} holds one image alone: a movie has two frames at least; use cytodisk map")
    return frame_names(place, named)


def _series_words(names: Sequence[str]) -> str:
    shown = names[0] if len(names) == 1 else re.sub(r"\d+", "*", names[0])
    return f"{len(names)} × {shown}" if len(names) > 1 else shown


def left_out(files: Sequence[Path], names: FrameNames) -> str:
    """Words for the images of a folder that are not among those that are taken."""
    taken = set(names.files)
    others = [file for file in files if file not in taken]
    if not others:
        return ""
    return f"beside them {len(others)} other image{'s' if len(others) > 1 else ''}, as {others[0].name}"
