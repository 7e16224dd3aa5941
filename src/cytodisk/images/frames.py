"""Read microscope images and masks frame by frame, with the scale their metadata gives."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace
from functools import lru_cache
from pathlib import Path
from threading import get_ident
from typing import Any
from xml.etree import ElementTree

import imageio.v3 as imageio
import numpy as np
import tifffile
import xarray as xr

from cytodisk.errors import ReadError
from cytodisk.images.npy import read_npy
from cytodisk.scale import UNKNOWN, Scale

_TIFF = (".tif", ".tiff")
_PICTURES = (".png",)
_ARRAYS = (".npy",)
_PNG: dict[str, Any] = {"extension": ".png", "plugin": "pillow"}
_MICROMETRES = {
    "µm": 1.0,
    "um": 1.0,
    "micron": 1.0,
    "microns": 1.0,
    "nm": 1e-3,
    "mm": 1e3,
    "cm": 1e4,
    "m": 1e6,
}
_CUT_SHORT = re.compile("invalid (page|value) offset")
_TIFFS_KEPT = 4  # whose pages are known
_SECONDS = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}


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
        with _reading(self.path, f"frame {number}"):
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
        with _opened(self.path) as tiff:
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
    """
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
    with _reading(file, "its header"):
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
def _reading(path: Path, part: str) -> Iterator[None]:
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


@contextmanager
def _opened(path: Path) -> Iterator[tifffile.TiffFile]:
    """Open a TIFF whose pages may be known from the frame before."""
    state = path.stat()
    tiff = _with_pages(path, state.st_mtime_ns, state.st_size, get_ident())
    if tiff.series[0].is_multifile:  # whether its other files are as they were, this one does not say
        with tifffile.TiffFile(path) as anew:
            yield anew
        return
    tiff.filehandle.open()
    try:
        yield tiff
    finally:
        tiff.close()


@lru_cache(maxsize=_TIFFS_KEPT)
def _with_pages(path: Path, changed_ns: int, size: int, thread: int) -> tifffile.TiffFile:
    """A closed TIFF with the list of its pages, which takes longer to read than a frame of a long movie.

    Each thread has its own, as one that is done closes the file.
    """
    with tifffile.TiffFile(path) as tiff:
        len(tiff.series[0].pages)
        return tiff


@contextmanager
def _whole_tiff(file: Path) -> Iterator[tifffile.TiffFile]:
    """Open a TIFF, and raise if it is cut short, of which tifffile only logs that pages or tags are lost."""
    logged: list[str] = []
    watch = logging.Handler(logging.ERROR)
    watch.emit = lambda record: logged.append(record.getMessage())  # type: ignore[method-assign]
    log = logging.getLogger("tifffile")
    log.addHandler(watch)
    try:
        with tifffile.TiffFile(file) as tiff:
            pages = len(tiff.pages)
            lost = [message for message in logged if _CUT_SHORT.search(message)]
            if lost:
                raise ReadError(
                    f"{file}: the file is cut short after {pages} pages ({lost[0]}): copy it again, whole"
                )
            yield tiff
    finally:
        log.removeHandler(watch)


def _open_tiff(file: Path, unnamed: str) -> FrameFile:
    with _whole_tiff(file) as tiff:
        if len(tiff.series) > 1:
            raise ReadError(
                f"{file} holds {len(tiff.series)} separate images: save one alone, or all as one stack"
            )
        series = tiff.series[0]
        axes, shape = _named_axes(file, series.axes, series.shape, unnamed)
        found = FrameFile(file, axes, shape, np.dtype(series.dtype), ())
        if tiff.is_ome and tiff.ome_metadata:
            found = _with_ome(found, tiff.ome_metadata)
        elif tiff.is_imagej and tiff.imagej_metadata:
            found = _with_imagej(found, tiff)
    return _with_channel_names(found)


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
    return _with_channel_names(FrameFile(file, axes, array.shape, array.dtype, ()))


def _named_axes(file: Path, axes: str, shape: tuple[int, ...], unnamed: str) -> tuple[str, tuple[int, ...]]:
    """Axes in the words T, C, Y, X, without those of length 1 beside Y and X."""
    kept = [(axis, size) for axis, size in zip(axes, shape, strict=True) if size > 1 or axis in "YX"]
    named = []
    for place, (axis, size) in enumerate(kept):
        if axis == "Z":
            raise ReadError(
                f"{file} is a z-stack (axes {axes}, shape {shape}): project it, or save its axis as time"
            )
        colour = axis == "S" and place == len(kept) - 1  # planes that stand first may be frames as well
        letter = axis if axis in "TCYX" else "C" if colour else unnamed
        named.append((letter, size))
    letters = "".join(letter for letter, _ in named)
    if len(set(letters)) != len(letters) or not {"Y", "X"} <= set(letters):
        raise ReadError(f"{file} has the axes {axes} with shape {shape}: save it as TYX, CYX, TCYX or YX")
    return letters, tuple(size for _, size in named)


def _with_ome(found: FrameFile, xml: str) -> FrameFile:
    pixels = next(e for e in ElementTree.fromstring(xml).iter() if e.tag.endswith("}Pixels"))
    sizes = [
        float(pixels.attrib[f"PhysicalSize{axis}"])
        * _MICROMETRES.get(_micro(pixels.attrib.get(f"PhysicalSize{axis}Unit", "µm")), np.nan)
        for axis in "XY"
        if f"PhysicalSize{axis}" in pixels.attrib
    ]
    interval = pixels.attrib.get("TimeIncrement")
    seconds = _SECONDS.get(pixels.attrib.get("TimeIncrementUnit", "s"), np.nan)
    names = [e.attrib.get("Name", "") for e in pixels if e.tag.endswith("}Channel")]
    return replace(
        found,
        scale=Scale(_square(found.path, sizes), _positive(float(interval) * seconds) if interval else None),
        channels=tuple(names) if names and all(names) else (),
    )


def _with_imagej(found: FrameFile, tiff: tifffile.TiffFile) -> FrameFile:
    metadata = tiff.imagej_metadata or {}
    unit = _micro(str(metadata.get("unit", "")).replace("\\u00B5", "µ").strip())
    tags = tiff.pages.first.tags
    sizes = []
    if unit in _MICROMETRES:
        for name in ("XResolution", "YResolution"):
            above, below = tags[name].value if name in tags else (0, 1)
            sizes.append(below / above * _MICROMETRES[unit] if above else np.nan)
    interval = metadata.get("finterval")
    seconds = _SECONDS.get(str(metadata.get("tunit", "s")), np.nan)
    return replace(
        found,
        scale=Scale(_square(found.path, sizes), _positive(float(interval) * seconds) if interval else None),
    )


def _micro(unit: str) -> str:
    return unit.replace("\u03bc", "\u00b5")  # the Greek letter mu stands for the micro sign


def _square(file: Path, sizes: list[float]) -> float | None:
    if not sizes or not np.isfinite(sizes).all() or min(sizes) <= 0:
        return None
    if max(sizes) > 1.01 * min(sizes):
        raise ReadError(f"{file} has pixels of {sizes[0]:g} × {sizes[-1]:g} µm: resample it to square pixels")
    return sizes[0]


def _positive(value: float) -> float | None:
    return value if np.isfinite(value) and value > 0 else None


def _with_channel_names(found: FrameFile) -> FrameFile:
    count = found.shape[found.axes.index("C")] if "C" in found.axes else 1
    if len(found.channels) == count:
        again = [found.channels[:place].count(name) for place, name in enumerate(found.channels)]
        names = [f"{name} ({n + 1})" if n else name for name, n in zip(found.channels, again, strict=True)]
        return replace(found, channels=tuple(names))
    return replace(found, channels=tuple(str(number) for number in range(count)))
