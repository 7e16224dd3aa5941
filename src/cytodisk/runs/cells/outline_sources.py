"""Files of outlines in a folder: the size of each one's image."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cytodisk.errors import MaskError, ReadError, as_data
from cytodisk.images.file_parameters import KindParameters
from cytodisk.images.mask_files import MaskSource, open_mask_files
from cytodisk.images.outline_sizes import is_of_outlines, sized_like
from cytodisk.images.signal_files import pair_images
from cytodisk.runs.cells.cell_parameters import FileParameters


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
