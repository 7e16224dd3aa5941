"""Which part of an image a picture of a cell shows, and how finely."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.pages.movie_cell import MovieCell

LONGEST_SIDE = 400
"""Of a picture, in its own pixels."""

_MARGIN = 0.04  # of the box around the cell, on each side
_FINEST = 4  # labels a pixel and direction
_TRAVELS = 1.3  # a box so many times as long as the cell goes with it


@dataclass(frozen=True)
class Box:
    """The part of the image that is shown, and how finely.

    Attributes
    ----------
    top, left, height, width : int
        In pixels of the image.
    scale : float
        Pixels of the picture a pixel of the image.
    """

    top: int
    left: int
    height: int
    width: int
    scale: float

    @property
    def shape(self) -> tuple[int, int]:
        """(H, W) of the picture."""
        return max(1, round(self.height * self.scale)), max(1, round(self.width * self.scale))

    @property
    def repeats_pixels(self) -> bool:
        """Whether each pixel of the image stays a square of one colour."""
        return self.scale >= 1

    @property
    def axes_yx(self) -> tuple[FloatArray, FloatArray]:
        """Where the picture's rows and columns lie in the image, shapes (H,) and (W,)."""
        rows, columns = self.shape
        y = self.top - 0.5 + (np.arange(rows) + 0.5) * self.height / rows
        x = self.left - 0.5 + (np.arange(columns) + 0.5) * self.width / columns
        return y, x

    def nearest(self, image: Any) -> Any:
        """Value of an image, shape (H, W), at the pixel nearest to each pixel of the picture."""
        image = np.asarray(image)
        rows, columns = (
            np.clip(np.floor(along + 0.5).astype(int), 0, size - 1)
            for along, size in zip(self.axes_yx, image.shape, strict=True)
        )
        return image[np.ix_(rows, columns)]


def box_around(cell: MovieCell) -> Box:
    """The box that holds the cell in all frames.

    Parameters
    ----------
    cell : MovieCell
        With one mapped frame at least.

    Returns
    -------
    Box
        At most `LONGEST_SIDE` picture pixels long; finer than the image where the cell is small.
    """
    low, high = _corners(cell)
    return box_between(np.nanmin(low, axis=0), np.nanmax(high, axis=0), cell.maps.image_shape, LONGEST_SIDE)


def boxes_by_frame(cell: MovieCell) -> list[Box]:
    """What is shown of each frame of the recording: one box, or one that goes with a cell that travels.

    Parameters
    ----------
    cell : MovieCell
        With one mapped frame at least.

    Returns
    -------
    list of Box
        All of one size. A frame without a map has the box of the frame before it.
    """
    low, high = _corners(cell)
    whole = box_around(cell)
    largest = np.nanmax(high - low, axis=0)
    if max(whole.height, whole.width) <= _TRAVELS * (largest.max() + 2 * _margin(largest)):
        return [whole] * len(low)
    middles = pd.DataFrame((low + high) / 2).ffill().bfill().to_numpy()
    room = np.minimum(np.ceil(largest + 2 * _margin(largest)) + 1, cell.maps.image_shape)
    corners = np.clip(np.round(middles - room / 2), 0, np.array(cell.maps.image_shape) - room).astype(int)
    height, width = room.astype(int).tolist()
    scale = min(_FINEST, LONGEST_SIDE / max(height, width))
    return [Box(top, left, height, width, scale) for top, left in corners.tolist()]


def _corners(cell: MovieCell) -> tuple[FloatArray, FloatArray]:
    """Least and largest (row, column) of the outline in each frame, shapes (T, 2); NaN without a map."""
    low, high = (np.full((len(cell.maps.records), 2), np.nan) for _ in range(2))
    for time, record in enumerate(cell.maps.records):
        if record.boundary:
            outline = record.boundary.contour.outline_yx
            low[time], high[time] = outline.min(axis=0), outline.max(axis=0)
    return low, high


def _margin(size: FloatArray) -> float:
    return float(2 + _MARGIN * size.max())


def box_between(low: FloatArray, high: FloatArray, image_shape: Sequence[int], longest: int) -> Box:
    """The box with a margin around two corners (row, column), at most so many picture pixels long."""
    margin = _margin(high - low)
    top, left = np.maximum(np.floor(low - margin), 0).astype(int).tolist()
    bottom, right = np.minimum(np.ceil(high + margin) + 1, image_shape).astype(int).tolist()
    height, width = bottom - top, right - left
    return Box(top, left, height, width, min(_FINEST, longest / max(height, width)))
