"""LIF files of Leica microscopes; needs liffile."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import MissingPartError, ReadError
from cytodisk.images.chosen_channels import COLOURS
from cytodisk.images.formats.measured_scale import agreed_interval, pixel_size_of
from cytodisk.images.formats.microscope.plane_frames import Plane, PlaneFrames, scene_file
from cytodisk.images.formats.microscope.quiet import quiet
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.scenes import Scene, Taken
from cytodisk.scale import Scale

_CHANNEL_AXES = {"C": "", "S": "", "λ": "nm emission", "Λ": "nm excitation"}
_AXIS_WORDS = {"N": "rotations", "M": "tiles", "Q": "positions", "H": "lifetimes"}
_ALL = slice(None)
_MOST_TIMES = 100  # as many bytes as are there, an image may claim
_CHANNELS = "./Data/Image/ImageDescription/Channels/ChannelDescription"


def open_lif(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a LIF file without reading its pixels; see `cytodisk.images.frames.open_frames`."""

    def stored(scene: Scene, taken: Taken) -> PlaneFrames:
        return PlaneFrames(LifPlanes(file, taken.scene), len(scene.channels), scene.slices, taken.z)

    return scene_file(file, lif_scenes(file), choice, stored)


def lif_scenes(file: Path) -> tuple[Scene, ...]:
    """What a LIF file holds: its images, with the folders in it as part of their names."""
    with _opened(file) as opened:
        return tuple(_scene_or_fault(image) for image in opened.images)


@dataclass(frozen=True)
class LifPlanes:
    """Planes of one image of a LIF file.

    Attributes
    ----------
    path : Path
    scene : int
        Number of the image, from 0.
    """

    path: Path
    scene: int

    @contextmanager
    def opened(self) -> Iterator[Plane]:
        """Open the file, to read planes of it."""
        with _opened(self.path) as opened:
            image = opened.images[self.scene]
            axes = [axis for axis in image.dims if axis in _CHANNEL_AXES]
            steps = list(product(*(range(image.sizes[axis]) for axis in axes)))

            def plane(
                frame: int, channel: int, z: int, rows: slice = _ALL, columns: slice = _ALL, /
            ) -> np.ndarray[Any, Any]:
                place = dict(zip(axes, steps[channel], strict=True)) | {"T": frame, "Z": z}
                indices = {axis: number for axis, number in place.items() if axis in image.dims}
                sample = indices.pop("S", 0)
                pixels = np.asarray(image.frame(**indices))
                return (pixels[..., sample] if "S" in image.dims else pixels)[rows, columns]

            yield plane

    def rows_together(self) -> None:
        """A plane is stored as one piece."""


@contextmanager
def _opened(file: Path) -> Iterator[Any]:
    try:
        import liffile
    except ImportError as error:
        raise MissingPartError.of(f"{file}: reading LIF files needs liffile", "lif") from error
    with quiet("liffile"), liffile.LifFile(str(file)) as opened:
        if opened.type is not liffile.LifFileType.LIF:
            raise ReadError(f"{file} is a part of a Leica project: export the image as LIF")
        yield opened


def _scene_or_fault(image: Any) -> Scene:
    """An image whose layout the library cannot tell leaves the others readable."""
    try:
        return _scene(image)
    except (ValueError, KeyError, AssertionError, ArithmeticError) as error:
        words = " ".join(str(error).split()) or type(error).__name__
        fault = f"has a layout that is not known ({words}): export it as TIFF from LAS X or Fiji"
        return Scene(image.path, 1, 1, ("",), (1, 1), np.dtype(np.uint8), fault=fault)


def _scene(image: Any) -> Scene:
    sizes = image.sizes
    shape = sizes.get("Y", 1), sizes.get("X", 1)
    if (fault := _fault(image)) != "":
        return Scene(image.path, sizes.get("T", 1), 1, ("",), shape, np.dtype(np.uint8), fault=fault)
    steps = {axis: _steps(image, axis) for axis in "TYX"}
    size_um, size_notes, fault = pixel_size_of([_step_um(steps[axis]) for axis in "YX"])
    short, damage = _cut_short(image)
    interval_s, time_notes = agreed_interval(_times(image), _step(steps["T"]), sizes.get("T", 1))
    return Scene(
        image.path,
        sizes.get("T", 1),
        sizes.get("Z", 1),
        _channels(image),
        shape,
        image.dtype,
        Scale(size_um, interval_s),
        (*size_notes, *time_notes, *short),
        fault or damage,
    )


def _fault(image: Any) -> str:
    """Why an image has no planes that can be mapped."""
    sizes = image.sizes
    if image.is_flim:
        return "holds lifetimes of photons, not an image: export an intensity image from LAS X"
    if not {"Y", "X"} <= set(sizes):
        return (
            f"is a scan along the axes {', '.join(sizes)}, not an image of the plane of the cell (Y, X): it "
            "cannot be mapped"
        )
    if not {"Y", "X"} <= set(image.frames.frame_sizes):
        upright = "".join(image.frames.frame_sizes)
        return (
            f"was scanned as upright sections ({upright}): save it as a stack of planes (XYZ) in LAS X or "
            "Fiji"
        )
    for axis in sizes:
        if axis not in {"T", "Z", "Y", "X", *_CHANNEL_AXES}:
            words = _AXIS_WORDS.get(axis, f"places along its axis {axis}")
            return f"holds {sizes[axis]} {words}: export one of them, or merge them, in LAS X"
    return ""


def _cut_short(image: Any) -> tuple[tuple[str, ...], str]:
    """A note if some of its pixels are missing, or the fault if nearly all are."""
    needed = math.prod(image.sizes.values()) * image.dtype.itemsize
    block = image.memory_block
    there = min(block.size, Path(image.parent.filepath).stat().st_size - block.offset)
    if needed <= there:
        return (), ""
    words = f"its pixels need {needed} bytes and {max(there, 0)} are there"
    if needed > _MOST_TIMES * max(there, 0):
        return (), f"is damaged or cut short: {words}; copy it again"
    return (f"it is cut short: {words}, so that the last frames are missing; copy it again",), ""


def _channels(image: Any) -> tuple[str, ...]:
    """Names of the channels: steps of a wavelength count as channels, too."""
    axes = [axis for axis in image.dims if axis in _CHANNEL_AXES]
    named = [_names(image, axis) for axis in axes]
    return tuple(" ".join(filter(None, names)) for names in product(*named)) or ("",)


def _names(image: Any, axis: str) -> tuple[str, ...]:
    count: int = image.sizes[axis]
    if axis == "S":
        return COLOURS.get(count, ("",) * count)
    if axis == "C":
        described = image.xml_element.findall(_CHANNELS)
        names = [_said(one) for one in described[:: max(1, len(described) // count)]]
        return tuple(names) if len(names) == count else ("",) * count
    wavelengths = _steps(image, axis)
    return tuple(f"{1e9 * length:.0f} {_CHANNEL_AXES[axis]}" for length in wavelengths) or ("",) * count


def _said(channel: Any) -> str:
    """The name of a channel: its dye, what it measures, or the colour that it is shown in."""
    properties = {e.findtext("Key"): e.findtext("Value") for e in channel.iterfind("ChannelProperty")}
    names = properties.get("DyeName"), channel.get("NameOfMeasuredQuantity"), channel.get("LUTName")
    return next((name for name in names if name), "")


def _steps(image: Any, axis: str) -> tuple[float, ...]:
    return tuple(float(step) for step in image.coords.get(axis, ()))


def _times(image: Any) -> tuple[float, ...]:
    """When the first plane of each frame was taken, in seconds; nothing where the file does not say."""
    stamps, frames = image.timestamps, image.sizes.get("T", 1)
    if stamps is None or not len(stamps) or len(stamps) % frames or image.dims[0] != "T":
        return ()
    firsts = stamps[:: len(stamps) // frames].astype(np.int64)  # in milliseconds
    return tuple(float(time) for time in (firsts - firsts[0]) / 1e3)


def _step(places: tuple[float, ...]) -> float | None:
    return None if len(places) < 2 else (places[-1] - places[0]) / (len(places) - 1)


def _step_um(metres: tuple[float, ...]) -> float | None:
    step = _step(metres)
    return None if step is None else step * 1e6
