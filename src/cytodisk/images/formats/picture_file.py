"""PNG files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import imageio.v3 as imageio
import numpy as np

from cytodisk.images.frame_file import Cut, FileChoice, FrameFile, as_channels_first

_PNG: dict[str, Any] = {"extension": ".png", "plugin": "pillow"}
_COLOURS = {3: ("red", "green", "blue"), 4: ("red", "green", "blue", "alpha"), 2: ("grey", "alpha")}


def open_picture(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a PNG without reading its pixels; see `cytodisk.images.frames.open_frames`."""
    with file.open("rb") as opened:  # imageio leaves a damaged file open when it opens it itself
        properties = imageio.improps(opened, **_PNG)
    shape = tuple(properties.shape)
    axes, names = ("YX", ("0",)) if len(shape) == 2 else ("YXC", _COLOURS[shape[2]])
    return FrameFile(file, axes, shape, properties.dtype, names, PictureFrames(file, axes))


@dataclass(frozen=True)
class PictureFrames:
    """The one frame of a picture.

    Attributes
    ----------
    path : Path
    axes : str
    """

    path: Path
    axes: str

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Its pixels, shape (C, H, W)."""
        with self.path.open("rb") as opened:
            return as_channels_first(np.asarray(imageio.imread(opened, **_PNG)), self.axes)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """None: a PNG is one piece."""
        return None
