"""The file that a layer was opened from, and whether it still holds the layer's pixels."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import AnyArray
from cytodisk.errors import ReadError
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.frames import open_frames
from cytodisk.napari.given.layer_axes import UNNAMED
from cytodisk.napari.given.layer_frames import LayerFrames, frame_of


def source_file(layer: Any, frames: LayerFrames, choice: FileChoice) -> FrameFile | None:
    """The file that a layer was opened from.

    Parameters
    ----------
    layer : napari.layers.Layer
    frames : LayerFrames
        Its pixels.
    choice : FileChoice
        What the user says of the file.

    Returns
    -------
    FrameFile or None
        None where there is no file any more, or where the layer says itself what it is.

    Raises
    ------
    ReadError
        The file is refused, as a z-stack is, and the layer has no names for its axes: nothing says that
        they are others than the file's.
    """
    path = layer.source.path
    if path is None or not Path(path).exists():
        return None
    try:
        return open_frames(Path(path), choice=FileChoice(choice.axes, choice.scene, choice.z))
    except ReadError as error:
        if UNNAMED not in frames.axes:
            return None
        raise ReadError(
            f"layer {layer.name}: {error}; or name the axes of the layer (axis_labels, such as "
            f"{', '.join('tzyx'[-len(frames.axes) :])})"
        ) from error


def same_pixels(
    frames: LayerFrames, file: FrameFile, looked: Callable[[], None] | None = None
) -> tuple[int, ...] | None:
    """Channels of a file whose pixels are those of a layer.

    Parameters
    ----------
    frames : LayerFrames
    file : FrameFile
    looked : callable, optional
        Called after each frame.

    Returns
    -------
    tuple of int, or None
        All of them, or the one that the layer shows; None where the pixels differ in any frame.
    """
    axes = frames.axes
    size_of = dict(zip(axes, frames.shape, strict=True))
    count = size_of.get("T", size_of.get(UNNAMED, 1))
    if "Z" in axes or axes.count(UNNAMED) > 1 or ("T" in axes and UNNAMED in axes):
        return None
    if count != file.n_frames or frames.shape[-2:] != file.image_shape:
        return None
    all_channels = tuple(range(len(file.channels)))
    known: tuple[int, ...] | None = None
    for number in range(count):
        here, there = frame_of(frames, number), file.frame(number)
        if known is None:
            known = _channels(here, there, all_channels)
        elif not _equal(here, there[list(known)]):
            known = None
        if known is None:
            return None
        if looked is not None:
            looked()
    return known


def _channels(here: AnyArray, there: AnyArray, every: tuple[int, ...]) -> tuple[int, ...] | None:
    if len(here) == len(there) == len(every):
        return every if _equal(here, there) else None
    return next(((k,) for k in range(len(there)) if _equal(here, there[k : k + 1])), None)


def _equal(one: AnyArray, other: AnyArray) -> bool:
    floats = one.dtype.kind == "f" and other.dtype.kind == "f"
    return one.shape == other.shape and bool(np.array_equal(one, other, equal_nan=floats))
