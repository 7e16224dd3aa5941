"""Images of a signal: which one belongs to which mask file, and the image of a frame."""

from __future__ import annotations

import os
import shlex
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import xarray as xr

from cytodisk.errors import ReadError, SignalError, as_data
from cytodisk.files import real_path
from cytodisk.images.chosen_channels import stem_of
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.frame_pixels import FramePixels, frame_pixels
from cytodisk.images.image_paths import is_folder_of_files, is_pattern
from cytodisk.images.mask_files import MaskSource
from cytodisk.images.mask_names import base_name, image_stem, natural_order, visible_files
from cytodisk.scale import Scale

_USUAL_ENDINGS = ("", "_img")
_PIXELS = (".tif", ".tiff", ".png", ".nd2", ".czi", ".lif")
_STARTS_OF_ENDINGS = ("_", "-", ".")


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
) -> tuple[Path | SignalError, ...]:
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
    tuple of (Path or SignalError)
        By mask file; the error says that there is no image, or more than one.

    Raises
    ------
    ReadError
        There is no such folder.
    SignalError
        `signal` is a single file, or no mask file has an image.
    """
    folder, endings = _where(Path(signal), sources[0].path.parent)
    images: dict[str, list[Path]] = {}
    for file in visible_files(folder):
        for name in {file.name, image_stem(file.name)}:
            images.setdefault(name, []).append(file)
    found = tuple(_image_of(source, folder, images, endings) for source in sources)
    if all(isinstance(image, SignalError) for image in found):
        advice = _advice(sources, folder, images)
        raise SignalError(f"signal {signal} fits no mask file: {found[0]}{advice}")
    return found


def _advice(sources: Sequence[MaskSource], folder: Path, images: dict[str, list[Path]]) -> str:
    """What to type, or to rename, where no mask file has an image; empty where nothing fits."""
    masks, first = {source.path for source in sources}, base_name(sources[0].name)
    others = [file for files in images.values() for file in files if file not in masks]
    named = [file for file in images.get(first, []) if file not in masks]
    if named:
        return f", but {named[0].name} is: pass --signal {shlex.quote(str(folder))}"
    images_only = [
        file.name
        for file in others
        if file.suffix.lower() in _PIXELS and base_name(file.name) == image_stem(file.name)
    ]
    longer = [
        name for name in images_only if name.startswith(first) and name[len(first)] in _STARTS_OF_ENDINGS
    ]
    if longer:
        ending = Path(longer[0][len(first) :])
        place = ending if folder == sources[0].path.parent else folder / ending
        return f", but {longer[0]} is: pass --signal {shlex.quote(str(place))}"
    if not images_only:
        return ""
    return (
        f"; {min(images_only, key=natural_order)} and others are there: give the images the names of their "
        "masks, or if the files are the frames of one movie, use cytodisk movie"
    )


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


def _where(signal: Path, masks: Path) -> tuple[Path, tuple[str, ...]]:
    if is_folder_of_files(signal):
        return signal, _USUAL_ENDINGS
    if signal.exists():
        raise SignalError(
            f"signal {signal} is one file for a folder of masks: pass a folder of images with names as those "
            "of the masks, or how their names go on, as --signal _img"
        )
    if is_pattern(signal) and signal.name.startswith("*"):
        signal = signal.with_name(signal.name.lstrip("*") or "*")
    folder = masks if signal.parent == Path() else signal.parent
    if not signal.name.startswith(_STARTS_OF_ENDINGS) or not folder.is_dir():
        raise ReadError(
            f"signal {signal} does not exist: pass a folder of images, or how the names of images go on "
            "beside the masks, as --signal _img"
        )
    return folder, (signal.name,)


def _image_of(
    source: MaskSource, folder: Path, images: dict[str, list[Path]], endings: tuple[str, ...]
) -> Path | SignalError:
    names = [base_name(source.name) + ending for ending in endings]
    found = [file for name in names for file in images.get(name, []) if file != source.path]
    if len(found) == 1:
        return found[0]
    if found:
        several = ", ".join(file.name for file in found)
        return SignalError(
            f"{source.name} has several images in {folder} ({several}): "
            "pass how the names of the right ones go on, as --signal _img.tif"
        )
    looked_for = " or ".join(name if Path(name).suffix else f"{name}.tif" for name in names)
    return SignalError(f"{source.name} has no image in {folder}: {looked_for} (or .png) is not there")
