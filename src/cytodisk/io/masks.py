"""Mask files → the cells in them: one mask, a stack of masks, or label images."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
from skimage import measure

from cytodisk.arrays import BoolArray
from cytodisk.errors import CytodiskError, MaskError, ParameterError, ReadError
from cytodisk.io.frames import FrameFile

Kind: TypeAlias = Literal["auto", "mask", "stack", "labels"]
_LEAST_ALIKE = 0.5  # of neighbouring pixels within cells must have one label in a label image
_MOST_PIECES = 3  # connected pieces a label, on average, in a label image
KINDS: tuple[Kind, ...] = ("auto", "mask", "stack", "labels")


@dataclass(frozen=True)
class CellMask:
    """One cell of a mask file, or the reason why there is none.

    Attributes
    ----------
    cell : int
        Running number in the file.
    frame : int
    label : int
        Its label in a label image, otherwise 1.
    mask : ndarray of shape (H, W), or None
        The pixels as they stand in the file for a mask; boolean for a label.
    fault : CytodiskError or None
    """

    cell: int
    frame: int
    label: int
    mask: np.ndarray[Any, Any] | None
    fault: CytodiskError | None = None


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
    ParameterError
        An unknown kind.
    """
    if kind not in KINDS:
        raise ParameterError(f"kind must be one of {', '.join(KINDS)}, got {kind!r}")
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
    labelled = [number for number in range(file.n_frames) if _has_labels(file, number)]
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


def read_cells(file: FrameFile, kind: Kind) -> Iterator[CellMask]:
    """The cells of a mask file, frame by frame; a damaged frame comes as a cell with its fault.

    Parameters
    ----------
    file : FrameFile
    kind : {"mask", "stack", "labels"}
        As `understood_as` returns it.

    Yields
    ------
    CellMask
    """
    cell = 0
    for number in range(file.n_frames):
        for found in _cells_of_frame(file, number, kind):
            yield CellMask(cell, number, found.label, found.mask, found.fault)
            cell += 1


def _cells_of_frame(file: FrameFile, number: int, kind: Kind) -> Iterator[CellMask]:
    try:
        frame = file.frame(number)[0]
    except ReadError as error:
        yield CellMask(0, number, 0, None, error)
        return
    if kind != "labels":
        yield CellMask(0, number, _single_label(frame), frame)
        return
    if not np.issubdtype(frame.dtype, np.integer):
        fault = MaskError(f"labels must be whole numbers, got dtype {frame.dtype}: save the labels as uint16")
        yield CellMask(0, number, 0, None, fault)
        return
    labels = np.unique(frame)
    if labels[0] < 0:
        fault = MaskError(
            f"frame {number} has negative labels (down to {labels[0]}): set what is no cell to 0"
        )
        yield CellMask(0, number, 0, None, fault)
        return
    if not (labels != 0).any():
        yield CellMask(0, number, 0, None, MaskError(f"frame {number} is empty: it holds no label"))
    for label in labels[labels != 0]:
        inside: BoolArray = frame == label
        yield CellMask(0, number, int(label), inside)


def _single_label(frame: np.ndarray[Any, Any]) -> int:
    """The label of a frame that holds just one; 1 for plain masks such as 0/1 and 0/255."""
    if not np.issubdtype(frame.dtype, np.integer):
        return 1
    label = int(frame.max(initial=0))
    return 1 if label in (0, np.iinfo(frame.dtype).max) else label


def _has_labels(file: FrameFile, number: int) -> bool:
    try:
        frame = file.frame(number)
    except ReadError:
        return False  # reported as a cell with its fault when the cells are read
    if not np.issubdtype(frame.dtype, np.integer):
        return False
    values = frame[frame != 0]
    return bool(values.size) and bool(values.min() != values.max())
