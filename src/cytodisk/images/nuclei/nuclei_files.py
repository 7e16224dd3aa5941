"""Files of nuclei: label images or 0/1 masks, whose frames go with those of the cells."""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from cytodisk.errors import MaskError, NucleusError
from cytodisk.images.evidence.frame_labels import single_label
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.frames import open_frames
from cytodisk.images.label_boxes import cell_box
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.nuclei.frame_matches import FrameMatches, match_frame
from cytodisk.images.nuclei.nuclei_parameters import NucleiFileParameters
from cytodisk.images.nuclei.numbered_pieces import mask_labels
from cytodisk.images.what_it_is import MaskLook, look_at

_FLAG = "--nuclei-channel"


@dataclass(frozen=True)
class NucleiFile:
    """A file of nuclei that was looked at.

    Attributes
    ----------
    look : MaskLook
    """

    look: MaskLook

    @property
    def file(self) -> FrameFile:
        """The file; its values may be changed, such as made whole."""
        return self.look.file

    @property
    def words(self) -> str:
        """What it is, in words."""
        what = "a label image" if self.look.kind == "labels" else "a mask, its pieces numbered"
        return f"{what}, {self.file.axes} {self.file.shape} {self.file.dtype}"

    def frame(self, number: int) -> FramePixels:
        """The labels of a frame; the pieces of a 0/1 mask are numbered from 1 in each frame.

        Raises
        ------
        ReadError
            The frame is damaged.
        """
        pixels = frame_pixels(self.file, number)
        return pixels if self.look.kind == "labels" else mask_labels(pixels)


def open_nuclei(
    path: str | os.PathLike[str], how: NucleiFileParameters, like: tuple[int, int, int] | None = None
) -> NucleiFile:
    """Open a file of nuclei and look at its values.

    Parameters
    ----------
    path : path-like
    how : NucleiFileParameters
    like : (int, int, int), optional
        (frames, H, W) of the masks, for a file of outlines, which does not say it.

    Returns
    -------
    NucleiFile

    Raises
    ------
    ReadError
        It is missing or damaged.
    NucleusError
        It is no mask and no label image: a picture, inverted, or with several channels.
    """
    try:
        choice = replace(how.nuclei_choice, like=like)
        file = open_frames(path, unnamed="T", choice=choice, flag=_FLAG)
        return NucleiFile(look_at(file, how.kind_of(file.n_frames)))
    except MaskError as error:
        raise NucleusError(f"nuclei {_of_nuclei(str(error))}") from error


def _of_nuclei(words: str) -> str:
    """A message about a file of masks with the flags for a file of nuclei."""
    words = words.replace("--mask-channel", _FLAG).replace("--axes", "--nuclei-axes")
    words = re.sub(r"kind='(stack|mask)' \(--kind \w+\)", "kind='mask' (--kind mask)", words)
    return re.sub(r"(?<![-_\w])kind=('\w+') \(--kind (\w+)\)", r"nuclei_kind=\1 (--nuclei-kind \2)", words)


def check_nuclei_file(masks: FrameFile, nuclei: FrameFile) -> None:
    """Raise NucleusError unless the frames of nuclei go with those of masks.

    Parameters
    ----------
    masks, nuclei : FrameFile
    """
    if nuclei.image_shape != masks.image_shape:
        raise NucleusError(
            f"nuclei {nuclei.path} have images of {nuclei.image_shape}, the masks of {masks.image_shape}: "
            "they must have the same height and width"
        )
    if nuclei.n_frames != masks.n_frames:
        raise NucleusError(
            f"nuclei {nuclei.path} have {nuclei.n_frames} frame{'s' * (nuclei.n_frames > 1)}, the masks "
            f"{masks.n_frames}: pass as many"
        )


def match_source(source: MaskSource, nuclei: NucleiFile, frame: int) -> FrameMatches:
    """Match the nuclei of a frame with the cells of a mask file.

    Parameters
    ----------
    source : MaskSource
        Of cells; of masks of one cell each, this has the label that the cell has in tables.
    nuclei : NucleiFile
    frame : int

    Returns
    -------
    FrameMatches

    Raises
    ------
    ReadError
        The frame of one of them is damaged.
    NucleusError
        The nuclei are the cells' own masks, or the two are swapped.
    """
    cells = source.read(frame)
    return match_frame(cells if source.kind == "labels" else one_cell(cells), nuclei.frame(frame))


def one_cell(cells: FramePixels) -> FramePixels:
    """A frame with the mask of one cell as labels."""
    box, greatest = cell_box(cells.strips())
    label = single_label(cells.dtype, greatest, box is not None)
    cut: Callable[[slice, slice], np.ndarray[Any, Any]] = partial(_labelled, cells, label)
    return FramePixels(cells.shape, np.dtype(np.int64), cut, cells.rows_together, cells.is_whole)


def _labelled(cells: FramePixels, label: int, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
    labels: np.ndarray[Any, Any] = np.where(cells.cut(rows, columns) != 0, np.int64(label), 0)
    return labels
