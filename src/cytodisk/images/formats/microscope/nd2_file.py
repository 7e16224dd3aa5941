"""ND2 files of Nikon microscopes; needs nd2."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import MissingPartError, ReadError
from cytodisk.images.chosen_channels import COLOURS
from cytodisk.images.claims import check_claim
from cytodisk.images.formats.measured_scale import agreed_interval, pixel_size_of
from cytodisk.images.formats.microscope.plane_frames import Plane, PlaneFrames, scene_file
from cytodisk.images.formats.microscope.quiet import quiet
from cytodisk.images.frame_file import FileChoice, FrameFile
from cytodisk.images.scenes import Scene, Taken
from cytodisk.scale import Scale

_AXES = {"TimeLoop": "T", "NETimeLoop": "T", "XYPosLoop": "P", "ZStackLoop": "Z"}
_ALL = slice(None)
_MOST_TIMES = 100  # as many images as are there, a file may claim, as recordings are stopped
_MOST_LOOKED_AT = (
    2000  # frames whose times are looked at one by one; of longer movies the set interval is taken
)


def open_nd2(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at an ND2 file without reading its pixels; see `cytodisk.images.frames.open_frames`."""

    def stored(scene: Scene, taken: Taken) -> PlaneFrames:
        return PlaneFrames(Nd2Planes(file, taken.scene), len(scene.channels), scene.slices, taken.z)

    return scene_file(file, nd2_scenes(file), choice, stored)


def nd2_scenes(file: Path) -> tuple[Scene, ...]:
    """What an ND2 file holds: its positions."""
    with _opened(file) as opened:
        there = opened.attributes.sequenceCount
        channels, sizes = max(opened.attributes.componentCount, 1), opened.sizes
        shape = max(there, 1), channels, sizes["Y"], sizes["X"]
        check_claim(file, shape, np.dtype(opened.dtype), codec="zlib")
        scene = _scene(opened)
        return tuple(replace(scene, name=name) for name in _position_names(opened))


@dataclass(frozen=True)
class Nd2Planes:
    """Planes of one position of an ND2 file.

    Attributes
    ----------
    path : Path
    scene : int
        Number of the position, from 0.
    """

    path: Path
    scene: int

    @contextmanager
    def opened(self) -> Iterator[Plane]:
        """Open the file, to read planes of it."""
        with _opened(self.path) as opened:
            attributes = opened.attributes
            height, width = opened.sizes["Y"], opened.sizes["X"]
            samples = opened.components_per_channel
            steps = _steps(opened)
            last: dict[int, np.ndarray[Any, Any]] = {}  # channels lie together: read them once

            def plane(
                frame: int, channel: int, z: int, rows: slice = _ALL, columns: slice = _ALL, /
            ) -> np.ndarray[Any, Any]:
                place = {"T": frame, "P": self.scene, "Z": z}
                number = sum(place[axis] * step for axis, step in steps.items())
                if number not in last:
                    last.clear()
                    missing = number >= attributes.sequenceCount
                    pixels = None if missing else np.asarray(opened.read_frame(number))
                    if pixels is None or not pixels.any():  # the library gives zeros for what is missing
                        raise ReadError(
                            f"{self.path} has no pixels of frame {frame}, slice {z}: the recording was "
                            "stopped, or the file is damaged"
                        )
                    last[number] = pixels.reshape(-1, height, width, samples if opened.is_rgb else 1)
                return np.array(last[number][channel // samples, rows, columns, channel % samples])

            yield plane

    def rows_together(self) -> None:
        """A plane is stored as one piece."""


@contextmanager
def _opened(file: Path) -> Iterator[Any]:
    try:
        import nd2
    except ImportError as error:
        raise MissingPartError.of(f"{file}: reading ND2 files needs nd2", "nd2") from error
    with quiet("nd2"), nd2.ND2File(file) as opened:
        if opened.is_legacy:
            raise ReadError(
                f"{file} is of NIS-Elements before 2010 (JPEG 2000): save it anew in NIS-Elements, or "
                "export it as TIFF"
            )
        yield opened


def _scene(opened: Any) -> Scene:
    """What each position holds, which is the same for all; the time is that of the first."""
    sizes, counts = opened.sizes, _counts(opened)
    frames = counts.get("T", 1)
    size_um, size_notes, fault = _pixel_size(opened)
    interval_s, time_notes = agreed_interval(_times(opened), _set_interval(opened), frames)
    loops = [loop.type for loop in opened.experiment if loop.count > 1]
    if len({_AXES[loop] for loop in loops if loop in _AXES}) < len(loops):
        fault = (
            "was recorded in other loops than one of time, position and z each "
            f"({', '.join(loops)}): save it as TIFF"
        )
    elif _planned(opened) > _MOST_TIMES * max(opened.attributes.sequenceCount, 1):
        fault = (
            f"is damaged: it claims {_planned(opened)} images and {opened.attributes.sequenceCount} are "
            "there; copy it again"
        )
    return Scene(
        "",
        frames,
        counts.get("Z", 1),
        _channels(opened),
        (sizes["Y"], sizes["X"]),
        np.dtype(opened.dtype),
        Scale(size_um, interval_s),
        size_notes + time_notes + _stopped(opened),
        fault,
    )


def _counts(opened: Any) -> dict[str, int]:
    """How many steps there are along each axis, without those of one step."""
    loops = [loop for loop in opened.experiment if loop.count > 1 and loop.type in _AXES]
    return {_AXES[loop.type]: loop.count for loop in loops}


def _steps(opened: Any) -> dict[str, int]:
    """How far apart stored images are, by axis: the last loop runs fastest."""
    steps, step = {}, 1
    for loop in reversed(opened.experiment):
        if loop.count > 1 and (axis := _AXES.get(loop.type)) is not None:
            steps[axis] = step
        step *= loop.count
    return steps


def _pixel_size(opened: Any) -> tuple[float | None, tuple[str, ...], str]:
    channels = opened.metadata.channels or ()
    if not channels or not all(channels[0].volume.axesCalibrated[:2]):  # the library gives 1 µm then
        note = "it was recorded without a calibration: the pixel size is unknown; give it with --pixel-size"
        return None, (note,), ""
    width, height = channels[0].volume.axesCalibration[:2]
    return pixel_size_of([float(height), float(width)])


def _planned(opened: Any) -> int:
    return math.prod(loop.count for loop in opened.experiment)


def _stopped(opened: Any) -> tuple[str, ...]:
    planned, there = _planned(opened), opened.attributes.sequenceCount
    if there == planned:
        return ()
    if there > planned:
        return (f"it holds {there} images and its loops tell of {planned}: the others are not read",)
    return (f"its recording was stopped: {there} of {planned} images are there, later frames are missing",)


def _channels(opened: Any) -> tuple[str, ...]:
    names = [channel.channel.name or "" for channel in opened.metadata.channels or ()]
    count, samples = opened.sizes.get("C", 1), opened.components_per_channel
    if not opened.is_rgb:
        return tuple(names) if len(names) == count else ("",) * count
    names = names if len(names) == count else [""] * count
    return tuple(f"{name} {colour}".strip() for name in names for colour in COLOURS[samples])


def _position_names(opened: Any) -> list[str]:
    for loop in opened.experiment:
        if loop.type == "XYPosLoop" and loop.count > 1:
            names = [point.name or str(number) for number, point in enumerate(loop.parameters.points)]
            return names if len(names) == loop.count else [str(number) for number in range(loop.count)]
    return [str(number) for number in range(_counts(opened).get("P", 1))]


def _times(opened: Any) -> tuple[float, ...]:
    """When each frame of the first position was taken, in seconds; nothing where the file does not say."""
    frames, step = _counts(opened).get("T", 1), _steps(opened).get("T", 0)
    if not 1 < frames <= _MOST_LOOKED_AT:
        return ()
    channels = [opened.frame_metadata(frame * step).channels for frame in range(frames)]
    return tuple(float(first[0].time.relativeTimeMs) / 1e3 for first in channels if first)


def _set_interval(opened: Any) -> float | None:
    """Seconds from a frame to the next, as set; None where there is no single one."""
    for loop in opened.experiment:
        if loop.type == "TimeLoop":
            return float(loop.parameters.periodMs) / 1e3
        if loop.type == "NETimeLoop" and len(loop.parameters.periods) == 1:
            return float(loop.parameters.periods[0].periodMs) / 1e3
    return None
