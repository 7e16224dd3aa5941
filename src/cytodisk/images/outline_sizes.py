"""The size of the image that a file of outlines belongs to, which such files do not say."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames
from cytodisk.images.movie_signals import open_movie_images

_OUTLINES = (".roi", ".zip", ".geojson", ".json", ".xml")


def is_of_outlines(path: str | os.PathLike[str]) -> bool:
    """Whether a file's name says that it holds outlines."""
    return Path(path).suffix.lower() in _OUTLINES


def sized_like(
    choice: FileChoice,
    masks: str | os.PathLike[str],
    signal: str | os.PathLike[str] | None,
    signal_choice: FileChoice,
    unnamed: str,
) -> FileChoice:
    """A choice with the size of the signal, if the masks are outlines.

    Parameters
    ----------
    choice : FileChoice
        Of the file of masks.
    masks, signal : path-like
    signal_choice : FileChoice
    unnamed : {"T", "C"}
        What an axis without a name in the signal's file is.

    Returns
    -------
    FileChoice

    Raises
    ------
    ReadError
        The signal cannot be read.
    """
    if signal is None or not is_of_outlines(masks):
        return choice
    if unnamed == "T":
        image = open_movie_images(Path(signal), signal_choice)
    else:
        image = open_frames(signal, unnamed=unnamed, choice=signal_choice)
    return replace(choice, like=(image.n_frames, *image.image_shape))
