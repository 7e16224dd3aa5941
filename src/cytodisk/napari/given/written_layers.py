"""Layers written as TIFF, image by image, with the scale and the names of the channels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
import tifffile

from cytodisk.arrays import AnyArray
from cytodisk.errors import MaskError, SignalError
from cytodisk.napari.given.layer_axes import UNNAMED
from cytodisk.napari.given.layer_frames import LayerFrames
from cytodisk.scale import Scale

_LARGEST_PLAIN = 2**32 - 2**25  # bytes of a TIFF with 32-bit offsets
_WHOLE = 2**53  # up to which float64 holds all whole numbers


def write_masks(path: Path, frames: LayerFrames, scale: Scale, written: Callable[[], None]) -> None:
    """Write labels, or an image of 0 and 1, as a file of masks.

    Parameters
    ----------
    path : Path
    frames : LayerFrames
    scale : Scale
    written : callable
        Called after each image.

    Raises
    ------
    MaskError
        Labels are below 0, or too large.
    """
    kind = frames.dtype
    dtype = np.dtype(np.uint32) if kind.kind in "iu" and kind not in (np.uint8, np.uint16) else _stored(kind)
    _write(path, [frames], dtype, scale, (), written, "masks")


def write_signal(
    path: Path, channels: Sequence[LayerFrames], scale: Scale, written: Callable[[], None]
) -> None:
    """Write image layers as the channels of one file.

    Parameters
    ----------
    path : Path
    channels : sequence of LayerFrames
        Of one shape.
    scale : Scale
    written : callable
        Called after each image.

    Raises
    ------
    SignalError
        They differ in shape, or one of several has channels of its own.
    """
    first = channels[0]
    for other in channels[1:]:
        if (other.axes, other.shape) != (first.axes, first.shape) or "C" in first.axes:
            raise SignalError(
                f"signal: layer {first.layer.name} has axes {first.axes} {first.shape}, layer "
                f"{other.layer.name} has {other.axes} {other.shape}: choose layers of one "
                "shape, each a channel"
            )
    dtype = np.result_type(*(_stored(one.dtype) for one in channels))
    _write(path, channels, dtype, scale, [channel_name(one.layer) for one in channels], written, "signal")


def channel_name(layer: Any) -> str:
    """Name of a layer as that of a channel; commas part channels on the command line."""
    return " ".join(str(layer.name).replace(",", " ").split())


def _stored(kind: np.dtype[Any]) -> np.dtype[Any]:
    """A type that OME-TIFF has and that holds all values."""
    if kind.kind == "b":
        return np.dtype(np.uint8)
    if kind == np.float16:
        return np.dtype(np.float32)
    if kind.kind in "iu" and kind.itemsize == 8:
        return np.dtype(np.float64)
    return kind.newbyteorder("=")


def _write(
    path: Path,
    layers: Sequence[LayerFrames],
    dtype: np.dtype[Any],
    scale: Scale,
    names: Sequence[str],
    written: Callable[[], None],
    role: Literal["masks", "signal"],
) -> None:
    first = layers[0]
    axes, shape = first.axes, first.shape
    if len(layers) > 1:
        axes, shape = f"{axes[:-2]}CYX", (*shape[:-2], len(layers), *shape[-2:])
    named = UNNAMED not in axes
    size = int(np.prod(shape, dtype=np.int64)) * dtype.itemsize
    with tifffile.TiffWriter(path, bigtiff=size > _LARGEST_PLAIN, ome=named, shaped=not named) as file:
        file.write(
            _images(layers, dtype, written, role),
            shape=shape,
            dtype=dtype,
            photometric="minisblack",
            compression="zlib",
            metadata=_metadata(axes, shape, scale, names) if named else {"axes": axes},
        )


def _metadata(axes: str, shape: tuple[int, ...], scale: Scale, names: Sequence[str]) -> dict[str, Any]:
    said: dict[str, Any] = {"axes": axes}
    if names and len(names) == dict(zip(axes, shape, strict=True)).get("C", 1):
        said["Channel"] = {"Name": list(names)}
    if scale.pixel_size_um is not None:
        said |= {f"PhysicalSize{axis}": scale.pixel_size_um for axis in "XY"}
        said |= {f"PhysicalSize{axis}Unit": "µm" for axis in "XY"}
    if scale.frame_interval_s is not None and "T" in axes:
        said |= {"TimeIncrement": scale.frame_interval_s, "TimeIncrementUnit": "s"}
    return said


def _images(
    layers: Sequence[LayerFrames], dtype: np.dtype[Any], written: Callable[[], None], role: str
) -> Iterator[AnyArray]:
    for number in range(layers[0].planes):
        for one in layers:
            yield _fitting(one, one.plane(number), dtype, role)
            written()


def _fitting(frames: LayerFrames, image: AnyArray, dtype: np.dtype[Any], role: str) -> AnyArray:
    """An image in the type that is written, in which no value changes."""
    whole = image.dtype.kind in "iu" and dtype != image.dtype
    if whole and role == "masks" and dtype.kind == "u" and (image.min() < 0 or image.max() >= 2**32):
        raise MaskError(
            f"masks: layer {frames.layer.name} has labels from {image.min()} to {image.max()}: number its "
            "cells anew, from 1"
        )
    if whole and dtype.kind == "f" and max(abs(int(image.min())), abs(int(image.max()))) > _WHOLE:
        raise SignalError(
            f"{role}: layer {frames.layer.name} has whole numbers above {_WHOLE}, which no image file holds: "
            "save it as 16 or 32 bit"
        )
    if image.dtype.kind not in "biuf":
        raise SignalError(f"{role}: layer {frames.layer.name} holds {image.dtype}, no image: choose another")
    return np.ascontiguousarray(image, dtype=dtype)
