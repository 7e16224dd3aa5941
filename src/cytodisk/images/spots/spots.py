"""Spots of a tracking program and the links between them, whatever the file's format."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.scale import UNKNOWN, Scale

PIXEL = "px"


@dataclass(frozen=True, eq=False)
class Spots:
    """Spots that are in a track, and their links.

    Attributes
    ----------
    path : Path
        Of the file.
    frame : ndarray of shape (N,) and dtype int
    yx : ndarray of shape (N, 2) and dtype float
        Positions (row, column) in `unit`, the centre of the first pixel at 0.
    radius : ndarray of shape (N,) and dtype float
        In `unit`; NaN where the file says none.
    names : ndarray of shape (N,) and dtype int
        Number of the track in the file, from 1; 0 where it has none.
    links : ndarray of shape (E, 2) and dtype int
        Pairs of spots, by their place in `frame`.
    outlines : tuple of ndarray of shape (M, 2), or None
        For each spot, its outline (row, column) in `unit`.
    labels : ndarray of shape (N,) and dtype int, or None
        Labels of the spots in a label image, where the file says them; 0 for none.
    unit : str
        Of lengths: "px", "µm", or what the file says.
    pixel_size : (float, float) or None
        Height and width of a pixel in `unit`, where the file says it.
    image_shape : (int, int) or None
    n_frames : int or None
        Of the image, where the file says it.
    scale : Scale
        What the file says of the image.
    remarks : tuple of str
        What of the file was left out.
    """

    path: Path
    frame: IntArray
    yx: FloatArray
    radius: FloatArray
    names: IntArray
    links: IntArray
    outlines: tuple[FloatArray | None, ...] = ()
    labels: IntArray | None = None
    unit: str = PIXEL
    pixel_size: tuple[float, float] | None = None
    image_shape: tuple[int, int] | None = None
    n_frames: int | None = None
    scale: Scale = UNKNOWN
    remarks: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.frame)


@dataclass(frozen=True, eq=False)
class Branches:
    """Tracks without branches.

    Attributes
    ----------
    track : ndarray of shape (N,) and dtype int
        Number of the track of each spot, from 1.
    mothers : dict of int to int
        Of tracks that begin with a division, the one that divided.
    merged : dict of int to tuple of int
        Of tracks that begin where others merge, those.
    ignored : int
        Links within one frame.
    """

    track: IntArray
    mothers: dict[int, int]
    merged: dict[int, tuple[int, ...]]
    ignored: int = 0


def branches(spots: Spots) -> Branches:
    """Cut tracks where cells divide or merge: a track goes on as long as each spot has one follower.

    Parameters
    ----------
    spots : Spots

    Returns
    -------
    Branches
        The first track with a name keeps its number; what follows a division has new ones.
    """
    frame, links = spots.frame, spots.links
    across = frame[links[:, 0]] != frame[links[:, 1]]
    ordered = links[across]
    backwards = frame[ordered[:, 0]] > frame[ordered[:, 1]]
    ordered = np.unique(np.where(backwards[:, None], ordered[:, ::-1], ordered), axis=0)
    followers = np.bincount(ordered[:, 0], minlength=len(frame))
    before: dict[int, list[int]] = {}
    for earlier, later in ordered.tolist():
        before.setdefault(later, []).append(earlier)
    track = np.zeros(len(frame), dtype=np.int64)
    starts: list[int] = []
    for spot in np.argsort(frame, kind="stable").tolist():
        parents = before.get(spot, [])
        if len(parents) == 1 and followers[parents[0]] == 1:
            track[spot] = track[parents[0]]
        else:
            starts.append(spot)
            track[spot] = len(starts)
    numbers = _numbers([int(spots.names[spot]) for spot in starts])
    track = numbers[track]
    mothers, merged = {}, {}
    for spot in starts:
        parents = [int(track[parent]) for parent in before.get(spot, [])]
        if len(parents) == 1:
            mothers[int(track[spot])] = parents[0]
        elif parents:
            merged[int(track[spot])] = tuple(parents)
    return Branches(track, mothers, merged, int((~across).sum()))


def _numbers(names: list[int]) -> IntArray:
    """A number for each track, from 1 on: its name, where no track before has it; index 0 is no track."""
    taken: set[int] = set()
    numbers = [0]
    following = max(names, default=0)
    for name in names:
        if name > 0 and name not in taken:
            taken.add(name)
            numbers.append(name)
        else:
            following += 1
            numbers.append(following)
    return np.array(numbers, dtype=np.int64)
