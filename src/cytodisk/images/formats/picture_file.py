"""PNG files."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Lock
from typing import Any, BinaryIO

import imageio.v3 as imageio
import numpy as np
from PIL import Image

from cytodisk.errors import ReadError
from cytodisk.images.chosen_channels import COLOURS, channel_names
from cytodisk.images.claims import check_claim, check_memory
from cytodisk.images.file_axes import file_axes
from cytodisk.images.frame_file import Cut, FileChoice, FrameFile, as_channels_first

_PNG: dict[str, Any] = {"extension": ".png", "plugin": "pillow"}
PALETTE = (
    "its pixels are numbers of a palette's colours, which are taken as labels; as a signal they mean "
    "nothing: save it in shades of grey"
)
"""What to say of a picture that stores the numbers of colours."""
_SIGNATURE = b"\x89PNG\r\n\x1a\n"
_SAMPLES = {0: 1, 2: 3, 3: 1, 4: 2, 6: 4}  # of a pixel, by type of colour
_COPIES = 3  # of the pixels that decoding holds at once

_limit_lifted = Lock()


def open_picture(file: Path, unnamed: str, choice: FileChoice) -> FrameFile:
    """Look at a PNG without reading its pixels; see `cytodisk.images.frames.open_frames`."""
    pixels = _checked_pixels(file)
    with file.open("rb") as opened, _of_any_size(pixels):  # imageio would leave a damaged file open
        palette = _palette(opened)
        properties = imageio.improps(opened, **_PNG)
    shape, dtype = tuple(properties.shape), properties.dtype
    notes: tuple[str, ...] = ()
    if palette is not None:
        shape, dtype = shape[:2], np.dtype(np.uint8)
        notes = () if _is_grey(palette) else (PALETTE,)
    known = file_axes(file, "YXC"[: len(shape)], shape, unnamed, choice.axes)
    colours = COLOURS[shape[2]] if known.letters == "YXC" else ()
    return FrameFile(
        file,
        known.letters,
        known.shape,
        dtype,
        channel_names(colours, known.shape[known.letters.index("C")] if "C" in known.letters else 1),
        PictureFrames(file, known.letters),
        notes=notes,
        said_by=known.said_by,
    )


def _palette(opened: BinaryIO) -> np.ndarray[Any, Any] | None:
    """Colours of a picture that stores their numbers, shape (N, 3); None for any other. Reads no pixels."""
    with Image.open(opened) as picture:
        found = picture.getpalette() if picture.mode == "P" else None
    opened.seek(0)
    return None if found is None else np.array(found, dtype=np.uint8).reshape(-1, 3)


def _is_grey(palette: np.ndarray[Any, Any]) -> bool:
    return bool((palette == palette[:, :1]).all())


def _checked_pixels(file: Path) -> int:
    """How many pixels a PNG claims, compared with its own size before anything is allocated."""
    with file.open("rb") as opened:
        head = opened.read(29)
    if head[:8] != _SIGNATURE or len(head) < 29:
        raise ReadError(
            f"{file} cannot be read as an image: it is no PNG, or is damaged; save it as PNG or TIFF"
        )
    width, height = (int.from_bytes(head[place : place + 4]) for place in (16, 20))
    bits = head[24] * _SAMPLES.get(head[25], 1)
    check_claim(file, (height, math.ceil(width * bits / 8)), np.dtype(np.uint8), codec="zlib")
    check_memory(
        file, "the picture", _COPIES * height * width * math.ceil(bits / 8), "save it as TIFF, in tiles"
    )
    return height * width


@contextmanager
def _of_any_size(pixels: int) -> Iterator[None]:
    """Lift the limit that Pillow has against pictures from strangers; this one's size was looked at."""
    if Image.MAX_IMAGE_PIXELS is None or pixels <= Image.MAX_IMAGE_PIXELS:
        yield
        return
    with _limit_lifted:
        before, Image.MAX_IMAGE_PIXELS = Image.MAX_IMAGE_PIXELS, None
        try:
            yield
        finally:
            Image.MAX_IMAGE_PIXELS = before


@dataclass(frozen=True)
class PictureFrames:
    """The one frame of a picture, or its colours as frames where a user says so.

    Attributes
    ----------
    path : Path
    axes : str
    """

    path: Path
    axes: str

    def read(self, number: int) -> np.ndarray[Any, Any]:
        """Its pixels, shape (C, H, W)."""
        pixels = _checked_pixels(self.path)
        with self.path.open("rb") as opened, _of_any_size(pixels):
            palette = _palette(opened)
            if palette is None:
                values = np.asarray(imageio.imread(opened, **_PNG))
            else:
                with Image.open(opened) as picture:
                    numbers = np.asarray(picture)
                values = palette[numbers, 0] if _is_grey(palette) else numbers
        taken = values[tuple(number if axis == "T" else slice(None) for axis in self.axes)]
        return as_channels_first(taken, self.axes)

    def by_piece(self, number: int) -> tuple[Cut, int] | None:
        """None: a PNG is one piece."""
        return None
