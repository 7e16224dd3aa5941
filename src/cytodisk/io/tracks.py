"""Mask movies → tracks: which cell is where in which frame."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.errors import CytodiskError, MaskError, ReadError
from cytodisk.io.frames import FrameFile
from cytodisk.io.linking import link_labels
from cytodisk.io.masks import Kind


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
    """

    cell: int
    label: int
    first: int
    last: int
    labels: dict[int, int] | None

    @property
    def times(self) -> range:
        """Frames from the first to the last."""
        return range(self.first, self.last + 1)

    def mask_in(self, frame: Any, time: int) -> Any:
        """The cell's mask in a frame.

        Parameters
        ----------
        frame : ndarray of shape (H, W), or CytodiskError
            As `read_frame` returns it.
        time : int

        Returns
        -------
        ndarray of shape (H, W), or CytodiskError
            An error says why there is no mask: the frame is damaged, or the label is not in it.
        """
        if isinstance(frame, CytodiskError) or self.labels is None:
            return frame
        if time not in self.labels:
            return MissingLabel(f"label {self.label} is not in frame {time}")
        return frame == self.labels[time]


class MissingLabel(MaskError):
    """A tracked cell is not in a frame between its first and its last."""


def read_frame(file: FrameFile, time: int) -> Any:
    """A frame of a mask movie.

    Parameters
    ----------
    file : FrameFile
    time : int

    Returns
    -------
    ndarray of shape (H, W), or ReadError
        The error of a damaged frame, so that the frames around it can be used.
    """
    try:
        return file.frame(time)[0]
    except ReadError as error:
        return error


def list_tracks(file: FrameFile, kind: Kind, link: bool) -> list[CellTrack]:
    """The cells of a mask movie.

    Parameters
    ----------
    file : FrameFile
    kind : {"stack", "labels"}
    link : bool
        Labels are not the same from frame to frame: link them by overlap.

    Returns
    -------
    list of CellTrack
        By label, or by first appearance when linked.

    Raises
    ------
    MaskError
        Labels are not whole numbers, or none is there.
    MissingPartError
        `link` needs a package that is not installed.
    """
    if kind != "labels":
        return [CellTrack(0, 1, 0, file.n_frames - 1, None)]
    found: dict[int, dict[int, int]] = {}
    tracks = link_labels(_label_frames(file)) if link else _labels_as_tracks(file)
    for time, in_frame in enumerate(tracks):
        for label, track in in_frame.items():
            found.setdefault(track, {})[time] = label
    if not found:
        raise MaskError(f"{file.path} holds no label in any of its {file.n_frames} frames")
    return [
        CellTrack(cell, track, min(found[track]), max(found[track]), found[track])
        for cell, track in enumerate(sorted(found))
    ]


def _labels_as_tracks(file: FrameFile) -> list[dict[int, int]]:
    return [{int(label): int(label) for label in np.unique(frame) if label} for frame in _label_frames(file)]


def _label_frames(file: FrameFile) -> Iterator[Any]:
    """Frames as label images; a damaged one counts as empty here, and has its reason in the run."""
    for time in range(file.n_frames):
        frame = read_frame(file, time)
        if isinstance(frame, ReadError):
            yield np.zeros(file.image_shape, dtype=np.uint8)
            continue
        if not np.issubdtype(frame.dtype, np.integer):
            raise MaskError(f"labels must be whole numbers, got dtype {frame.dtype}: save them as uint16")
        if frame.min() < 0:
            raise MaskError(
                f"frame {time} has negative labels (down to {frame.min()}): set what is no cell to 0"
            )
        yield frame
