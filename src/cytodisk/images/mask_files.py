"""Mask files → cells: a file or a folder of label images, each cell cut out of its image."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field, replace
from functools import lru_cache, partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import CytodiskError, MaskError, ReadError, as_data
from cytodisk.geometry.fragments import SeveralCells, without_others
from cytodisk.images.evidence.frame_labels import check_labels, found_labels, single_label
from cytodisk.images.file_parameters import Kind, KindParameters
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.label_boxes import Box, cell_box, with_margin
from cytodisk.images.mask_names import mask_names
from cytodisk.images.what_it_is import MaskLook, Reader, look_at, refuse_several


@dataclass(frozen=True)
class MaskSource:
    """One file of masks, or the reason why it cannot be used.

    Attributes
    ----------
    name : str
        Relative to the folder.
    path : Path
    file : FrameFile or None
        None if it cannot be opened.
    kind : {"mask", "stack", "labels"} or None
    fault : CytodiskError or None
    instead_of : tuple of str
        Names of files with masks of the same image, which are left out so that no cell counts twice.
    damaged : tuple of str
        Those of them that should have come first, but cannot be used.
    look : MaskLook or None
        What is known of its frames.
    reader : callable or None
        Opens a frame that is kept since the look; None to open it anew.
    """

    name: str
    path: Path
    file: FrameFile | None
    kind: Kind | None
    fault: CytodiskError | None = None
    instead_of: tuple[str, ...] = ()
    damaged: tuple[str, ...] = ()
    look: MaskLook | None = None
    reader: Reader | None = field(default=None, repr=False, compare=False)

    def read(self, number: int) -> FramePixels:
        """A frame; raises ReadError where it is damaged."""
        assert self.file is not None  # whoever asks for a frame knows that there is one
        return (self.reader or partial(frame_pixels, self.file))(number)


@dataclass(frozen=True)
class SourceCell:
    """One cell of a mask file, cut out of its image, or the reason why there is none.

    Attributes
    ----------
    cell : int
        Running number through all files.
    source : str
        Name of the file.
    frame : int
    label : int
        Its label in a label image or of its mask, otherwise 1; 0 where a file or an image holds no cell.
    mask : ndarray of shape (h, w), or None
        Pixels of the cell's box and one more on every side where the image goes on: as they stand in the
        file for a mask, boolean for a label.
    corner : (int, int)
        (row, column) of the first pixel of `mask` in the image.
    image_shape : (int, int)
    fault : CytodiskError or None
    refused : ndarray of shape (h, w), or None
        Pixels as of `mask` that are refused as one cell; to be shown.
    """

    cell: int
    source: str
    frame: int
    label: int
    mask: np.ndarray[Any, Any] | None
    corner: tuple[int, int] = (0, 0)
    image_shape: tuple[int, int] = (0, 0)
    fault: CytodiskError | None = None
    refused: np.ndarray[Any, Any] | None = None


def open_mask_files(
    path: str | os.PathLike[str],
    how: KindParameters | None = None,
    images: tuple[str, ...] = (),
    choice: FileChoice | None = None,
) -> tuple[MaskSource, ...]:
    """Find the mask files of a folder, or open a single one.

    Parameters
    ----------
    path : path-like
        A file, or a folder with `*_masks.tif`, `*_masks.png`, `*_cp_masks.tif`, `*_cp_masks.png` or
        `*_seg.npy`; if it holds none of these, every file of outlines (.zip, .roi, .geojson), or else every
        TIFF, PNG and array (.npy) of it. Folders in it are not looked into.
        A pattern, as "folder/a*.tif", stands for those of its files that fit.
        Of several files for one image only the first in this order that can be used is taken.
    how : KindParameters, optional
        What the user says of each file; a kind of "auto" is decided for each by itself.
    images : tuple of str
        How names of images go on that are no masks, as "_img"; in a folder whose masks have other endings.
    choice : FileChoice, optional
        Of a single file, in the place of what `how` says.

    Returns
    -------
    tuple of MaskSource
        In natural order of names (2 before 10). In a folder, a file that cannot be used has its fault.

    Raises
    ------
    ReadError
        The folder or the file is missing or cannot be read, or the folder holds no image.
    MaskError
        A single file is no mask, or holds several cells in each of its masks.
    """
    place, how = Path(path), KindParameters() if how is None else how
    if not is_folder_of_files(place) and not is_pattern(place):
        file = _frames_of(place, how.mask_choice if choice is None else choice)
        opened = partial(frame_pixels, file)
        reader: Reader = lru_cache(maxsize=1)(opened) if file.n_frames == 1 else opened
        look = look_at(file, how, reader)
        kept = reader if look.file is file else None
        refuse_several(look, kept)
        return (MaskSource(place.name, place, look.file, look.kind, look=look, reader=kept),)
    return tuple(_source(chosen, others, how) for chosen, others in mask_names(place, images))


def _frames_of(path: Path, choice: FileChoice) -> FrameFile:
    return open_frames(path, unnamed="T", choice=choice, flag="--mask-channel")


def _source(path: Path, others: list[Path], how: KindParameters) -> MaskSource:
    """The first of an image's mask files that can be used, or the very first with its fault."""
    paths = [path, *others]
    first = None
    for place, taken in enumerate(paths):
        found = _opened(taken, how)
        first = found if first is None else first
        if found.fault is None:
            left = tuple(file.name for file in paths if file != taken)
            return replace(found, instead_of=left, damaged=tuple(file.name for file in paths[:place]))
    assert first is not None  # there is one path at least
    return replace(first, instead_of=tuple(file.name for file in others))


def _opened(path: Path, how: KindParameters) -> MaskSource:
    source = MaskSource(path.name, path, None, None)
    try:
        file = _frames_of(path, how.mask_choice)
        look = look_at(file, how)
        if how.kind != "auto" and file.n_frames == 1:
            file.frame(0)  # raises where the picture itself is damaged; "auto" has read it
        return replace(source, file=look.file, kind=look.kind, look=look)
    except (ReadError, MaskError) as fault:
        return replace(source, fault=as_data(fault))


@dataclass(frozen=True)
class MaskImage:
    """One frame of a mask file, not read yet.

    Attributes
    ----------
    source : MaskSource
    frame : int
    first_cell : int
        Running number of its first cell through all files.
    n_cells : int
        How many cells it gives; one, with the fault, where a file or an image holds none.
    """

    source: MaskSource
    frame: int
    first_cell: int
    n_cells: int

    def cells(self) -> Iterator[SourceCell]:
        """Read the frame; a damaged one comes as a cell with its fault.

        Raises
        ------
        ReadError
            It holds other cells than at the look at the file.
        """
        count = 0
        for number, found in enumerate(_cells_of(self.source, self.frame)):
            yield replace(found, cell=self.first_cell + number)
            count += 1
        if count != self.n_cells:
            raise ReadError(f"{self.source.path} has changed since it was opened: run the command again")


def list_images(sources: Iterable[MaskSource]) -> list[MaskImage]:
    """The frames of mask files, with the numbers of their cells; no frame is read.

    Parameters
    ----------
    sources : iterable of MaskSource
        As `open_mask_files` returns them.

    Returns
    -------
    list of MaskImage
        A file that cannot be used counts as one frame, with one cell that has the fault.
    """
    images: list[MaskImage] = []
    cell = 0
    for source in sources:
        usable = source.file is not None and source.look is not None
        for number in range(source.file.n_frames if source.file is not None and usable else 1):
            count = source.look.cells_in(number) if source.look is not None and usable else 1
            images.append(MaskImage(source, number, cell, count))
            cell += count
    return images


def read_source_cells(sources: Iterable[MaskSource]) -> Iterator[SourceCell]:
    """The cells of mask files, file by file and frame by frame; a damaged one comes as a cell with its fault.

    Parameters
    ----------
    sources : iterable of MaskSource

    Yields
    ------
    SourceCell
    """
    cell = 0
    for source in sources:
        for number in range(1 if source.file is None else source.file.n_frames):
            for found in _cells_of(source, number):
                yield replace(found, cell=cell)
                cell += 1


def _cells_of(source: MaskSource, number: int) -> Iterator[SourceCell]:
    """Cells of a frame, each as cell 0."""
    if source.file is None or source.kind is None:
        yield SourceCell(0, source.name, 0, 0, None, fault=source.fault)
        return
    shape = source.file.image_shape
    nothing = SourceCell(0, source.name, number, 0, None, image_shape=shape)
    try:
        frame = source.read(number)
        if source.kind != "labels":
            yield _of_one_cell(_single(frame, nothing), source, None)
            return
        found = found_labels(frame, number)
    except (ReadError, MaskError) as fault:
        yield replace(nothing, fault=as_data(fault))
        return
    for label, box in found:
        yield _of_one_cell(_labelled(frame, label, with_margin(box, shape), nothing), source, label)


def _of_one_cell(found: SourceCell, source: MaskSource, label: int | None) -> SourceCell:
    """The same cell, or its fault where it is several."""
    if found.mask is None or source.look is None:
        return found
    mask, whole = without_others(found.mask, source.look.fragments, label), found.mask
    return replace(found, mask=None, fault=mask, refused=whole) if isinstance(mask, SeveralCells) else found


def _labelled(frame: FramePixels, label: int, place: Box, nothing: SourceCell) -> SourceCell:
    try:
        mask, corner = frame.cut(*place)[0] == label, (place[0].start, place[1].start)
        return replace(nothing, label=label, mask=mask, corner=corner)
    except ReadError as fault:
        return replace(nothing, label=label, fault=as_data(fault))


def _single(frame: FramePixels, nothing: SourceCell) -> SourceCell:
    box, greatest = cell_box(frame.strips())
    if frame.dtype == np.uint64 and greatest < np.iinfo(np.uint64).max:  # which is a plain mask
        check_labels(frame.dtype, np.array(greatest, dtype=frame.dtype), nothing.frame)
    everything = slice(0, frame.image_shape[0]), slice(0, frame.image_shape[1])
    rows, columns = with_margin(box or everything, frame.image_shape)
    mask = frame.cut(rows, columns)[0].copy()  # so that a waiting cell does not hold its whole image
    label = single_label(frame.dtype, greatest, box is not None)
    return replace(nothing, label=label, mask=mask, corner=(rows.start, columns.start))
