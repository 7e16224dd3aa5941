"""Mask files → cells: a file or a folder of label images, each cell cut out of its image."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy import ndimage

from cytodisk.errors import CytodiskError, MaskError, ReadError
from cytodisk.io.frames import FrameFile, open_frames
from cytodisk.io.masks import Kind, understood_as

# Endings of mask files; where one image has several, the one that stands first here is taken.
ENDINGS = (
    "_masks.tif",
    "_masks.tiff",
    "_masks.png",
    "_cp_masks.tif",
    "_cp_masks.tiff",
    "_cp_masks.png",
    "_seg.npy",
)
_IMAGES = (".tif", ".tiff", ".png")
_MOST_SLOTS = 1_000_000  # labels up to here index a list of boxes; larger ones are renumbered first


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
    """

    name: str
    path: Path
    file: FrameFile | None
    kind: Kind | None
    fault: CytodiskError | None = None
    instead_of: tuple[str, ...] = ()


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
        Its label in a label image or of its mask, otherwise 1.
    mask : ndarray of shape (h, w), or None
        Pixels of the cell's box and one more on every side where the image goes on: as they stand in the
        file for a mask, boolean for a label.
    corner : (int, int)
        (row, column) of the first pixel of `mask` in the image.
    image_shape : (int, int)
    fault : CytodiskError or None
    """

    cell: int
    source: str
    frame: int
    label: int
    mask: np.ndarray[Any, Any] | None
    corner: tuple[int, int] = (0, 0)
    image_shape: tuple[int, int] = (0, 0)
    fault: CytodiskError | None = None


def open_mask_files(path: str | os.PathLike[str], kind: Kind = "auto") -> tuple[MaskSource, ...]:
    """Find the mask files of a folder, or open a single one.

    Parameters
    ----------
    path : path-like
        A file, or a folder with `*_masks.tif`, `*_masks.png`, `*_cp_masks.tif`, `*_cp_masks.png` or
        `*_seg.npy`; if it holds none of these, every TIFF and PNG of it. Folders in it are not looked into.
        Of several files for one image only the first in this order is taken.
    kind : {"auto", "mask", "stack", "labels"}
        What each file is; "auto" decides for each by itself.

    Returns
    -------
    tuple of MaskSource
        In natural order of names (2 before 10). In a folder, a file that cannot be used has its fault.

    Raises
    ------
    ReadError
        The folder or the file is missing or cannot be read, or the folder holds no image.
    MaskError
        A single file is no mask.
    ParameterError
        An unknown kind.
    """
    place = Path(path)
    if not place.is_dir():
        file = open_frames(place, unnamed="T")
        return (MaskSource(place.name, place, file, understood_as(file, kind)),)
    return tuple(_source(chosen, others, kind) for chosen, others in _mask_names(place))


def base_name(name: str) -> str:
    """The name of the image that a mask file belongs to, without its ending: "a" of "a_cp_masks.png"."""
    lower = name.lower()
    fitting = [ending for ending in ENDINGS if lower.endswith(ending)]
    return name[: -max(map(len, fitting))] if fitting else image_stem(name)


def image_stem(name: str) -> str:
    """A file's name without the ending that says how it is stored: "a" of "a.ome.tif"."""
    return re.sub(r"(\.ome)?\.(tiff?|png|npy)$", "", name, flags=re.IGNORECASE)


def natural_order(name: str) -> list[tuple[int, str]]:
    """A key that sorts names with numbers as a person would: a2 before a10."""
    return [(int(part), "") if part.isdecimal() else (0, part) for part in re.split(r"(\d+)", name.lower())]


def visible_files(folder: Path) -> list[Path]:
    """Files of a folder in natural order, but for hidden ones.

    Raises
    ------
    ReadError
        The folder cannot be read.
    """
    try:
        found = [file for file in folder.iterdir() if file.is_file() and not file.name.startswith(".")]
    except OSError as error:
        raise ReadError(f"folder {folder} cannot be read: {error.strerror}") from error
    return sorted(found, key=lambda file: natural_order(file.name))


def _mask_names(folder: Path) -> list[tuple[Path, list[Path]]]:
    """The mask file of each image, and others for the same image."""
    files = visible_files(folder)
    named = [file for file in files if file.name.lower().endswith(ENDINGS)]
    if not named:
        images = [file for file in files if file.suffix.lower() in _IMAGES]
        if not images:
            raise ReadError(
                f"folder {folder} holds no masks: neither files that end in {', '.join(ENDINGS)}, "
                f"nor other images ({', '.join(_IMAGES)})"
            )
        return [(file, []) for file in images]
    by_image: dict[str, list[Path]] = {}
    for file in named:
        by_image.setdefault(base_name(file.name), []).append(file)
    ranked = [sorted(group, key=lambda file: _rank(file.name)) for group in by_image.values()]
    return [(first, others) for first, *others in ranked]


def _rank(name: str) -> int:
    """Place of the longest ending that fits: `_cp_masks.tif` ends in `_masks.tif` too."""
    fitting = [ending for ending in ENDINGS if name.lower().endswith(ending)]
    return ENDINGS.index(max(fitting, key=len))


def _source(path: Path, others: list[Path], kind: Kind) -> MaskSource:
    source = MaskSource(path.name, path, None, None, instead_of=tuple(file.name for file in others))
    try:
        file = open_frames(path, unnamed="T")
        return replace(source, file=file, kind=understood_as(file, kind))
    except (ReadError, MaskError) as fault:
        return replace(source, fault=fault)


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
        for found in _cells_of(source):
            yield replace(found, cell=cell)
            cell += 1


def _cells_of(source: MaskSource) -> Iterator[SourceCell]:
    if source.file is None or source.kind is None:
        yield SourceCell(0, source.name, 0, 0, None, fault=source.fault)
        return
    shape = source.file.image_shape
    for number in range(source.file.n_frames):
        nothing = SourceCell(0, source.name, number, 0, None, image_shape=shape)
        try:
            frame = source.file.frame(number)[0]
            if source.kind == "labels":
                _check_labels(frame, number)
        except (ReadError, MaskError) as fault:
            yield replace(nothing, fault=fault)
            continue
        if source.kind == "labels":
            yield from _labelled(frame, nothing)
        else:
            box = ndimage.find_objects(np.asarray(frame != 0).view(np.uint8))
            rows, columns = with_margin(box[0], shape) if box else (slice(0, None), slice(0, None))
            corner = rows.start, columns.start
            # A copy, so that a waiting cell does not hold its whole image.
            yield replace(
                nothing, label=_single_label(frame), mask=frame[rows, columns].copy(), corner=corner
            )


def _check_labels(frame: np.ndarray[Any, Any], number: int) -> None:
    if not np.issubdtype(frame.dtype, np.integer):
        raise MaskError(f"labels must be whole numbers, got dtype {frame.dtype}: save the labels as uint16")
    if frame.min() < 0:
        raise MaskError(
            f"frame {number} has negative labels (down to {frame.min()}): set what is no cell to 0"
        )
    if not frame.any():
        raise MaskError(f"frame {number} is empty: it holds no label")


def _labelled(frame: np.ndarray[Any, Any], nothing: SourceCell) -> Iterator[SourceCell]:
    """Each label's crop, in one pass over the frame."""
    values, ranks = None, frame
    if int(frame.max()) > _MOST_SLOTS:
        values = np.unique(frame[frame != 0])
        ranks = np.where(frame != 0, np.searchsorted(values, frame) + 1, 0)
    for place, box in enumerate(ndimage.find_objects(ranks.astype(np.int32))):
        if box is not None:
            label = place + 1 if values is None else int(values[place])
            rows, columns = with_margin(box, frame.shape)
            inside = frame[rows, columns] == label
            yield replace(nothing, label=label, mask=inside, corner=(rows.start, columns.start))


def with_margin(box: tuple[slice, ...], shape: tuple[int, ...]) -> tuple[slice, slice]:
    """A box with one more pixel on every side where the image goes on."""
    rows, columns = (
        slice(max(side.start - 1, 0), min(side.stop + 1, size)) for side, size in zip(box, shape, strict=True)
    )
    return rows, columns


def _single_label(frame: np.ndarray[Any, Any]) -> int:
    """The label of a frame that holds just one; 1 for plain masks such as 0/1 and 0/255."""
    if not np.issubdtype(frame.dtype, np.integer):
        return 1
    label = int(frame.max(initial=0))
    return 1 if label in (0, np.iinfo(frame.dtype).max) else label
