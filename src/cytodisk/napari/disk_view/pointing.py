"""From a place in the viewer to one in the disk, and back."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray

_ROLES = ("windows", "values", "outlines", "velocity", "points")


@dataclass(frozen=True)
class Pointed:
    """A window, and a place in it.

    Attributes
    ----------
    cell : int
    window : (int, int)
        Its layer and sector.
    uv : (float, float)
        In the disk.
    by_disk : bool
        Whether the cursor is in the disk, rather than in the cell.
    """

    cell: int
    window: tuple[int, int]
    uv: tuple[float, float]
    by_disk: bool = False


class ViewerPlaces:
    """Where the pixels of a study lie in a viewer.

    Parameters
    ----------
    viewer : Viewer
    layer : Layer
        With the axes (time,) y, x, its last two in pixels of the masks.
    """

    def __init__(self, viewer: Any, layer: Any):
        self.viewer, self.layer = viewer, layer

    @classmethod
    def of(cls, shown: Any) -> ViewerPlaces | None:
        """Places of a study; None if none of its layers is open any more."""
        layer = next((shown.layers[role] for role in _ROLES if role in shown.layers), None)
        return None if layer is None or shown.viewer is None else cls(shown.viewer, layer)

    @property
    def is_flat(self) -> bool:
        """Whether the viewer shows rows and columns, one image at a time."""
        dims = self.viewer.dims
        return tuple(dims.displayed) == (dims.ndim - 2, dims.ndim - 1)

    def pixel(self, world: Sequence[float]) -> tuple[float, float] | None:
        """(row, column) of a position of the viewer; None if it shows something else than images."""
        if not self.is_flat or len(world) < self.layer.ndim:
            return None
        row, column = (float(place) for place in self.layer.world_to_data(tuple(world))[-2:])
        return row, column

    def scene_xy(self, points_yx: FloatArray) -> FloatArray:
        """Points in pixels, shape (N, 2), → (x, y) on the canvas' scene."""
        before = (0.0,) * (self.layer.ndim - 2)
        corner, down, right = (
            np.array(self.layer.data_to_world((*before, *yx))[-2:], dtype=np.float64)
            for yx in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))
        )
        world = corner + points_yx[:, :1] * (down - corner) + points_yx[:, 1:] * (right - corner)
        return world[:, ::-1]

    def go_to(self, frame: int) -> None:
        """Move the slider to a frame."""
        if self.layer.ndim < 3:
            return
        place = float(self.layer.data_to_world((float(frame), 0.0, 0.0))[0])
        self.viewer.dims.set_point(self.viewer.dims.ndim - self.layer.ndim, place)


def pointed_in_cell(shown: Any, frame: int, yx: tuple[float, float]) -> Pointed | None:
    """The window under a place of the image; None outside cells that have a map.

    Parameters
    ----------
    shown : ShownStudy
    frame : int
    yx : (float, float)
        (row, column) in pixels.
    """
    found = shown.window_at(frame, yx)
    if found is None:
        return None
    cell, layer, sector = found
    u, v = shown.map_at(cell, frame).to_disk([yx], outside="nearest")[0].tolist()
    return Pointed(cell, (layer, sector), (u, v))


def pointed_in_disk(shown: Any, cell: int, frame: int, uv: tuple[float, float]) -> Pointed:
    """The window that holds a place of the disk.

    Parameters
    ----------
    shown : ShownStudy
    cell : int
        Has a map in the frame.
    frame : int
    uv : (float, float)
    """
    grid = shown.windows_at(cell, frame).grid
    layer, sector = divmod(int(grid.window_of(np.array([uv]))[0]), grid.sectors)
    return Pointed(cell, (layer, sector), uv, by_disk=True)
