"""The pixels of a layer frame by frame, whatever its array: NumPy, Dask, Zarr, a pyramid."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cytodisk.arrays import AnyArray
from cytodisk.errors import ReadError
from cytodisk.images.frame_file import FrameFile
from cytodisk.napari.given.layer_axes import UNNAMED, layer_axes, without_single
from cytodisk.napari.given.layer_kinds import is_picture, pixels_of


@dataclass(frozen=True, eq=False)
class LayerFrames:
    """The pixels of a layer.

    Attributes
    ----------
    layer : napari.layers.Layer
    data : array-like
        Of a pyramid its highest level.
    letters : str
        Of all axes of `data`: T, C, Z, Y, X, Q (without a name).
    """

    layer: Any
    data: Any
    letters: str

    @property
    def axes(self) -> str:
        """Letters without axes of length 1, Y and X last."""
        long, _ = without_single(self.letters, self.data.shape)
        return "".join(one for one in long if one not in "YX") + "YX"

    @property
    def shape(self) -> tuple[int, ...]:
        """Along `axes`."""
        long, sizes = without_single(self.letters, self.data.shape)
        size_of = list(zip(long, sizes, strict=True))
        lead = [size for one, size in size_of if one not in "YX"]
        return (*lead, dict(size_of)["Y"], dict(size_of)["X"])

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of the pixels."""
        dtype: np.dtype[Any] = np.dtype(self.data.dtype)
        return dtype

    @property
    def planes(self) -> int:
        """How many images (Y, X) it holds."""
        return int(np.prod(self.shape[:-2], dtype=np.int64))

    def plane(self, number: int) -> AnyArray:
        """One image (Y, X), counted along the leading axes in their order."""
        return self._cut(np.unravel_index(number, self.shape[:-2]) if self.shape[:-2] else ())

    def _cut(self, places: tuple[Any, ...]) -> AnyArray:
        long, _ = without_single(self.letters, self.data.shape)
        given = iter(places)
        index: list[Any] = []
        for letter, size in zip(self.letters, self.data.shape, strict=True):
            if letter in "YX":
                index.append(slice(None))
            else:
                index.append(int(next(given)) if size > 1 else 0)
        image = np.asarray(self.data[tuple(index)])
        return image if long.index("Y") < long.index("X") else image.T


def frames_of(layer: Any, letters: str | None = None) -> LayerFrames:
    """The pixels of a layer.

    Parameters
    ----------
    layer : napari.layers.Layer
        Labels or an image.
    letters : str, optional
        Of its axes, as the user says; axes of length 1 may be left out.

    Returns
    -------
    LayerFrames

    Raises
    ------
    ReadError
        The layer is a picture of colours, holds no pixels, or has other axes than said.
    """
    if is_picture(layer):
        raise ReadError(
            f"layer {layer.name} is a picture of colours (RGB), which measure nothing: split it into "
            "channels (right click on the layer, Split RGB), and choose those, or open the raw image"
        )
    data = pixels_of(layer)
    if min(data.shape) < 1:
        raise ReadError(f"layer {layer.name} holds no pixels: its shape is {tuple(data.shape)}")
    return LayerFrames(
        layer, data, layer_axes(layer) if letters is None else _all_letters(layer, data, letters)
    )


def _all_letters(layer: Any, data: Any, letters: str) -> str:
    """The user's letters, with one for each axis of length 1 that he left out."""
    shape = tuple(map(int, data.shape))
    if len(letters) == len(shape):
        return letters
    if len(letters) == sum(size > 1 for size in shape):
        given = iter(letters)
        return "".join(next(given) if size > 1 else UNNAMED for size in shape)
    raise ReadError(
        f"layer {layer.name} has {len(shape)} axes of sizes {shape}, --axes {letters} names {len(letters)}: "
        "pass one letter an axis"
    )


def like_its_file(frames: LayerFrames, file: FrameFile) -> LayerFrames:
    """A layer whose axes have no names, with those of the file that it was opened from, if it has its shape.

    Parameters
    ----------
    frames : LayerFrames
    file : FrameFile
        Of a z-stack as it is read, by one slice or projected: the layer's axis that is left is Z.
    """
    shape = tuple(map(int, frames.data.shape))
    long = [k for k, size in enumerate(shape) if size > 1 or frames.letters[k] in "YX"]
    sizes, named = tuple(shape[k] for k in long), file.axes
    if UNNAMED not in frames.axes or file.said_by == "nobody":
        return frames
    if "z" in file.offers and len(sizes) == len(file.shape) + 1:
        fits = [k for k in range(len(sizes)) if sizes[:k] + sizes[k + 1 :] == file.shape]
        if len(fits) != 1:
            return frames
        named = f"{named[: fits[0]]}Z{named[fits[0] :]}"
    elif sizes != file.shape:
        return frames
    of_axis = dict(zip(long, named, strict=True))
    return replace(frames, letters="".join(of_axis.get(k, UNNAMED) for k in range(len(shape))))


def frame_of(frames: LayerFrames, number: int) -> AnyArray:
    """A frame as a `FrameFile` gives it, shape (C, Y, X); for axes out of one more (T, Q), C, Y and X."""
    channels = frames.axes.index("C") if "C" in frames.axes else None
    time = next((k for k, one in enumerate(frames.axes) if one in f"T{UNNAMED}"), None)
    lead = list(frames.shape[:-2])
    planes = []
    for channel in range(1 if channels is None else lead[channels]):
        place = [0] * len(lead)
        if channels is not None:
            place[channels] = channel
        if time is not None:
            place[time] = number
        planes.append(frames.plane(int(np.ravel_multi_index(place, lead)) if lead else 0))
    return np.stack(planes)
