"""Outlines of cells in XML files of TrackMate, each track a label."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.formats.outlined.outline_file import open_outlines
from cytodisk.images.formats.outlined.outline_set import Outline, OutlineSet
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.spots.spots import PIXEL, branches
from cytodisk.images.spots.track_words import branch_words
from cytodisk.images.spots.trackmate_file import read_trackmate

_FRAMES_BELIEVED = 1000, 10  # so many, or so many times as many as have spots


def open_trackmate(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at the outlines of TrackMate's spots; see `cytodisk.images.frames.open_frames`."""
    return open_outlines(file, read_trackmate_outlines, choice)


def read_trackmate_outlines(path: Path) -> OutlineSet:
    """The outlines of tracked spots.

    Parameters
    ----------
    path : Path

    Returns
    -------
    OutlineSet

    Raises
    ------
    ReadError
        The file has no tracks, or its spots have no outlines.
    """
    spots = read_trackmate(path)
    found = branches(spots)
    held = [number for number, outline in enumerate(spots.outlines) if outline is not None]
    if not held:
        raise ReadError(
            f"{path} holds spots without outlines: pass the label images that they were found in as masks, "
            "and this file as their tracks (--tracks)"
        )
    if spots.pixel_size is None and spots.unit != PIXEL:
        raise ReadError(f"{path} does not say the size of a pixel: save it again with TrackMate, image open")
    size = np.array(spots.pixel_size or (1.0, 1.0))
    outlines = tuple(
        Outline(
            (spots.outlines[number] / size,),
            f"track {found.track[number]} in frame {spots.frame[number]}",
            int(spots.frame[number]),
            None,
            int(found.track[number]),
        )
        for number in held
    )
    remarks = [*spots.remarks, *branch_words(found)]
    if len(held) < len(spots):
        remarks.append(f"{len(spots) - len(held)} of {len(spots)} spots have no outline: they are left out")
    n_frames, least = spots.n_frames, int(spots.frame.max()) + 1
    if n_frames is not None and not least <= n_frames <= max(
        _FRAMES_BELIEVED[0], _FRAMES_BELIEVED[1] * least
    ):
        remarks.append(f"the file says {n_frames} frames and has spots in {least}: {least} are taken")
        n_frames = least
    return OutlineSet(outlines, tuple(remarks), spots.image_shape, n_frames, spots.scale)
