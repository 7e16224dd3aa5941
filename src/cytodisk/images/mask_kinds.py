"""What a mask file holds: one mask, a stack of masks, or label images."""

from __future__ import annotations

from typing import Any

import numpy as np
from skimage import measure

from cytodisk.errors import MaskError, ReadError
from cytodisk.images.file_parameters import Kind, KindParameters
from cytodisk.images.frames import FrameFile

_LEAST_ALIKE = 0.5  # of neighbouring pixels within cells must have one label in a label image
_MOST_PIECES = 3  # connected pieces a label, on average, in a label image


def understood_as(file: FrameFile, kind: Kind = "auto") -> Kind:
    """What a mask file holds.

    Parameters
    ----------
    file : FrameFile
    kind : {"auto", "mask", "stack", "labels"}
        "auto" decides: labels if any readable frame holds two integers beside 0; else one mask or a stack.

    Returns
    -------
    {"mask", "stack", "labels"}

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
            "a mask has one value a pixel; save the mask alone, not as a colour picture"
        )
    if kind == "mask" and file.n_frames > 1:
        raise MaskError(
            f"{file.path} is a stack of {file.n_frames} frames where one image is needed: "
            "save the frame alone, or pass kind='stack'"
        )
    if kind != "auto":
        return kind
    labelled = _frames_with_labels(file)
    if labelled:
        _refuse_intensities(file, labelled[0])
        return "labels"
    return "stack" if file.n_frames > 1 else "mask"


def _refuse_intensities(file: FrameFile, number: int) -> None:
    frame = file.frame(number)[0]
    left, right = frame[:, :-1], frame[:, 1:]
    both = (left != 0) & (right != 0)
    alike = (left == right)[both].mean() if both.any() else 1.0
    values = len(np.unique(frame[frame != 0]))
    _, pieces = measure.label(  # type: ignore[no-untyped-call,unused-ignore]
        frame, background=0, connectivity=2, return_num=True
    )
    if alike < _LEAST_ALIKE or pieces > _MOST_PIECES * values:
        raise MaskError(
            f"{file.path} looks like a picture, not a mask or label image: "
            f"{values} values of frame {number} lie in "
            f"{pieces} pieces; threshold it, or pass kind='labels' (--kind labels) if it is one"
        )


def _frames_with_labels(file: FrameFile) -> list[int]:
    """Frames that hold more than one value; a damaged one is reported when the cells are read."""
    found, fault = [], None
    damaged = 0
    for number in range(file.n_frames):
        try:
            if _has_labels(file.frame(number)):
                found.append(number)
        except ReadError as error:
            fault, damaged = error, damaged + 1
    if fault is not None and damaged == file.n_frames:
        raise fault
    return found


def _has_labels(frame: np.ndarray[Any, Any]) -> bool:
    if not np.issubdtype(frame.dtype, np.integer):
        return False
    values = frame[frame != 0]
    return bool(values.size) and bool(values.min() != values.max())
