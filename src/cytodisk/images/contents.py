"""What an image file holds, for a look before it is read."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from cytodisk.checks import is_path
from cytodisk.images.chosen_channels import names_after, stem_of
from cytodisk.images.formats.microscope.czi_file import czi_scenes
from cytodisk.images.formats.microscope.lif_file import lif_scenes
from cytodisk.images.formats.microscope.nd2_file import nd2_scenes
from cytodisk.images.formats.microscope.zarr_file import zarr_scenes
from cytodisk.images.frames import open_frames
from cytodisk.images.image_paths import is_zarr
from cytodisk.images.reading import reading
from cytodisk.images.scenes import Scene

_MOST_LINES = 50
_SCENES = {".nd2": nd2_scenes, ".czi": czi_scenes, ".lif": lif_scenes}


@dataclass(frozen=True)
class FileContents:
    """What an image file holds.

    Attributes
    ----------
    path : Path
    scenes : tuple of Scene
        One in most files.
    """

    path: Path
    scenes: tuple[Scene, ...]

    @property
    def lines(self) -> tuple[str, ...]:
        """In words, a line a scene."""
        if len(self.scenes) == 1:
            return (f"{self.path.name}: {self._words(self.scenes[0])}",)
        shown = list(enumerate(self.scenes))[:_MOST_LINES]
        more = len(self.scenes) - len(shown)
        return (
            f"{self.path.name}: {len(self.scenes)} scenes",
            *(f"  scene {number} ({scene.name}): {self._words(scene)}" for number, scene in shown),
            *([f"  … and {more} more"] if more else []),
        )

    def _words(self, scene: Scene) -> str:
        """What a scene holds, with the names that a run gives to channels without one."""
        return scene.words_with(names_after(stem_of(self.path.name), len(scene.channels)))


def contents(path: str | os.PathLike[str]) -> FileContents:
    """What an image file holds: scenes, channels, slices in z, frames, scale; no pixels are read.

    Parameters
    ----------
    path : path-like
        Any image file that can be read.

    Returns
    -------
    FileContents
        For a microscope file all that can be chosen, also scenes that cannot be read, with the reason.

    Raises
    ------
    ReadError
        The file is missing or damaged, or has axes that cannot be used.
    MissingPartError
        Its format needs a package that is not installed.
    ParameterError
        `path` is no path.

    Examples
    --------
    >>> import numpy as np
    >>> from cytodisk.images.contents import contents
    >>> np.save("cells.npy", np.zeros((3, 20, 30), np.uint8))
    >>> print(*contents("cells.npy").lines)
    cells.npy: 3 frames, 1 channel, 20 × 30 px of uint8
    """
    is_path("path", path)
    file = Path(path)
    if holds_scenes(file):
        with reading(file, "its header"):
            return FileContents(
                file, zarr_scenes(file) if is_zarr(file) else _SCENES[file.suffix.lower()](file)
            )
    found = open_frames(file)
    scene = Scene(
        file.name,
        found.n_frames,
        1,
        ("",) * len(found.channels) if found.unnamed else found.channels,
        found.image_shape,
        found.dtype,
        found.scale,
        found.notes,
    )
    return FileContents(file, (scene,))


def holds_scenes(path: Path) -> bool:
    """Whether a file, or a Zarr folder, is of a format in which there is much to choose."""
    return is_zarr(path) or (path.suffix.lower() in _SCENES and path.is_file())
