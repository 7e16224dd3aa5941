"""Outlines → the frames of an image that they stand in, their labels, and the size of the image."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.formats.outlined.outline_set import (
    FrameOutlines,
    Outline,
    OutlineSet,
    PlacedOutlines,
    names_of,
)
from cytodisk.images.frame_file import FileChoice

_PIXELS_AT_LEAST, _PIXELS_AN_OUTLINE = 2**27, 2**20  # larger images, for so few outlines, are an error
_FRAMES_AT_LEAST, _FRAMES_AN_OUTLINE = 1000, 100  # more frames than that, for so few outlines, are an error


def place_outlines(path: Path, found: OutlineSet, choice: FileChoice) -> PlacedOutlines:
    """Decide in which frame each outline stands, its label, and how large the image is.

    Parameters
    ----------
    path : Path
        For messages.
    found : OutlineSet
    choice : FileChoice
        Its slice `z`, and `like`, the size of the image that goes with the file.

    Returns
    -------
    PlacedOutlines

    Raises
    ------
    ReadError
        No outline is left, slices must be chosen, or the image would be too large.
    """
    remarks = list(found.remarks)
    found = replace(found, outlines=_with_area(found.outlines, remarks))
    outlines, evidence = _frames_known(path, found, choice, remarks)
    shape, of_size = _image_shape(path, found, outlines, choice)
    n_frames = _n_frames(path, found, outlines, choice)
    outlines = _within(path, outlines, shape, n_frames, remarks)
    frames: dict[int, list[tuple[int, Outline]]] = {}
    for label, one in zip(_labels(outlines), outlines, strict=True):
        frames.setdefault(one.frame or 0, []).append((label, one))
    by_frame = {number: FrameOutlines(*zip(*held, strict=True)) for number, held in frames.items()}
    words = "; ".join(filter(None, [evidence, of_size]))
    return PlacedOutlines(by_frame, n_frames, shape, tuple(remarks), words)


def _with_area(outlines: Sequence[Outline], remarks: list[str]) -> tuple[Outline, ...]:
    """Outlines of three points at least."""
    rings = [tuple(ring for ring in one.rings if len(ring) > 2) for one in outlines]
    without = [one for one, left in zip(outlines, rings, strict=True) if not left]
    if without:
        remarks.append(f"{_count(without)} of fewer than three points left out ({names_of(without)})")
    return tuple(replace(one, rings=left) for one, left in zip(outlines, rings, strict=True) if left)


def _frames_known(
    path: Path, found: OutlineSet, choice: FileChoice, remarks: list[str]
) -> tuple[list[Outline], str]:
    """Outlines of the chosen slice, with their frames; and how these are known."""
    outlines = list(found.outlines)
    if choice.z is not None and choice.z not in ("max", "mean"):
        number = int(choice.z)
        left = [one for one in outlines if one.slice not in (None, number)]
        outlines = [one for one in outlines if one.slice in (None, number)]
        if not outlines:
            raise ReadError(f"{path} has no outline in slice {number}: {_slices_words(found.outlines)}")
        if left:
            remarks.append(f"{_count(left)} of other slices than {number} left out")
    frames, slices = {one.frame for one in outlines} - {None}, {one.slice for one in outlines} - {None}
    if len(slices) > 1 and choice.z is None:
        if len(frames) > 1:
            raise ReadError(
                f"{path} has outlines in {len(slices)} slices of {len(frames)} frames: choose a slice, "
                f"as --z {min(one for one in slices if one is not None)}"
            )
        outlines = [replace(one, frame=one.slice) for one in outlines]
        remarks.append(
            f"outlines stand on {len(slices)} slices and no frames: slices are taken as frames; if they are "
            "those of a z-stack, choose one, as --z 0"
        )
        return _all_in_frames(outlines, remarks), "frames by the slices of the outlines"
    if len(frames) > 1:
        return _all_in_frames(outlines, remarks), "frames by the positions of the outlines"
    if max(_frames_of_choice(choice), found.n_frames or 1) == 1:
        outlines = [replace(one, frame=None) for one in outlines]
    return outlines, ""


def _slices_words(outlines: Sequence[Outline]) -> str:
    slices = sorted({one.slice for one in outlines if one.slice is not None})
    return f"its outlines are in slices {', '.join(map(str, slices))}" if slices else "they have no slices"


def _all_in_frames(outlines: list[Outline], remarks: list[str]) -> list[Outline]:
    """Those that have a frame."""
    without = [one for one in outlines if one.frame is None]
    if without:
        remarks.append(
            f"{_count(without)} in no frame left out ({names_of(without)}): give the positions to use them"
        )
    return [one for one in outlines if one.frame is not None]


def _frames_of_choice(choice: FileChoice) -> int:
    return 1 if choice.like is None else choice.like[0]


def _n_frames(path: Path, found: OutlineSet, outlines: Sequence[Outline], choice: FileChoice) -> int:
    if choice.like is not None and choice.like[0] > 1:
        return choice.like[0]
    used = {one.frame for one in outlines if one.frame is not None}
    last = max(used) + 1 if len(used) > 1 else 1
    if last > _FRAMES_AT_LEAST + _FRAMES_AN_OUTLINE * len(outlines):
        raise ReadError(
            f"{path} has {len(outlines)} outlines in {last} frames: is that right? Then pass the image that "
            "goes with it (--signal), which says how many frames there are"
        )
    return max(last, found.n_frames or 1)


def _image_shape(
    path: Path, found: OutlineSet, outlines: Sequence[Outline], choice: FileChoice
) -> tuple[tuple[int, int], str]:
    """(H, W), and how it is known."""
    if choice.like is not None:
        return choice.like[1:], "size of the image that goes with it"
    if found.image_shape is not None:
        shape, evidence = found.image_shape, "size as the file says"
    else:
        if not outlines:
            raise ReadError(f"{path} holds no outline")
        corner = np.max([one.box[1] for one in outlines], axis=0)
        if max(corner) > _PIXELS_AT_LEAST:
            raise ReadError(f"{path} has outlines as far as {max(corner):g} px: {_SIZE_REMEDY}")
        height, width = np.maximum(np.floor(corner).astype(int) + 2, 1).tolist()
        shape, evidence = (height, width), "size of the image unknown: a box around the outlines"
    if shape[0] * shape[1] > max(_PIXELS_AT_LEAST, _PIXELS_AN_OUTLINE * len(outlines)):
        raise ReadError(f"{path}: an image of {shape[0]} × {shape[1]} pixels: {_SIZE_REMEDY}")
    return shape, evidence


_SIZE_REMEDY = "is that right? Then pass the image that goes with it (--signal), which says how large it is"


def _within(
    path: Path, outlines: list[Outline], shape: tuple[int, int], n_frames: int, remarks: list[str]
) -> list[Outline]:
    """Outlines that are in the image at least in part."""
    late = [one for one in outlines if (one.frame or 0) >= n_frames]
    if late:
        remarks.append(
            f"{_count(late)} after the last of {n_frames} frames left out ({names_of(late)}): "
            "does the image belong to this file?"
        )
    outlines = [one for one in outlines if (one.frame or 0) < n_frames]
    last = np.array(shape) - 0.5
    outside = [one for one in outlines if (one.box[1] <= -0.5).any() or (one.box[0] >= last).any()]
    if outside:
        remarks.append(
            f"{_count(outside)} outside of the image of {shape[0]} × {shape[1]} pixels left out "
            f"({names_of(outside)}): does the image belong to this file?"
        )
    gone = {id(one) for one in outside}
    kept = [one for one in outlines if id(one) not in gone]
    cut = [one for one in kept if (one.box[0] < -0.5).any() or (one.box[1] > last).any()]
    if cut:
        remarks.append(f"{_count(cut)} cut by the border of the image ({names_of(cut)})")
    if not kept:
        raise ReadError(f"{path}: no outline lies in the image: {'; '.join(remarks) or 'the file has none'}")
    return kept


def _labels(outlines: Sequence[Outline]) -> list[int]:
    """Those of tracks; or 1 for one outline a frame, the same cell; else numbers in the order of the file."""
    tracks = [one.track for one in outlines]
    if any(track is not None for track in tracks):
        following = count(max(track or 0 for track in tracks) + 1)
        return [next(following) if track is None else track for track in tracks]
    a_frame = Counter(one.frame for one in outlines)
    if len(a_frame) > 1 and max(a_frame.values()) == 1:
        return [1] * len(outlines)
    return list(range(1, len(outlines) + 1))


def _count(outlines: Sequence[Outline]) -> str:
    return "1 outline" if len(outlines) == 1 else f"{len(outlines)} outlines"
