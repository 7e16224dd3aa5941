"""Pictures of a cell by frame: its pixels, and which window each of them lies in."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.ndimage import binary_dilation

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ReadError
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.images.signal_files import FrameSource, load_image
from cytodisk.pages.report.boxes import Box
from cytodisk.pages.report.encode import grey_levels, pack_labels, pack_picture
from cytodisk.pages.report.shown_cell import ShownCell
from cytodisk.windows.polar_windows import PolarGrid

OUTSIDE = 65535
"""Label of a pixel outside the cell."""

_SAMPLE = 3  # frames that are encoded to estimate the size of all
_PERCENTILES = (0.5, 99.9)


def window_labels(disk: DiskMap, grid: PolarGrid, box: Box) -> Any:
    """Number of the window at each pixel of a picture.

    Parameters
    ----------
    disk : DiskMap
    grid : PolarGrid
    box : Box

    Returns
    -------
    ndarray of shape (H, W) and dtype uint16
        `OUTSIDE` outside the cell.
    """
    y, x = box.axes_yx
    row, column = np.nonzero(_near(disk.placed_mask, box))
    uv = disk.to_disk(np.column_stack([y[row], x[column]]))
    inside = np.isfinite(uv[:, 0])
    labels = np.full(box.shape, OUTSIDE, dtype=np.uint16)
    own = grid.on(disk).grid  # with the radii of this map
    labels[row[inside], column[inside]] = np.minimum(own.window_of(uv[inside]), OUTSIDE - 1)
    return labels


def _near(placed: PlacedMask, box: Box) -> BoolArray:
    """Pixels of a picture at the mask or next to it: the outline is nowhere further from it."""
    near = binary_dilation(np.pad(placed.box, 1), np.ones((3, 3), dtype=bool))
    rows, columns = (
        np.floor(along + 0.5).astype(int) - first + 1
        for along, first in zip(box.axes_yx, placed.corner, strict=True)
    )
    in_rows, in_columns = (
        (place >= 0) & (place < size) for place, size in zip((rows, columns), near.shape, strict=True)
    )
    found = np.zeros(box.shape, dtype=bool)
    found[np.ix_(in_rows, in_columns)] = near[np.ix_(rows[in_rows], columns[in_columns])]
    return found


def resampled(image: Any, box: Box) -> FloatArray:
    """The box's part of an image: mean over the pixels that fall together, or interpolated.

    Parameters
    ----------
    image : array_like of shape (H, W)
    box : Box

    Returns
    -------
    ndarray of the box's shape and dtype float
    """
    values = np.asarray(image, dtype=np.float64)
    if box.repeats_pixels:
        return np.asarray(box.nearest(values))
    part = values[box.top : box.top + box.height, box.left : box.left + box.width]
    return _shares(part.shape[0], box.shape[0]) @ part @ _shares(part.shape[1], box.shape[1]).T


def _shares(before: int, after: int) -> FloatArray:
    """Weights of old pixels in fewer new ones along an axis, shape (after, before)."""
    edges = np.linspace(0, before, after + 1)
    low = np.maximum(edges[:-1, None], np.arange(before))
    high = np.minimum(edges[1:, None], np.arange(1, before + 1))
    overlap = np.maximum(high - low, 0.0)
    return np.asarray(overlap / overlap.sum(axis=1, keepdims=True))


def grey_picture(image: Any, box: Box, low: float, high: float) -> Any:
    """Grey levels of the box's part of an image, of the box's shape and dtype uint8; see `grey_levels`."""
    if box.repeats_pixels:  # first the few pixels, then their copies
        return box.nearest(grey_levels(image, low, high))
    return grey_levels(resampled(image, box), low, high)


def picture_limits(images: Sequence[FloatArray]) -> tuple[float, float]:
    """Black and white for some images of one channel, the second above the first."""
    values = np.concatenate([image.ravel() for image in images]) if images else np.zeros(0)
    values = values[np.isfinite(values)]
    if not values.size:
        return 0.0, 1.0
    low, high = np.percentile(values, _PERCENTILES).tolist()
    return (low, high) if high > low else (low - 0.5, low + 0.5)


@dataclass(frozen=True, eq=False)
class Pictures:
    """Encoder of a cell's frames.

    Attributes
    ----------
    cell : ShownCell
    boxes : sequence of Box
        What is shown of each frame of the recording; all of one size.
    source : FrameSource or None
        Without one there are labels alone.
    """

    cell: ShownCell
    boxes: Sequence[Box]
    source: FrameSource | None

    def frame(self, time: int, limits: list[tuple[float, float]]) -> dict[str, Any]:
        """Labels and channels of a frame, each None where there is none."""
        labels = None
        if self.cell.maps.records[time].has_map:
            labels = pack_labels(window_labels(self.cell.maps[time], self.cell.grid, self.boxes[time]))
        pixels = self._pixels(time)
        if pixels is None:
            return {"labels": labels, "channels": None}
        pairs = zip(pixels, limits, strict=True)
        channels = [pack_picture(grey_picture(image, self.boxes[time], *pair)) for image, pair in pairs]
        return {"labels": labels, "channels": channels}

    def _pixels(self, time: int) -> Any:
        image = load_image(self.source, time)
        # A damaged image has its row and its flag in the study.
        return None if image is None or isinstance(image, ReadError) else image.to_numpy()

    def limits(self) -> list[tuple[float, float]]:
        """Black and white of each channel, from frames spread over the movie."""
        if self.source is None:
            return []
        found = [(self._pixels(time), self.boxes[time]) for time in self._spread()]
        known = [(pixels, box) for pixels, box in found if pixels is not None]
        channels = range(len(self.source.channels))
        return [picture_limits([resampled(pixels[k], box) for pixels, box in known]) for k in channels]

    def _spread(self) -> list[int]:
        frames = self.cell.frames
        return sorted({frames[round(k)] for k in np.linspace(0, len(frames) - 1, _SAMPLE)})

    def every(self, limits: list[tuple[float, float]], most: int) -> int:
        """Every so-manyth frame may be shown within so many bytes of text, judged by some frames."""
        largest = max(size_of(self.frame(time, limits)) for time in self._spread())
        return self.cell.every * max(1, int(np.ceil(largest * len(self.cell.frames) / most)))


def size_of(frame: dict[str, Any]) -> int:
    """Length of an encoded frame as text."""
    return len(frame["labels"] or "") + sum(len(text) for text in frame["channels"] or [])


def encode_frames(
    pictures: Pictures, limits: list[tuple[float, float]], progress: Callable[[int, int], None] | None
) -> Iterator[dict[str, Any]]:
    """Labels and channels of all shown frames, one after the other.

    Parameters
    ----------
    pictures : Pictures
    limits : list of (float, float)
        Black and white of each channel.
    progress : callable, optional
        Called with the number of frames done and that of all.

    Yields
    ------
    dict
        As `Pictures.frame`.
    """
    frames = pictures.cell.frames
    for number, time in enumerate(frames):
        yield pictures.frame(time, limits)
        if progress is not None:
            progress(number + 1, len(frames))
