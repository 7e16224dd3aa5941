"""`WindowsOnMap`: windows on a cell that take what they need to know of it from its map."""

from __future__ import annotations

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import Scale
from cytodisk.windows.on_cell import WindowsOnCell


class WindowsOnMap(WindowsOnCell):
    """Windows on a cell that has a map."""

    disk: DiskMap

    @property
    def mask(self) -> BoolArray:
        """The cell's mask, its holes filled, shape (H, W) and dtype bool."""
        return self.disk.mask

    @property
    def placed_mask(self) -> PlacedMask:
        """The same as its box in the image."""
        return self.disk.placed_mask

    @property
    def holes(self) -> PlacedMask | None:
        """Holes in the mask that belong to no window; None if there are none, or they count as cell."""
        return self.disk.holes

    @property
    def outline_yx(self) -> FloatArray:
        """Outline of the cell, shape (B, 2), (row, column) in pixels."""
        return self.disk.outline_yx

    @property
    def scale(self) -> Scale:
        """Scale of the map."""
        return self.disk.scale
