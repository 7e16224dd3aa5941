"""Frames that are put together from the planes of a microscope file."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from cytodisk.errors import ReadError
from cytodisk.images.chosen_channels import channel_names
from cytodisk.images.formats.projection import projected
from cytodisk.images.frame_file import Cut, FileChoice, FrameFile, StoredFrames
from cytodisk.images.reading import reading
from cytodisk.images.scenes import Scene, Taken, take

_ALL = slice(None)


class Plane(Protocol):
    """Gives pixels (H, W) of a plane, or of some rows and columns of it."""

    def __call__(
        self, frame: int, channel: int, z: int, rows: slice = _ALL, columns: slice = _ALL, /
    ) -> np.ndarray[Any, Any]:
        """Read them."""
        ...


class Planes(Protocol):
    """Planes of one scene of a file; can be sent to other processes, so it holds no open file."""

    @property
    def path(self) -> Path:
        """The file, for messages."""
        ...

    def opened(self) -> AbstractContextManager[Plane]:
        """Open the file, to read planes of it."""
        ...

    def rows_together(self) -> int | None:
        """How many rows are stored together; None where a plane is one piece."""
        ...


@dataclass(frozen=True)
class PlaneFrames:
    """Frames of a scene.

    Attributes
    ----------
    planes : Planes
    channels : int
    slices : int
        How many there are.
    z : int, "max" or "mean"
        What of them makes a frame.
    """

    planes: Planes
    channels: int
    slices: int
    z: int | str

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Pixels of a frame, shape (C, H, W)."""
        slices = range(self.slices) if isinstance(self.z, str) else (self.z,)
        with self.planes.opened() as plane:
            stacks = (
                np.stack([plane(number, channel, z) for channel in range(self.channels)]) for z in slices
            )
            return projected(stacks, self.z)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """How to cut pieces out of a frame; None for a projection, and where a plane is one piece."""
        if isinstance(self.z, str) or (rows := self.planes.rows_together()) is None:
            return None
        return partial(self._cut, number, self.z), rows

    def _cut(self, number: int, z: int, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        with reading(self.planes.path, f"frame {number}"), self.planes.opened() as plane:
            return np.stack([plane(number, channel, z, rows, columns) for channel in range(self.channels)])


def scene_file(
    file: Path, scenes: Sequence[Scene], choice: FileChoice, stored: Callable[[Scene, Taken], StoredFrames]
) -> FrameFile:
    """A microscope file as a sequence of frames.

    Parameters
    ----------
    file : Path
    scenes : sequence of Scene
        What it holds.
    choice : FileChoice
        What a user takes of it.
    stored : callable
        Gives the frames of what is taken.

    Raises
    ------
    ReadError
        The choice is not complete, or is not in the file.
    """
    if choice.axes is not None:
        raise ReadError(f"{file} names its axes itself: leave out --axes {choice.axes}")
    taken = take(file, scenes, choice)
    scene = scenes[taken.scene]
    sizes = {"T": scene.frames, "C": len(scene.channels)}
    axes = "".join(axis for axis, size in sizes.items() if size > 1) + "YX"
    shape = tuple(size for size in sizes.values() if size > 1) + scene.image_shape
    dtype = np.dtype(np.float32) if taken.z == "mean" else scene.dtype
    names = channel_names(scene.channels if all(scene.channels) else (), len(scene.channels))
    evidence = ", ".join(filter(None, _evidence(scenes, taken)))
    offers = (("scene",) if len(scenes) > 1 else ()) + (("z",) if scene.slices > 1 else ())
    return FrameFile(
        file,
        axes,
        shape,
        dtype,
        names,
        stored(scene, taken),
        scene.scale,
        scene.notes,
        evidence,
        offers=offers,
    )


def _evidence(scenes: Sequence[Scene], taken: Taken) -> Iterator[str]:
    scene = scenes[taken.scene]
    if len(scenes) > 1:
        yield f"scene {taken.scene} of {len(scenes)} ({scene.name})"
    if scene.slices > 1:
        of_all = f"{taken.z} of {scene.slices} slices in z"
        yield of_all if isinstance(taken.z, str) else f"slice {of_all}".replace(" slices", "")
