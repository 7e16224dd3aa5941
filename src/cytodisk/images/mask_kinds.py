"""What a mask file holds: one mask, a stack of masks, or label images."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, TypeAlias

import numpy as np

from cytodisk.errors import CytodiskError, MaskError, ReadError, as_data
from cytodisk.images.file_parameters import Kind, KindParameters
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.label_boxes import count_pieces, share_alike, values_of

_LEAST_ALIKE = 0.5  # of neighbouring pixels within cells must have one label in a label image
_LARGEST = int(np.iinfo(np.int64).max)  # tables hold labels as 64-bit integers with a sign
_MOST_PIECES = 3  # connected pieces a label, on average, in a label image

Reader: TypeAlias = Callable[[int], FramePixels]


@dataclass(frozen=True)
class MaskLook:
    """What one look at all frames of a mask file says.

    Attributes
    ----------
    kind : {"mask", "stack", "labels"}
    labels : tuple of (tuple of int, or CytodiskError)
        For label images, the labels of each frame; the fault of one that cannot be used. Else empty.
    """

    kind: Kind
    labels: tuple[tuple[int, ...] | CytodiskError, ...] = ()

    def cells_in(self, number: int) -> int:
        """How many rows a frame gives: one a cell; one, too, where it holds none, or has a fault."""
        if self.kind != "labels" or isinstance(found := self.labels[number], CytodiskError):
            return 1
        return max(1, len(found))


def understood_as(file: FrameFile, kind: Kind = "auto") -> Kind:
    """What a mask file holds; see `look_at`."""
    return look_at(file, kind).kind


def look_at(file: FrameFile, kind: Kind = "auto", read: Reader | None = None) -> MaskLook:
    """What a mask file holds; its frames are read once, unless `kind` says enough.

    Parameters
    ----------
    file : FrameFile
    kind : {"auto", "mask", "stack", "labels"}
        "auto" decides: labels if any readable frame holds two integers beside 0; else one mask or a stack.
    read : callable, optional
        Opens a frame in the place of `frame_pixels`, such as to keep what was read.

    Returns
    -------
    MaskLook

    Raises
    ------
    MaskError
        The file has channels, or is not what `kind` says.
    ReadError
        For "auto", no frame can be read.
    ParameterError
        An unknown kind.
    """
    KindParameters.of(kind=kind)
    if "C" in file.axes:
        raise MaskError(
            f"{file.path} has {len(file.channels)} channels ({', '.join(file.channels)}): "
            "a mask has one value a pixel; pass the channel that holds it, as --mask-channel 0, "
            "or save the mask alone, not as a colour picture"
        )
    if kind == "mask" and file.n_frames > 1:
        raise MaskError(
            f"{file.path} is a stack of {file.n_frames} frames where one image is needed: "
            "save the frame alone, or pass kind='stack'"
        )
    if kind in ("mask", "stack"):
        return MaskLook(kind)
    labels, several = _labels_of(file, read or partial(frame_pixels, file), pictures_refused=kind == "auto")
    if kind == "labels" or several:
        return MaskLook("labels", labels)
    damaged = [found for found in labels if isinstance(found, ReadError)]
    if len(damaged) == file.n_frames:
        raise damaged[-1]
    return MaskLook("stack" if file.n_frames > 1 else "mask")


def _labels_of(
    file: FrameFile, read: Reader, pictures_refused: bool
) -> tuple[tuple[tuple[int, ...] | CytodiskError, ...], bool]:
    """Labels of each frame, or its fault; and whether any frame holds several values beside 0."""
    found: list[tuple[int, ...] | CytodiskError] = []
    several = False
    for number in range(file.n_frames):
        try:
            frame = read(number)
            values = values_of(frame.strips()) if np.issubdtype(frame.dtype, np.integer) else None
        except ReadError as fault:
            found.append(as_data(fault))
            continue
        if values is not None and (values != 0).sum() > 1:
            if pictures_refused and not several:
                _refuse_intensities(file, number, frame, int((values != 0).sum()))
            several = True
        try:
            check_labels(frame.dtype, values, number)
            found.append(tuple(values[values != 0].tolist()) if values is not None else ())
        except MaskError as fault:
            found.append(fault)
    return tuple(found), several


def check_labels(dtype: Any, values: Any, number: int) -> None:
    """Raise MaskError unless a frame has labels; `values` are some of it that hold the least and greatest."""
    if values is None or not np.issubdtype(dtype, np.integer):
        raise MaskError(f"labels must be whole numbers, got dtype {dtype}: save the labels as uint16")
    if values.min() < 0:
        raise MaskError(
            f"frame {number} has negative labels (down to {values.min()}): set what is no cell to 0"
        )
    if int(values.max()) > _LARGEST:
        raise MaskError(f"frame {number} has labels up to {values.max()}: number the cells from 1")


def _refuse_intensities(file: FrameFile, number: int, frame: FramePixels, values: int) -> None:
    alike, pieces = share_alike(frame.strips()), count_pieces(frame.strips())
    if alike < _LEAST_ALIKE or pieces > _MOST_PIECES * values:
        raise MaskError(
            f"{file.path} looks like a picture, not a mask or label image: "
            f"{values} values of frame {number} lie in "
            f"{pieces} pieces; threshold it, or pass kind='labels' (--kind labels) if it is one"
        )
