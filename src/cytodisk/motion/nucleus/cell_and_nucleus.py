"""A cell and its nucleus in one frame of a movie, as they come."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import shapely

from cytodisk.arrays import FloatArray
from cytodisk.geometry.placed_mask import PlacedMask

_JUST_OUTSIDE = -0.75  # px: how far outside an outline a pixel that makes up for a rounded one may lie


@dataclass(frozen=True, eq=False)
class CellAndNucleus:
    """Masks of a cell and of its nucleus in one frame.

    Attributes
    ----------
    mask : array_like of shape (H, W), PlacedMask, or CytodiskError
        The cell, or its box, or why there is none.
    nucleus : array_like, or CytodiskError
        Of the shape of the mask or of its box; or why there is none.
    """

    mask: Any
    nucleus: Any

    def with_nucleus(self, nucleus: PlacedMask) -> CellAndNucleus:
        """The same cell with another nucleus; its box has room for both."""
        if not isinstance(self.mask, PlacedMask):
            return replace(self, nucleus=nucleus.whole)
        mask = with_room(self.mask, nucleus.slices)
        return CellAndNucleus(mask, mask.cut_out_of(nucleus.whole))


def with_room(mask: PlacedMask, room: tuple[slice, slice]) -> PlacedMask:
    """A mask whose box has room for another one, too.

    Parameters
    ----------
    mask : PlacedMask
    room : (slice, slice)
        Rows and columns that the box is to cover.

    Returns
    -------
    PlacedMask
    """
    sides = [
        slice(min(own.start, other.start), max(own.stop, other.stop))
        for own, other in zip(mask.slices, room, strict=True)
    ]
    if tuple(sides) == mask.slices:
        return mask
    box = np.zeros([side.stop - side.start for side in sides], dtype=mask.box.dtype)
    (y, x), (height, width) = mask.corner, mask.box.shape
    top, left = y - sides[0].start, x - sides[1].start
    box[top : top + height, left : left + width] = mask.box
    return PlacedMask(box, (sides[0].start, sides[1].start), mask.image_shape)


def drawn(outline_yx: FloatArray, area_px: int, image_shape: tuple[int, int]) -> PlacedMask:
    """Mask of an outline with a given number of pixels, those that lie deepest in it.

    Parameters
    ----------
    outline_yx : ndarray of shape (N, 2) and dtype float
    area_px : int
        So many, unless the image ends before.
    image_shape : (int, int)

    Returns
    -------
    PlacedMask
        Without a pixel if the outline lies outside the image.
    """
    low = np.clip(np.floor(outline_yx.min(axis=0)).astype(int) - 1, 0, image_shape)
    high = np.clip(np.ceil(outline_yx.max(axis=0)).astype(int) + 2, low + 1, np.add(image_shape, 1))
    y, x = np.mgrid[low[0] : high[0], low[1] : high[1]].reshape(2, -1)
    pixels, polygon = shapely.points(y, x), shapely.Polygon(outline_yx)
    away = shapely.distance(pixels, polygon.exterior)
    depth = np.where(shapely.contains(polygon, pixels), away, -away)
    depth[(y >= image_shape[0]) | (x >= image_shape[1])] = -np.inf
    deepest = np.argsort(-depth, kind="stable")[:area_px]
    deepest = deepest[depth[deepest] > _JUST_OUTSIDE]
    box = np.zeros(high - low, dtype=bool)
    box[y[deepest] - low[0], x[deepest] - low[1]] = True
    room = np.minimum(high, image_shape) - low
    return PlacedMask(box[: room[0], : room[1]], (int(low[0]), int(low[1])), image_shape)
