"""Read microscope images and masks frame by frame, with the scale their metadata gives."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np
import xarray as xr

from cytodisk.checks import is_path, one_of
from cytodisk.errors import ReadError
from cytodisk.images.metadata import channel_names, imagej_scale, named_axes, ome_metadata
from cytodisk.images.npy import read_npy
from cytodisk.images.tiff_pages import opened_tiff, whole_tiff
from cytodisk.scale import UNKNOWN, Scale

_TIFF = (".tif", ".tiff")
_PICTURES = (".png",)
_ARRAYS = (".npy",)
_PNG: dict[str, Any] = {"extension": ".png", "plugin": "pillow"}


@dataclass(frozen=True)
class FrameFile:
    """An image file as a sequence of frames, each (channel, y, x).

    Attributes
    ----------
    path : Path
    axes : str
        Axes of the file as understood, one letter each: T frames, C channels, Y, X.
    shape : tuple of int
        Along `axes`.
    dtype : numpy.dtype
    channels : tuple of str
        Names, or "0", "1", … when the file gives none.
    scale : Scale
        What the metadata says of it.
    """

    path: Path
    axes: str
    shape: tuple[int, ...]
    dtype: np.dtype[Any]
    channels: tuple[str, ...]
    scale: Scale = UNKNOWN

    @property
    def n_frames(self) -> int:
        """Frames in the file, 1 for a single image."""
        return self.shape[self.axes.index("T")] if "T" in self.axes else 1

    @property
    def image_shape(self) -> tuple[int, int]:
        """(H, W) of a frame."""
        return self.shape[self.axes.index("Y")], self.shape[self.axes.index("X")]

    def frame(self, number: int) -> np.ndarray[Any, Any]:
        """Read one frame.

        Parameters
        ----------
        number : int
            From 0.

        Returns
        -------
        ndarray of shape (C, H, W)

        Raises
        ------
        ReadError
            This frame of the file is damaged.
        """
        with reading(self.path, f"frame {number}"):
            if self.path.suffix.lower() in _PICTURES:
                with self.path.open("rb") as opened:
                    array = np.asarray(imageio.imread(opened, **_PNG))
            elif self.path.suffix.lower() in _ARRAYS:
                whole = read_npy(self.path)
                array = np.array(whole[number] if "T" in self.axes else whole)
            else:
                array = self._tiff_frame(number)
        rest = [axis for axis in self.axes if axis != "T"]
        order = [rest.index(axis) for axis in "CYX" if axis in rest]
        moved = array.transpose(order)
        return moved if "C" in rest else moved[None]

    def _tiff_frame(self, number: int) -> np.ndarray[Any, Any]:
        without = tuple(size for axis, size in zip(self.axes, self.shape, strict=True) if axis != "T")
        with opened_tiff(self.path) as tiff:
            pages = len(tiff.series[0].pages) // self.n_frames
            if self.axes[0] == "T" and pages > 0 and pages * self.n_frames == len(tiff.series[0].pages):
                keys = list(range(number * pages, (number + 1) * pages))
                return np.asarray(tiff.asarray(series=0, key=keys)).reshape(without)
            whole = np.asarray(tiff.series[0].asarray()).reshape(self.shape)
        return whole.take(number, axis=self.axes.index("T")) if "T" in self.axes else whole


def open_frames(path: str | os.PathLike[str], *, unnamed: str = "T") -> FrameFile:
    """Look at an image file without reading its pixels.

    Parameters
    ----------
    path : path-like
        TIFF, OME-TIFF, ImageJ TIFF, PNG, or an array saved by NumPy (Cellpose's `_seg.npy`: its masks).
    unnamed : {"T", "C"}
        What an axis without a name in the file is: frames or channels.

    Returns
    -------
    FrameFile

    Raises
    ------
    ReadError
        The file is missing, is not an image, is damaged, or has axes that cannot be used (a z-stack).
    ParameterError
        `path` is no path, or `unnamed` is unknown.
    """
    is_path("path", path)
    one_of("unnamed", unnamed, ("T", "C"))
    file = Path(path)
    try:
        file.stat()
    except FileNotFoundError as error:
        if file.is_symlink():
            raise ReadError(f"{file} is a link to a file that is not there: {file.readlink()}") from error
        raise ReadError(f"{file} does not exist: check the path") from error
    except OSError as error:
        raise ReadError(f"{file} cannot be read: {error.strerror}") from error
    if file.is_dir():
        raise ReadError(f"{file} is a folder: pass one image file")
    suffix = file.suffix.lower()
    known = _TIFF + _PICTURES + _ARRAYS
    if suffix not in known:
        raise ReadError(f"{file} is no image that can be read ({', '.join(known)}): convert it to TIFF")
    with reading(file, "its header"):
        if suffix in _ARRAYS:
            return _open_array(file, unnamed)
        return _open_tiff(file, unnamed) if suffix in _TIFF else _open_picture(file)


def read_image(path: str | os.PathLike[str], *, unnamed: str = "C") -> xr.DataArray:
    """Read a whole image with its scale.

    Parameters
    ----------
    path : path-like
        TIFF, OME-TIFF, ImageJ TIFF, PNG, or an array saved by NumPy (Cellpose's `_seg.npy`: its masks).
    unnamed : {"C", "T"}
        What an axis without a name in the file is: channels or frames.

    Returns
    -------
    DataArray with dims out of (time, channel, y, x)
        attrs: pixel_size_um and frame_interval_s, None when the file does not say. Channel names are the
        coordinate of `channel`.

    Raises
    ------
    ReadError
        The file is missing, is not an image, is damaged, or has axes that cannot be used.
    ParameterError
        `path` is no path, or `unnamed` is unknown.

    See Also
    --------
    open_study : Read what a run wrote.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("still", frames=2, radius_px=10.0)
    >>> metadata = {"axes": "TYX", "PhysicalSizeX": 0.16, "PhysicalSizeY": 0.16}
    >>> tifffile.imwrite("masks.ome.tif", truth.masks.astype("uint8"), metadata=metadata)
    >>> masks = cd.read_image("masks.ome.tif")
    >>> masks.dims, masks.attrs["pixel_size_um"]
    (('time', 'y', 'x'), 0.16)
    """
    file = open_frames(path, unnamed=unnamed)
    stack = np.stack([file.frame(number) for number in range(file.n_frames)])
    image = xr.DataArray(
        stack,
        dims=("time", "channel", "y", "x"),
        coords={"channel": list(file.channels)},
        attrs=asdict(file.scale),
    )
    if "T" not in file.axes:
        image = image.isel(time=0)
    if "C" in file.axes:
        return image
    return image.isel(channel=0, drop=file.channels == ("0",))


@contextmanager
def reading(path: Path, part: str) -> Iterator[None]:
    """Turn whatever a decoder raises on a damaged file into a `ReadError` that names the place."""
    try:
        yield
    except ReadError:
        raise
    except MemoryError as error:
        raise ReadError(
            f"{path}: {part} asks for more memory than there is: the file is too large, or damaged"
        ) from error
    except Exception as error:
        words = " ".join(str(error).split())  # on one line, as tables of reasons need it
        raise ReadError(f"{path}: {part} cannot be read as an image ({words})") from error


def _open_tiff(file: Path, unnamed: str) -> FrameFile:
    with whole_tiff(file) as tiff:
        if len(tiff.series) > 1:
            raise ReadError(
                f"{file} holds {len(tiff.series)} separate images: save one alone, or all as one stack"
            )
        series = tiff.series[0]
        axes, shape = named_axes(file, series.axes, series.shape, unnamed)
        names: tuple[str, ...] = ()
        scale = UNKNOWN
        if tiff.is_ome and tiff.ome_metadata:
            scale, names = ome_metadata(file, tiff.ome_metadata)
        elif tiff.is_imagej and tiff.imagej_metadata:
            scale = imagej_scale(file, tiff)
    channels = channel_names(names, shape[axes.index("C")] if "C" in axes else 1)
    return FrameFile(file, axes, shape, np.dtype(series.dtype), channels, scale)


def _open_picture(file: Path) -> FrameFile:
    with file.open("rb") as opened:  # imageio leaves a damaged file open when it opens it itself
        properties = imageio.improps(opened, **_PNG)
    shape = tuple(properties.shape)
    if len(shape) == 2:
        return FrameFile(file, "YX", shape, properties.dtype, ("0",))
    names = {3: ("red", "green", "blue"), 4: ("red", "green", "blue", "alpha"), 2: ("grey", "alpha")}
    return FrameFile(file, "YXC", shape, properties.dtype, names[shape[2]])


def _open_array(file: Path, unnamed: str) -> FrameFile:
    array = read_npy(file)
    if array.ndim not in (2, 3) or not array.size:
        raise ReadError(f"{file} has shape {array.shape}: save an array of shape (H, W) or (frames, H, W)")
    if array.dtype.kind not in "biuf":
        raise ReadError(f"{file} has dtype {array.dtype}: save an array of numbers, labels as uint16")
    if array.ndim == 3 and file.name.lower().endswith("_seg.npy"):
        raise ReadError(
            f"{file} holds the masks of a z-stack, shape {array.shape}: project it; or if these are frames, "
            "save the masks alone, as TIFF with axes TYX"
        )
    axes = "YX" if array.ndim == 2 else f"{unnamed}YX"
    channels = channel_names((), len(array) if axes == "CYX" else 1)
    return FrameFile(file, axes, array.shape, array.dtype, channels)
