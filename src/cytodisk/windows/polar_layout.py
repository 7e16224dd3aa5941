"""`PolarLayout`: how a polar grid divides the unit disk."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.errors import WindowError
from cytodisk.windows.grid_parameters import Spacing

_MOST_LAYERS = 1000  # that a depth is turned into


@dataclass(frozen=True)
class PolarLayout:
    """Layers from the edge (0) inwards, sectors from angle 0 (+u) towards +v.

    Window (layer, sector) has number layer · sectors + sector.

    Attributes
    ----------
    layers, sectors : int
    spacing : {"area", "radius"}
    """

    layers: int
    sectors: int
    spacing: Spacing = "area"

    @property
    def n_windows(self) -> int:
        """layers × sectors."""
        return self.layers * self.sectors

    @property
    def radii(self) -> FloatArray:
        """Radii between layers, from 1 at the edge to 0 at the centre, shape (layers + 1,)."""
        steps = np.linspace(1.0, 0.0, self.layers + 1)
        return np.sqrt(steps) if self.spacing == "area" else steps

    @property
    def angles(self) -> FloatArray:
        """Angles between sectors in radians, from 0 to 2π, shape (sectors + 1,)."""
        return np.linspace(0.0, 2.0 * np.pi, self.sectors + 1)

    @property
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


def layers_for_depth(depth: float, area: float, perimeter: float, spacing: Spacing = "area") -> int:
    """Number of layers whose first is about so thick on a cell.

    A band of thickness d along the edge is taken to have the area P d - π d², with P the perimeter: exact for
    convex cells, as long as the band does not fill them (Steiner's formula).

    Parameters
    ----------
    depth : float
        Thickness of the first layer, above 0.
    area, perimeter : float
        Area and perimeter of the cell, in the same unit of length.
    spacing : {"area", "radius"}

    Returns
    -------
    int
        At least 1.

    Raises
    ------
    WindowError
        `depth` is not above 0.
    """
    if not 0 < depth < np.inf:
        raise WindowError(f"depth must be above 0, got {depth!r}")
    counts = np.arange(1, _MOST_LAYERS + 1)
    return int(counts[np.abs(first_depth(counts, area, perimeter, spacing) - depth).argmin()])


def first_depth(layers: Any, area: float, perimeter: float, spacing: Spacing = "area") -> Any:
    """Thickness of the first of so many layers on a cell; see `layers_for_depth`.

    Parameters
    ----------
    layers : int, or ndarray of int
    area, perimeter : float
        Area and perimeter of the cell.
    spacing : {"area", "radius"}

    Returns
    -------
    float or ndarray of float
        In the unit of the perimeter.
    """
    share = 1.0 / layers if spacing == "area" else 1.0 - (1.0 - 1.0 / layers) ** 2
    root = np.sqrt(np.maximum(perimeter**2 - 4.0 * np.pi * share * area, 0.0))
    return (perimeter - root) / (2.0 * np.pi)
