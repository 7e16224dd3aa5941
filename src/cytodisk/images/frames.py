"""Read microscope images and masks frame by frame, with the scale their metadata gives."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import xarray as xr

from cytodisk.checks import is_path, one_of
from cytodisk.errors import ReadError
from cytodisk.images.choice_use import check_choice
from cytodisk.images.chosen_channels import with_channels, with_names
from cytodisk.images.claims import check_memory
from cytodisk.images.file_axes import axes_named
from cytodisk.images.file_kind import image_kind
from cytodisk.images.file_parameters import SignalFileParameters
from cytodisk.images.formats.array_file import open_array
from cytodisk.images.formats.microscope.czi_file import open_czi
from cytodisk.images.formats.microscope.lif_file import open_lif
from cytodisk.images.formats.microscope.nd2_file import open_nd2
from cytodisk.images.formats.microscope.zarr_file import open_zarr
from cytodisk.images.formats.outlined.geojson_file import open_geojson
from cytodisk.images.formats.outlined.roi_file import open_rois
from cytodisk.images.formats.outlined.trackmate_outlines import open_trackmate
from cytodisk.images.formats.picture_file import open_picture
from cytodisk.images.formats.tiff_file import open_tiff
from cytodisk.images.frame_file import NO_CHOICE, FileChoice, FrameFile
from cytodisk.images.image_paths import is_folder_of_files, is_zarr, path_advice
from cytodisk.images.reading import reading

_OPENERS = {
    ".tif": open_tiff,
    ".tiff": open_tiff,
    ".png": open_picture,
    ".npy": open_array,
    ".nd2": open_nd2,
    ".czi": open_czi,
    ".lif": open_lif,
    ".zarr": open_zarr,
    ".roi": open_rois,
    ".zip": open_rois,
    ".geojson": open_geojson,
    ".json": open_geojson,
    ".xml": open_trackmate,
}


def open_frames(
    path: str | os.PathLike[str],
    *,
    unnamed: str = "T",
    choice: FileChoice = NO_CHOICE,
    flag: str = "--signal-channels",
) -> FrameFile:
    """Look at an image file without reading its pixels.

    Parameters
    ----------
    path : path-like
        TIFF, OME-TIFF, ImageJ TIFF, PNG, OME-Zarr, ND2, CZI, LIF, or an array saved by NumPy (Cellpose's
        `_seg.npy`: its masks).
    unnamed : {"T", "C"}
        What an axis without a name in the file is: frames or channels.
    choice : FileChoice, optional
        Axes, scene, slice and channels, where the file leaves a choice.
    flag : str
        What a user passes to choose channels, for messages.

    Returns
    -------
    FrameFile
        With a name for each channel.

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
        raise ReadError(f"{file} does not exist: {path_advice(file)}") from error
    except OSError as error:
        raise ReadError(f"{file} cannot be read: {error.strerror}") from error
    if is_folder_of_files(file):
        raise ReadError(f"{file} is a folder: pass one image file")
    try:
        with reading(file, "its header"):
            found = with_names(_opened(file, unnamed, replace(choice, channels=None)))
    except ReadError as error:
        raise ReadError(axes_named(str(error), flag)) from error
    found = replace(found, doubt=axes_named(found.doubt, flag))
    return found if choice.channels is None else with_channels(found, choice.channels, flag)


def _opened(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    suffix = ".zarr" if is_zarr(file) else image_kind(file) or file.suffix.lower()
    if suffix not in _OPENERS:
        raise ReadError(f"{file} is no image that can be read ({', '.join(_OPENERS)}): convert it to TIFF")
    found = _OPENERS[suffix](file, unnamed, choice)
    if min(found.shape) < 1:
        words = " × ".join(map(str, found.shape))
        raise ReadError(f"{file} holds no pixels: its shape is {words} ({found.axes}); save it anew")
    return found


def read_image(
    path: str | os.PathLike[str],
    *,
    unnamed: str = "C",
    axes: str | None = None,
    scene: str | int | None = None,
    z: str | int | None = None,
    channels: Sequence[str | int] | None = None,
) -> xr.DataArray:
    """Read a whole image with its scale.

    Parameters
    ----------
    path : path-like
        TIFF, OME-TIFF, ImageJ TIFF, PNG, OME-Zarr, ND2, CZI, LIF, or an array saved by NumPy (Cellpose's
        `_seg.npy`: its masks).
    unnamed : {"C", "T"}
        What an axis without a name in the file is: channels or frames.
    axes : str, optional
        One letter an axis, such as "TCYX"; overrules what the file says.
    scene : str or int, optional
        Name, or number from 0, of a scene (position, series) of a file that holds several.
    z : str or int, optional
        Number from 0 of a slice of a z-stack; or "max" or "mean", for a projection.
    channels : sequence of (str or int), optional
        Names, or numbers from 0, of the channels to take, in this order.

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
        `path` is no path, or `unnamed` or another argument cannot be used.

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
    wanted = None if channels is None else tuple(map(str, channels))
    given = {"signal_axes": axes, "scene": scene, "z": z, "signal_channels": wanted}
    choice = SignalFileParameters.called(given, {"signal_axes": "axes", "signal_channels": "channels"})
    file = open_frames(path, unnamed=unnamed, choice=choice.signal_choice, flag="channels")
    if file.doubt:
        raise ReadError(file.doubt)
    check_choice([file], choice.scene, choice.z, flags="")
    shape = (file.n_frames, len(file.channels) if "C" in file.axes else 1, *file.image_shape)
    check_memory(
        file.path, "the whole movie", math.prod(shape) * file.dtype.itemsize, "read it frame by frame"
    )
    stack = np.empty(shape, file.dtype.newbyteorder("="))
    for number in range(file.n_frames):
        stack[number] = file.frame(number)
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
    return image.isel(channel=0, drop=file.unnamed)
