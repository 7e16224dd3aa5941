"""`PolarLayout`: how a polar grid divides the unit disk."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from cytodisk.arrays import AnyArray, BoolArray, FloatArray, IntArray
from cytodisk.errors import WindowError
from cytodisk.windows.grid_parameters import Spacing


@dataclass(frozen=True)
class PolarLayout:
    """Layers from the edge (0) inwards, sectors from angle 0 (+u) towards +v.

    Window (layer, sector) has number layer · sectors + sector. With a nucleus, layers of the cytoplasm come
    first, those of the nucleus follow.

    Attributes
    ----------
    layers, sectors : int
        All layers, those of the nucleus too.
    spacing : {"area", "radius"}
        Within the cytoplasm, and within the nucleus.
    depth_um : tuple of float or None
        Depths of the borders between layers in µm, one less than there are layers from the edge to the
        nucleus or the centre; then the radii differ from cell to cell.
    borders : tuple of float or None
        Radii of these borders in one cell, decreasing; for layers that are deeper than the cell or its
        cytoplasm the radius of the nucleus, or 0.
    nucleus_layers : int
        How many of the layers are in the nucleus, the last ones.
    nucleus_radius : float or None
        Of the nucleus in the disk of one cell, or of all cells of a study.
    """

    layers: int
    sectors: int
    spacing: Spacing = "area"
    depth_um: tuple[float, ...] | None = None
    borders: tuple[float, ...] | None = None
    nucleus_layers: int = 0
    nucleus_radius: float | None = None

    @property
    def n_windows(self) -> int:
        """layers × sectors."""
        return self.layers * self.sectors

    @property
    def cytoplasm_layers(self) -> int:
        """How many of the layers are not in the nucleus, the first ones."""
        return self.layers - self.nucleus_layers

    @property
    def compartments(self) -> AnyArray:
        """Compartment of each layer, "cytoplasm" or "nucleus", or "cell" without a nucleus; (layers,)."""
        outer = "cytoplasm" if self.nucleus_layers else "cell"
        return np.array([outer] * self.cytoplasm_layers + ["nucleus"] * self.nucleus_layers)

    @property
    def of_any_cell(self) -> Self:
        """The same grid without the radii of one cell."""
        return replace(self, borders=None, nucleus_radius=None)

    def with_radii(self, radii: FloatArray) -> Self:
        """The same grid with radii between layers that cells have, or have on average, (layers + 1,)."""
        last = self.cytoplasm_layers
        borders = None if self.depth_um is None else tuple(radii[1:last].tolist())
        nucleus_radius = float(radii[last]) if self.nucleus_layers else None
        return replace(self, borders=borders, nucleus_radius=nucleus_radius)

    @property
    def has_radii(self) -> bool:
        """Whether the radii are known: those of any cell, or of the one that the grid is on."""
        by_depth = self.depth_um is not None and self.borders is None
        return not by_depth and (not self.nucleus_layers or self.nucleus_radius is not None)

    @cached_property
    def radii(self) -> FloatArray:
        """Radii between layers, from 1 at the edge to 0 at the centre, shape (layers + 1,).

        Raises
        ------
        WindowError
            The borders between layers are given by their depth, or there are layers of a nucleus, and the
            grid is not on a cell yet.
        """
        within = self._nucleus_radius
        if self.borders is not None:
            outer = np.array([1.0, *self.borders, within])
        elif self.depth_um is not None:
            raise WindowError(_ON_A_CELL.format("by depth_um"))
        else:
            outer = _radii(self.cytoplasm_layers, self.spacing, within)
        if not self.nucleus_layers:
            return outer
        return np.concatenate([outer, within * _radii(self.nucleus_layers, self.spacing)[1:]])

    @property
    def _nucleus_radius(self) -> float:
        """Radius at which the layers from the edge end; 0 without a nucleus."""
        if not self.nucleus_layers:
            return 0.0
        if self.nucleus_radius is None:
            raise WindowError(_ON_A_CELL.format("with nucleus_layers"))
        return self.nucleus_radius

    @property
    def present(self) -> BoolArray:
        """Whether each layer is one of the cell, not deeper than it or its cytoplasm, shape (layers,)."""
        if self.borders is None:
            return np.ones(self.layers, dtype=bool)
        return np.asarray(self.radii[:-1] > self.radii[1:])

    @cached_property
    def area_shares(self) -> FloatArray:
        """Share of its compartment's area in the disk that each window of a layer has, shape (layers,)."""
        squares = np.square(self.radii)
        border = squares[self.cytoplasm_layers]
        whole = np.where(np.arange(self.layers) < self.cytoplasm_layers, 1.0 - border, border)
        return np.asarray(-np.diff(squares) / (whole * self.sectors))

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
            (u, v) in the disk; points on or beyond the rim belong to layer 0, those on the nuclear outline to
            the cytoplasm.

        Returns
        -------
        ndarray of shape (N,) and dtype int
        """
        radius = np.hypot(points_uv[:, 0], points_uv[:, 1])
        layer = np.searchsorted(-self.radii[1:-1], -radius, side="left")
        return np.asarray(layer * self.sectors + self.sector_of(points_uv))

    def sector_of(self, points_uv: FloatArray) -> IntArray:
        """Sector that holds each point of the disk, (u, v) of shape (N, 2); shape (N,)."""
        turn = np.arctan2(points_uv[:, 1], points_uv[:, 0]) / (2.0 * np.pi)
        sector = np.floor(np.mod(turn, 1.0) * self.sectors).astype(np.int64)
        return np.asarray(np.minimum(sector, self.sectors - 1))


_ON_A_CELL = (
    "the radii of a grid {} differ from cell to cell: take the grid of the windows on one, grid.on(disk).grid"
)


def _radii(layers: int, spacing: Spacing, within: float = 0.0) -> FloatArray:
    """Radii from 1 to the one within, by equal shares of the area between or in equal steps."""
    if not within:
        steps = np.linspace(1.0, 0.0, layers + 1)
        return np.sqrt(steps) if spacing == "area" else steps
    if spacing == "radius":
        return np.linspace(1.0, within, layers + 1)
    radii = np.sqrt(np.linspace(1.0, within * within, layers + 1))
    radii[-1] = within
    return radii
