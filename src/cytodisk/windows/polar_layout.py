"""`PolarLayout`: how a polar grid divides the unit disk."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.errors import WindowError
from cytodisk.windows.grid_parameters import Spacing


@dataclass(frozen=True)
class PolarLayout:
    """Layers from the edge (0) inwards, sectors from angle 0 (+u) towards +v.

    Window (layer, sector) has number layer · sectors + sector.

    Attributes
    ----------
    layers, sectors : int
    spacing : {"area", "radius"}
    depth_um : tuple of float or None
        Depths of the borders between layers in µm, one less than there are layers; then the radii differ from
        cell to cell.
    borders : tuple of float or None
        Radii of these borders in one cell, decreasing; 0 for layers that are deeper than the cell.
    """

    layers: int
    sectors: int
    spacing: Spacing = "area"
    depth_um: tuple[float, ...] | None = None
    borders: tuple[float, ...] | None = None

    @property
    def n_windows(self) -> int:
        """layers × sectors."""
        return self.layers * self.sectors

    @cached_property
    def radii(self) -> FloatArray:
        """Radii between layers, from 1 at the edge to 0 at the centre, shape (layers + 1,).

        Raises
        ------
        WindowError
            The borders between layers are given by their depth, and the grid is not on a cell yet.
        """
        if self.borders is not None:
            return np.array([1.0, *self.borders, 0.0])
        if self.depth_um is not None:
            raise WindowError(
                "the radii of a grid by depth_um differ from cell to cell: take the grid of the windows on "
                "one, grid.on(disk).grid"
            )
        steps = np.linspace(1.0, 0.0, self.layers + 1)
        return np.sqrt(steps) if self.spacing == "area" else steps

    @property
    def present(self) -> BoolArray:
        """Whether each layer is one of the cell, not deeper than it, shape (layers,)."""
        if self.borders is None:
            return np.ones(self.layers, dtype=bool)
        return np.asarray(self.radii[:-1] > 0.0)

    @cached_property
    def angles(self) -> FloatArray:
        """Angles between sectors in radians, from 0 to 2π, shape (sectors + 1,)."""
        return np.linspace(0.0, 2.0 * np.pi, self.sectors + 1)

    @cached_property
    def centres_uv(self) -> FloatArray:
        """Middle of each window in the disk, half of its area on either side, shape (windows, 2)."""
        outer, inner = self.radii[:-1], self.radii[1:]
        radius = np.sqrt(0.5 * (outer**2 + inner**2))[:, None]
        angle = 0.5 * (self.angles[:-1] + self.angles[1:])
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1).reshape(-1, 2)

    def window_of(self, points_uv: FloatArray) -> IntArray:
        """Number of the window that holds each point.

        Parameters
        ----------
        points_uv : ndarray of shape (N, 2) and dtype float
            (u, v) in the disk; points on or beyond the rim belong to layer 0.

        Returns
        -------
        ndarray of shape (N,) and dtype int
        """
        radius = np.hypot(points_uv[:, 0], points_uv[:, 1])
        layer = np.searchsorted(-self.radii[1:-1], -radius, side="left")
        turn = np.arctan2(points_uv[:, 1], points_uv[:, 0]) / (2.0 * np.pi)
        sector = np.floor(np.mod(turn, 1.0) * self.sectors).astype(np.int64)
        return np.asarray(layer * self.sectors + np.minimum(sector, self.sectors - 1))
