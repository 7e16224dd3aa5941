"""Read microscope images and masks frame by frame, with the scale their metadata gives."""

from __future__ import annotations

import os
from dataclasses import asdict
from pathlib import Path

import numpy as np
import xarray as xr

from cytodisk.checks import is_path, one_of
from cytodisk.errors import ReadError
from cytodisk.images.formats.array_file import open_array
from cytodisk.images.formats.picture_file import open_picture
from cytodisk.images.formats.tiff_file import open_tiff
from cytodisk.images.frame_file import NO_CHOICE, FileChoice, FrameFile
from cytodisk.images.reading import reading

_OPENERS = {".tif": open_tiff, ".tiff": open_tiff, ".png": open_picture, ".npy": open_array}


def open_frames(
    path: str | os.PathLike[str], *, unnamed: str = "T", choice: FileChoice = NO_CHOICE
) -> FrameFile:
    """Look at an image file without reading its pixels.

    Parameters
    ----------
    path : path-like
        TIFF, OME-TIFF, ImageJ TIFF, PNG, or an array saved by NumPy (Cellpose's `_seg.npy`: its masks).
    unnamed : {"T", "C"}
        What an axis without a name in the file is: frames or channels.
    choice : FileChoice, optional
        Axes, scene, slice and channels, where the file leaves a choice.

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
    if suffix not in _OPENERS:
        raise ReadError(f"{file} is no image that can be read ({', '.join(_OPENERS)}): convert it to TIFF")
    with reading(file, "its header"):
        return _OPENERS[suffix](file, unnamed, choice)


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
