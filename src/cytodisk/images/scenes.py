"""What a microscope file holds, scene by scene, and what of it a user takes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.frame_file import FileChoice
from cytodisk.images.short_lists import shortened
from cytodisk.scale import UNKNOWN, Scale

PROJECTIONS = ("max", "mean")
"""How the slices of a z-stack can be made one image."""

_LISTED = 12  # scenes or channels that a message names


@dataclass(frozen=True)
class Scene:
    """One scene of a file: a position, series or image.

    Attributes
    ----------
    name : str
    frames, slices : int
        In time, and in z; 1 where there is but one.
    channels : tuple of str
        Names; "" for one without a name.
    image_shape : (int, int)
        (H, W) of a plane.
    dtype : numpy.dtype
    scale : Scale
        What the metadata says of it.
    notes : tuple of str
        What was found wrong with its metadata, and what is not known for that, in words.
    fault : str
        Why it cannot be read, and what to do; empty where it can.
    """

    name: str
    frames: int
    slices: int
    channels: tuple[str, ...]
    image_shape: tuple[int, int]
    dtype: np.dtype[Any]
    scale: Scale = UNKNOWN
    notes: tuple[str, ...] = ()
    fault: str = ""

    @property
    def words(self) -> str:
        """What it holds, as "3 frames, 2 channels (DAPI, GFP), 170 × 240 px of uint16"; or its fault."""
        return self.words_with(())

    def words_with(self, called: Sequence[str]) -> str:
        """The same, with what channels are called in a run if none has a name."""
        if self.fault:
            return f"cannot be read: it {self.fault}"
        parts = [_count(self.frames, "frame")]
        if self.slices > 1:
            parts.append(f"{self.slices} slices in z")
        names = [name or f"{number} without a name" for number, name in enumerate(self.channels)]
        channels = _count(len(names), "channel")
        if any(self.channels) and self.channels != tuple(map(str, range(len(names)))):
            parts.append(f"{channels} ({shortened(names, _LISTED)})")
        else:
            shown = f", called {shortened(list(called), _LISTED)}" if called else ""
            parts.append(channels if len(names) == 1 else f"{channels} without names{shown}")
        parts.append(f"{self.image_shape[0]} × {self.image_shape[1]} px of {self.dtype}")
        if self.scale.pixel_size_um is not None:
            parts.append(f"{self.scale.pixel_size_um:.4g} µm a pixel")
        if self.scale.frame_interval_s is not None:
            parts.append(f"{self.scale.frame_interval_s:.4g} s a frame")
        return ", ".join(parts)


@dataclass(frozen=True)
class Taken:
    """What is taken of a file.

    Attributes
    ----------
    scene : int
        Its number, from 0.
    z : int, "max" or "mean"
        A slice, from 0, or how the slices become one image.
    """

    scene: int
    z: int | str


def take(file: Path, scenes: Sequence[Scene], choice: FileChoice) -> Taken:
    """What a user takes of a file that holds more than one movie.

    Parameters
    ----------
    file : Path
        For messages.
    scenes : sequence of Scene
    choice : FileChoice
        A scene or a slice has no meaning in a file with one of them, and is ignored there: one choice is
        made for the masks and the signal together.

    Raises
    ------
    ReadError
        The file has several scenes, or slices, and none is chosen; or the choice is not in the file; or the
        scene cannot be read.
    """
    number = scene_number(file, [(scene.name, not scene.fault) for scene in scenes], choice.scene)
    if number is None:
        first = scenes[0]
        raise ReadError(
            f"{file} holds {len(scenes)} scenes and none can be read; the first ({first.name}) {first.fault}"
        )
    scene = scenes[number]
    if scene.fault:
        of_it = f", scene {number} ({scene.name})," if len(scenes) > 1 else ""
        raise ReadError(f"{file}{of_it} {scene.fault}")
    return Taken(number, chosen_slice(file, scene.slices, choice.z))


def chosen_slice(file: Path, slices: int, z: str | None) -> int | str:
    """Number of the slice that a user takes of a z-stack, or "max" or "mean" of them.

    Parameters
    ----------
    file : Path
        For messages.
    slices : int
        How many there are; of one, it is taken whatever the user says.
    z : str or None
        What the user says.

    Raises
    ------
    ReadError
        There are several and none is chosen, or there is no such slice.
    """
    if slices == 1:
        return 0
    remedy = f"pass one slice (0 to {slices - 1}), as --z {slices // 2}, or a projection, as --z max"
    if z is None:
        raise ReadError(f"{file} is a z-stack of {slices} slices: {remedy}")
    if z in PROJECTIONS:
        return z
    if not z.isdecimal() or int(z) >= slices:
        raise ReadError(f"{file} is a z-stack of {slices} slices and has no slice {z!r}: {remedy}")
    return int(z)


def scene_number(file: Path, scenes: Sequence[tuple[str, bool]], chosen: str | None) -> int | None:
    """Number of the scene that a user takes; None if there are several and none can be read.

    Parameters
    ----------
    file : Path
        For messages.
    scenes : sequence of (str, bool)
        Name of each, and whether it can be read.
    chosen : str or None
        Name, or number from 0; of a single scene, it is taken whatever the user says.

    Raises
    ------
    ReadError
        There is none, or there are several and none is chosen, or that is not there.
    """
    if not scenes:
        raise ReadError(f"{file} holds no image: check the file in the microscope's own software")
    if len(scenes) == 1:
        return 0
    readable = [number for number, (_, can_be) in enumerate(scenes) if can_be]
    if not readable:
        return None
    found = None if chosen is None else place_of(chosen, [name for name, _ in scenes])
    if found is not None:
        return found
    listed = shortened([f"{number} ({scenes[number][0]})" for number in readable], _LISTED)
    wrong = "" if chosen is None else f" and none is {chosen!r}"
    raise ReadError(
        f"{file} holds {len(scenes)} scenes{wrong}: pass the number or the name of one, as --scene "
        f"{readable[0]}; there are {listed}"
    )


def place_of(chosen: str, names: Sequence[str]) -> int | None:
    """Where a name is that stands once, or the number that it is; None where there is neither."""
    if list(names).count(chosen) == 1:
        return list(names).index(chosen)
    if chosen.isdecimal() and int(chosen) < len(names):
        return int(chosen)
    return None


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
