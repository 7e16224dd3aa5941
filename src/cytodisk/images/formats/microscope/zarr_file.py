"""OME-Zarr images (versions 0.4 and 0.5) in local folders."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.formats.measured_scale import agreed_interval, pixel_size_of
from cytodisk.images.formats.microscope.plane_frames import Plane, PlaneFrames, scene_file
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.image_paths import is_zarr, parts_of
from cytodisk.images.scale_units import is_no_unit, micrometres, seconds
from cytodisk.images.scenes import Scene, Taken, scene_number
from cytodisk.scale import Scale

_ALL = slice(None)
_NOT_OPENED = Scene("", 1, 1, ("",), (1, 1), np.dtype(np.uint8))
_FEW = 100_000  # pixels, and planes, that need no look
_MOST_TIMES = 100  # as many pixels as an array has, its chunks may have


def open_zarr(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at an OME-Zarr image without reading its pixels; see `cytodisk.images.frames.open_frames`."""
    names = _image_names(file)
    if len(names) > 1:  # a plate has hundreds: open the one that is taken
        chosen = scene_number(file, [(name, True) for name in names], choice.scene)
        images = [_image(file, name, 0) if at == chosen else None for at, name in enumerate(names)]
        scenes = [_NOT_OPENED if image is None else image[0] for image in images]
        scenes = [replace(scene, name=name) for scene, name in zip(scenes, names, strict=True)]
    else:
        images = list(_images_in(file, names[0]))
        scenes = [image[0] for image in images if image is not None]

    def stored(scene: Scene, taken: Taken) -> PlaneFrames:
        image = images[taken.scene]
        assert image is not None  # it is the one that is taken
        return PlaneFrames(image[1], len(scene.channels), scene.slices, taken.z)

    return scene_file(file, scenes, choice, stored)


def zarr_scenes(file: Path) -> tuple[Scene, ...]:
    """What an OME-Zarr folder holds: its images, at full resolution."""
    return tuple(scene for name in _image_names(file) for scene, _ in _images_in(file, name))


@dataclass(frozen=True)
class ZarrPlanes:
    """Planes of one image of an OME-Zarr folder.

    Attributes
    ----------
    path : Path
    array : str
        Where its array is in the folder.
    axes : str
        As stored, one letter each.
    """

    path: Path
    array: str
    axes: str

    @contextmanager
    def opened(self) -> Iterator[Plane]:
        """Open the array, to read planes of it."""
        array = _array(self.path, self.array)

        def plane(
            frame: int, channel: int, z: int, rows: slice = _ALL, columns: slice = _ALL, /
        ) -> np.ndarray[Any, Any]:
            places: dict[str, Any] = {"T": frame, "C": channel, "Z": z, "Y": rows, "X": columns}
            piece = np.asarray(array[tuple(places.get(axis, 0) for axis in self.axes)])
            return piece if self.axes.index("Y") < self.axes.index("X") else piece.T

        yield plane

    def rows_together(self) -> int:
        """How many rows lie in a chunk."""
        return int(_array(self.path, self.array).chunks[self.axes.index("Y")])


def _array(file: Path, name: str) -> Any:
    import zarr

    return zarr.open_array(str(file), path=name, mode="r")


def _group(file: Path, name: str) -> Any:
    import zarr

    return zarr.open_group(str(file), path=name, mode="r")


def _images_in(file: Path, name: str) -> Iterator[tuple[Scene, ZarrPlanes]]:
    """Images of a group: nearly always one."""
    for number in range(len(_multiscales(file, name)) if name == "" else 1):
        yield _image(file, name, number)


def _is_group(file: Path) -> bool:
    import zarr

    return isinstance(zarr.open(str(file), mode="r"), zarr.Group)


def _ome(file: Path, name: str) -> dict[str, Any]:
    """OME metadata of a group: below "ome" since version 0.5."""
    attributes = dict(_group(file, name).attrs)
    ome = attributes.get("ome", attributes)
    return ome if isinstance(ome, dict) else {}


def _multiscales(file: Path, name: str) -> list[Any]:
    found = _ome(file, name).get("multiscales")
    if not isinstance(found, list) or not found:
        raise ReadError(f"{file / name} is no OME-Zarr image: its metadata have no multiscales")
    return found


def _image_names(file: Path) -> list[str]:
    """Where the images of a folder are: in itself, in a plate or a well, or numbered by Bio-Formats."""
    if (file / ".zarray").is_file() or not _is_group(file):
        raise ReadError(
            f"{file} is a Zarr array without OME metadata: pass the folder above it that has them "
            "(multiscales), or save it as OME-Zarr or TIFF"
        )
    ome = _ome(file, "")
    if "multiscales" in ome:
        return [""]
    if "plate" in ome:
        wells = [str(well["path"]) for well in ome["plate"]["wells"]]
        return [f"{well}/{image}" for well in wells for image in _well_images(_ome(file, well))]
    if "well" in ome:
        return _well_images(ome)
    if "labels" in ome:
        return [str(name) for name in ome["labels"]]
    if "bioformats2raw.layout" in ome:
        numbered = [place.name for place in file.iterdir() if place.name.isdecimal() and is_zarr(place)]
        return sorted(numbered, key=int)
    raise ReadError(
        f"{file} is a Zarr folder without an OME image (no multiscales): pass the folder of an image in it"
    )


def _well_images(ome: dict[str, Any]) -> list[str]:
    return [str(image["path"]) for image in ome["well"]["images"]]


def _image(file: Path, name: str, number: int) -> tuple[Scene, ZarrPlanes]:
    multiscale = _multiscales(file, name)[number]
    try:
        described = [axis if isinstance(axis, dict) else {"name": axis} for axis in multiscale["axes"]]
        axes = "".join(str(axis["name"])[:1].upper() for axis in described)
        dataset = multiscale["datasets"][0]
        place = str(Path(name) / str(dataset["path"]))
    except (KeyError, TypeError, IndexError) as error:
        raise ReadError(
            f"{file / name}: its OME metadata lack {error}: write it as OME-Zarr 0.4 or 0.5"
        ) from error
    array = _array(file, place)
    if len(axes) != array.ndim:
        raise ReadError(
            f"{file / name}: its OME metadata name {len(axes)} axes and its array has {array.ndim}: write it "
            "anew"
        )
    sizes = dict(zip(axes, array.shape, strict=True))
    steps, step_notes = _steps(multiscale, dataset, len(axes))
    spaces = [_step(described, axes, steps, axis) for axis in "YX"]
    size_um, size_notes, fault = pixel_size_of([size for size, _ in spaces])
    interval, time_note = _step(described, axes, steps, "T")
    interval_s, time_notes = agreed_interval((), interval, sizes.get("T", 1))
    title = str(multiscale.get("name") or "") if name == "" else name
    notes = dict.fromkeys([note for _, note in spaces] + [time_note if sizes.get("T", 1) > 1 else ""])
    scene = Scene(
        title or str(number),
        sizes.get("T", 1),
        sizes.get("Z", 1),
        _channels(_ome(file, name), sizes.get("C", 1)),
        (sizes.get("Y", 1), sizes.get("X", 1)),
        np.dtype(array.dtype),
        Scale(size_um, interval_s),
        (*step_notes, *size_notes, *time_notes, *filter(None, notes)),
        _fault(axes, array.shape) or _claim_fault(file / place, axes, array) or fault,
    )
    return scene, ZarrPlanes(file, place, axes)


def _fault(axes: str, shape: Sequence[int]) -> str:
    others = [axis for axis, size in zip(axes, shape, strict=True) if axis not in "TCZYX" and size > 1]
    if len(set(axes)) != len(axes) or not {"Y", "X"} <= set(axes) or others:
        return f"has the axes {axes.lower()}: save it with axes out of t, c, z, y and x"
    return ""


def _claim_fault(folder: Path, axes: str, array: Any) -> str:
    """What is wrong with the size of an array, as chunks that are empty are not stored."""
    size = math.prod(array.shape)
    if math.prod(array.chunks) > _MOST_TIMES * max(size, _FEW):
        chunk = " × ".join(map(str, array.chunks))
        return f"is damaged: its array of {size} pixels is said to be stored in chunks of {chunk}"
    planes = math.prod(n for axis, n in zip(axes, array.shape, strict=True) if axis not in "YX")
    if planes <= _FEW:
        return ""
    stored = sum(part.stat().st_size for part in parts_of(folder))
    if size * array.dtype.itemsize <= _MOST_TIMES * _MOST_TIMES * stored:
        return ""
    return (
        f"is damaged or not complete: it claims {planes} planes and {stored} bytes are stored; copy it again"
    )


def _channels(ome: dict[str, Any], count: int) -> tuple[str, ...]:
    omero = ome.get("omero")
    listed = omero.get("channels") if isinstance(omero, dict) else None
    names = [str(channel.get("label") or "") for channel in listed or () if isinstance(channel, dict)]
    return tuple(names) if len(names) == count else ("",) * count


def _steps(multiscale: Any, dataset: Any, count: int) -> tuple[list[float] | None, tuple[str, ...]]:
    """Step along each axis: the scale of the array times that of the image; None where there is none."""
    steps, found = [1.0] * count, False
    try:
        for owner in (dataset, multiscale):
            for transformation in owner.get("coordinateTransformations") or ():
                if transformation.get("type") == "scale":
                    factors = [float(factor) for factor in transformation["scale"]]
                    steps = [step * factor for step, factor in zip(steps, factors, strict=True)]
                    found = True
    except (AttributeError, KeyError, TypeError, ValueError) as error:
        note = (
            f"its coordinateTransformations cannot be used ({error}): the scale is unknown; give it with "
            "--pixel-size and --frame-interval"
        )
        return None, (note,)
    return (steps if found else None), ()


def _step(described: list[Any], axes: str, steps: list[float] | None, axis: str) -> tuple[float | None, str]:
    """Step along an axis in µm or seconds; None, perhaps with a note, where the file does not say."""
    if steps is None or axis not in axes:
        return None, ""
    number = axes.index(axis)
    unit, step = described[number].get("unit"), steps[number]
    nothing = unit is None or is_no_unit(unit)
    if nothing and step == 1:
        return None, ""
    factor = None if nothing else seconds(unit) if axis == "T" else micrometres(unit)
    if factor is not None:
        return step * factor, ""
    flag, what = ("--frame-interval", "frame interval") if axis == "T" else ("--pixel-size", "pixel size")
    named = "no unit" if nothing else f"the unit {unit!r}, which is unknown"
    return None, f"its {what} of {step:g} has {named}: give it with {flag}"
