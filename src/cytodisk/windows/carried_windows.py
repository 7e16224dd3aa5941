"""Windows of a reference cell that a displacement field carries to another shape of the cell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import Scale
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.pixel_shares.shares import NOWHERE, PER_SIDE
from cytodisk.windows.pixel_shares.subpixels import subpixel_places
from cytodisk.windows.polar_windows import PolarGrid


@dataclass(frozen=True, eq=False)
class CarriedWindows(WindowsOnCell):
    """Windows of a reference frame in another one; what comes from outside of the reference cell is in none.

    Attributes
    ----------
    grid : PolarGrid
    disk : DiskMap
        Map of the frame, of which the mask and the outline are used.
    reference : DiskMap
        Map of the reference frame, which the windows are on.
    to_reference : callable
        From places in this frame, (..., 2), to those in the reference frame, (row, column) in pixels.
    """

    grid: PolarGrid
    disk: DiskMap
    reference: DiskMap
    to_reference: Callable[[FloatArray], FloatArray]

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels comes from, shape (P, 16); -1 for none.

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        places = subpixel_places(pixels_yx, PER_SIDE)
        uv = self.reference.to_disk(self.to_reference(places).reshape(-1, 2))
        windows = np.full(len(uv), NOWHERE, dtype=np.int64)
        known = np.isfinite(uv[:, 0])
        windows[known] = self.grid.window_of(uv[known])
        return windows.reshape(places.shape[:2])

    @property
    def mask(self) -> BoolArray:
        """The cell's mask, its holes filled, shape (H, W) and dtype bool."""
        return self.disk.mask

    @property
    def holes(self) -> PlacedMask | None:
        """Holes in the mask that belong to no window."""
        return self.disk.holes

    @property
    def outline_yx(self) -> FloatArray:
        """Outline of the cell, shape (B, 2), (row, column) in pixels."""
        return self.disk.outline_yx

    @property
    def scale(self) -> Scale:
        """Scale of the cell's image."""
        return self.disk.scale
