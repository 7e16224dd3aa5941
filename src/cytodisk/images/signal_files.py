"""Images of a signal: which one belongs to which mask file, and the image of a frame."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray as xr

from cytodisk.errors import CytodiskError, ReadError, as_data
from cytodisk.files import real_path
from cytodisk.images.chosen_channels import stem_of
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.image_paths import is_folder_of_files
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.mask_names import image_stem
from cytodisk.images.paired_files import IMAGES, pair_files
from cytodisk.scale import Scale


class FrameSource(Protocol):
    """A movie that gives a frame at a time, as `cytodisk.images.frames.open_frames` returns it."""

    @property
    def n_frames(self) -> int:
        """Number of frames."""
        ...

    @property
    def image_shape(self) -> tuple[int, int]:
        """(H, W) of a frame, in pixels."""
        ...

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of the channels."""
        ...

    def frame(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        ...


def load_image(file: FrameSource | None, frame: int) -> xr.DataArray | ReadError | None:
    """The image of a frame of the masks.

    Parameters
    ----------
    file : FrameSource or None
        None where there is no signal. A single image goes with all frames of the masks.
    frame : int
        Of the masks.

    Returns
    -------
    DataArray with dims (channel, y, x), ReadError or None
        With the channels' names, and the scale in attrs. The error of a damaged frame, as data.
    """
    if file is None:
        return None
    try:
        values = file.frame(min(frame, file.n_frames - 1))
    except ReadError as error:
        return as_data(error)
    return _named(values, file.channels, Scale.of(file))


def _named(values: np.ndarray[Any, Any], channels: Sequence[str], scale: Scale) -> xr.DataArray:
    return xr.DataArray(values, {"channel": list(channels)}, ("channel", "y", "x"), attrs=scale.attrs)


@dataclass(frozen=True, eq=False)
class SignalPiece:
    """Some rows and columns of an image; a DataArray takes longer to make than to measure.

    Attributes
    ----------
    values : ndarray of shape (C, h, w)
    channels : tuple of str
    scale : Scale
    """

    values: np.ndarray[Any, Any]
    channels: tuple[str, ...]
    scale: Scale

    @property
    def named(self) -> xr.DataArray:
        """The same with dims (channel, y, x)."""
        return _named(self.values, self.channels, self.scale)


@dataclass(frozen=True, eq=False)
class SignalFrame:
    """The image of a frame of the masks, read by piece.

    Attributes
    ----------
    pixels : FramePixels
    channels : tuple of str
    scale : Scale
    """

    pixels: FramePixels
    channels: tuple[str, ...]
    scale: Scale

    def cut(self, rows: slice, columns: slice) -> SignalPiece:
        """A piece of it with pixels of its own; raises ReadError where it is damaged."""
        return SignalPiece(self.pixels.cut(rows, columns).copy(), self.channels, self.scale)


def open_image(file: FrameFile | None, frame: int) -> SignalFrame | ReadError | None:
    """As `load_image`, for reading by piece."""
    if file is None:
        return None
    try:
        pixels = frame_pixels(file, min(frame, file.n_frames - 1))
    except ReadError as error:
        return as_data(error)
    return SignalFrame(pixels, file.channels, Scale.of(file))


def pair_images(
    sources: Sequence[MaskSource], signal: str | os.PathLike[str]
) -> tuple[Path | CytodiskError, ...]:
    """Find the image of each mask file of a folder, by its name.

    Parameters
    ----------
    sources : sequence of MaskSource
        As `open_mask_files` finds them in a folder.
    signal : path-like
        A folder, where `a.tif` or `a_img.tif` (TIFF or PNG) belongs to `a_masks.tif`; or how the names of the
        images go on, as "_img" or "_w1.tif", with the folder in front if it is another than that of the
        masks; or the same as a pattern, "images/*_w1.tif".

    Returns
    -------
    tuple of (Path or CytodiskError)
        By mask file; the error says that there is no image, or more than one.

    Raises
    ------
    ReadError
        There is no such folder.
    SignalError
        `signal` is a single file, or no mask file has an image.
    """
    return pair_files(sources, signal, IMAGES)


def common_name(signal: Path) -> str:
    """A name for the channel of images: "VASP" of the folder VASP, "w1" of "_w1.tif", "signal" of ".tif".

    Parameters
    ----------
    signal : Path
        As `pair_images` takes it.
    """
    if is_folder_of_files(signal):
        return real_path(signal).name
    ending = signal.name.lstrip("*")
    return stem_of(image_stem(ending) and ending).strip(" _-.") or "signal"
