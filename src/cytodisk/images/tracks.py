"""Mask movies → tracks: which cell is where in which frame."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cytodisk.errors import CytodiskError, MaskError, ReadError, as_data
from cytodisk.geometry.fragments import without_others
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.images.file_parameters import Fragments, Kind
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.label_boxes import Box, cell_box, label_boxes, with_margin
from cytodisk.images.linking import link_labels
from cytodisk.images.what_it_is import MaskLook


@dataclass(frozen=True)
class CellTrack:
    """One cell of a movie.

    Attributes
    ----------
    cell : int
        Running number in the movie.
    label : int
        Its label, or its track when labels were linked; 1 in a movie of one cell.
    first, last : int
        Frames it is in, both included; between them it may be missing.
    labels : dict of int to int, or None
        Its label in the file by frame; None if every frame is a mask of this one cell.
    fragments : {"refuse", "largest"}
        What to do in a frame where it has several pieces.
    """

    cell: int
    label: int
    first: int
    last: int
    labels: dict[int, int] | None
    fragments: Fragments = "refuse"

    @property
    def frames(self) -> range:
        """Numbers of the frames from the first to the last."""
        return range(self.first, self.last + 1)

    def mask_in(self, image: Any, frame: int) -> Any:
        """The cell's mask in a frame.

        Parameters
        ----------
        image : ndarray of shape (H, W), or CytodiskError
            The frame's masks or labels, as `read_frame` returns them.
        frame : int
            Its number.

        Returns
        -------
        ndarray of shape (H, W), or CytodiskError
            An error says why there is no mask: the frame is damaged, the label is not in it, or it is that of
            several cells.
        """
        if isinstance(image, CytodiskError):
            return image
        if self.labels is not None and frame not in self.labels:
            return MissingLabel(f"label {self.label} is not in frame {frame}")
        mask = image if self.labels is None else image == self.labels[frame]
        return self._of_one_cell(mask)

    def _of_one_cell(self, mask: Any) -> Any:
        return without_others(mask, self.fragments, None if self.labels is None else self.label)

    def cut_from(self, found: CellsInFrame | CytodiskError, frame: int) -> PlacedMask | CytodiskError:
        """As `mask_in`, but the cell's box alone, with one more pixel on every side where the image goes on.

        Parameters
        ----------
        found : CellsInFrame or CytodiskError
            As `open_cells` returns it.
        frame : int
        """
        if isinstance(found, CytodiskError):
            return found
        if self.labels is not None and frame not in self.labels:
            return MissingLabel(f"label {self.label} is not in frame {frame}")
        try:
            placed = found.mask_of(None if self.labels is None else self.labels[frame])
        except ReadError as error:
            return as_data(error)
        fault = self._of_one_cell(placed.box)
        return fault if isinstance(fault, CytodiskError) else placed


@dataclass(frozen=True, eq=False)
class CellsInFrame:
    """A frame of a mask movie with the box of each cell.

    Attributes
    ----------
    pixels : FramePixels
    boxes : dict of (int or None) to (slice, slice)
        By label, None for a frame that is the mask of one cell.
    """

    pixels: FramePixels
    boxes: dict[int | None, Box]

    def mask_of(self, label: int | None) -> PlacedMask:
        """The mask of a label, or of the one cell with the values that it has in the file."""
        shape = self.pixels.image_shape
        everything = slice(0, shape[0]), slice(0, shape[1])
        rows, columns = with_margin(self.boxes.get(label, everything), shape)
        values = self.pixels.cut(rows, columns)[0]
        box = values.copy() if label is None else values == label
        return PlacedMask(box, (rows.start, columns.start), shape)


def open_cells(file: FrameFile, frame: int, kind: Kind) -> CellsInFrame | ReadError:
    """Find the cells of a frame of a mask movie, which is read by piece.

    Parameters
    ----------
    file : FrameFile
    frame : int
    kind : {"stack", "labels"}

    Returns
    -------
    CellsInFrame, or ReadError
        The error of a damaged frame, so that the frames around it can be used.
    """
    try:
        pixels = frame_pixels(file, frame)
        if kind == "labels":
            return CellsInFrame(pixels, dict(label_boxes(pixels.strips())))
        box, _ = cell_box(pixels.strips())
        return CellsInFrame(pixels, {} if box is None else {None: box})
    except ReadError as error:
        return as_data(error)


@dataclass(frozen=True)
class TrackMasks:
    """The masks of one cell from its first frame to its last, each read when it is asked for.

    Attributes
    ----------
    file : FrameFile
    track : CellTrack
    """

    file: FrameFile
    track: CellTrack

    def __len__(self) -> int:
        return len(self.track.frames)

    def __getitem__(self, index: int) -> Any:
        """Mask of shape (H, W), counted from the cell's first frame; an error says why there is none."""
        frame = self.track.frames[index]
        return self.track.mask_in(read_frame(self.file, frame), frame)

    def __iter__(self) -> Iterator[Any]:
        return (self[index] for index in range(len(self)))


class MissingLabel(MaskError):
    """A tracked cell is not in a frame between its first and its last."""


def read_frame(file: FrameFile, frame: int) -> Any:
    """A frame of a mask movie.

    Parameters
    ----------
    file : FrameFile
    frame : int

    Returns
    -------
    ndarray of shape (H, W), or ReadError
        The error of a damaged frame, so that the frames around it can be used.
    """
    try:
        return file.frame(frame)[0]
    except ReadError as error:
        return as_data(error)


def list_tracks(
    look: MaskLook, link: bool | None = None, given: Sequence[dict[int, int]] | None = None
) -> list[CellTrack]:
    """The cells of a mask movie.

    Parameters
    ----------
    look : MaskLook
        At its file.
    link : bool, optional
        Whether labels are not the same from frame to frame, so that they must be linked by overlap.
    given : sequence of dict of int to int, optional
        For each frame {label: track}, where another program has tracked the labels.

    Returns
    -------
    list of CellTrack
        By label, or by track.

    Raises
    ------
    MaskError
        Labels are not whole numbers, or none is there.
    MissingPartError
        `link` needs a package that is not installed.
    """
    file = look.file
    if look.kind != "labels":
        return [CellTrack(0, 1, 0, file.n_frames - 1, None, look.fragments)]
    faults = {frame: found for frame, found in enumerate(look.labels) if isinstance(found, CytodiskError)}
    for fault in faults.values():
        if not isinstance(fault, ReadError):
            raise fault
    found: dict[int, dict[int, int]] = {}
    tracks = given
    if tracks is None:
        tracks = link_labels(_label_frames(file)) if link else _labels_as_tracks(look)
    for frame, in_frame in enumerate(tracks):
        for label, track in in_frame.items():
            found.setdefault(track, {})[frame] = label
    if not found:
        raise MaskError(f"{file.path} holds no label in any of its {file.n_frames} frames")
    cells = [
        CellTrack(cell, track, min(found[track]), max(found[track]), found[track], look.fragments)
        for cell, track in enumerate(sorted(found))
    ]
    for frame in faults:
        cells = _with_damaged(cells, frame)
    return cells


def _with_damaged(tracks: list[CellTrack], frame: int) -> list[CellTrack]:
    """Give a damaged frame that no cell spans to the cells nearest in time, so that their rows tell of it."""
    away = [max(track.first - frame, frame - track.last, 0) for track in tracks]
    nearest = min(away)
    return [
        replace(track, first=min(track.first, frame), last=max(track.last, frame))
        if distance == nearest > 0
        else track
        for track, distance in zip(tracks, away, strict=True)
    ]


def _labels_as_tracks(look: MaskLook) -> list[dict[int, int]]:
    return [
        {} if isinstance(found, CytodiskError) else {label: label for label in found} for found in look.labels
    ]


def _label_frames(file: FrameFile) -> Iterator[Any]:
    """Frames as label images; a damaged one counts as empty here."""
    for frame in range(file.n_frames):
        labels = read_frame(file, frame)
        yield np.zeros(file.image_shape, dtype=np.uint8) if isinstance(labels, ReadError) else labels
