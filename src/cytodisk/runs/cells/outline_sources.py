"""Files of outlines do not say how large their image is: the image that goes with them does."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cytodisk.errors import MaskError, ReadError, as_data
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.frames import open_frames
from cytodisk.images.mask_files import MaskSource, open_mask_files
from cytodisk.images.sequences.movie_signals import open_movie_images
from cytodisk.images.signal_files import pair_images
from cytodisk.runs.cells.cell_parameters import FileParameters

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


def with_sizes(
    sources: Sequence[MaskSource], signal: str | os.PathLike[str] | None, parameters: FileParameters
) -> tuple[MaskSource, ...]:
    """Mask files of a folder, those of outlines with the size of their image.

    Parameters
    ----------
    sources : sequence of MaskSource
    signal : path-like, optional
        As `pair_images` takes it.
    parameters : FileParameters

    Returns
    -------
    tuple of MaskSource
        One whose image cannot be read stays as it is: whoever opens the image says why.
    """
    if signal is None or not any(is_of_outlines(source.path) for source in sources):
        return tuple(sources)
    images = pair_images(sources, signal)
    return tuple(
        _sized(source, image, parameters)
        if isinstance(image, Path) and is_of_outlines(source.path)
        else source
        for source, image in zip(sources, images, strict=True)
    )


def _sized(source: MaskSource, image: Path, parameters: FileParameters) -> MaskSource:
    try:
        choice = sized_like(parameters.mask_choice, source.path, image, parameters.signal_choice, "C")
    except ReadError:
        return source
    try:
        return open_mask_files(source.path, parameters.part(KindParameters), choice=choice)[0]
    except (ReadError, MaskError) as fault:
        return replace(source, file=None, kind=None, look=None, fault=as_data(fault))
