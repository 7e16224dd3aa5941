"""`WindowsAroundNucleus`: what windows between a cell's edge and its nucleus have in common."""

from __future__ import annotations

from dataclasses import dataclass

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import Scale
from cytodisk.windows.on_cell import Grid, WindowsOnCell
from cytodisk.windows.rings.nucleus_edges import NucleusEdges


@dataclass(frozen=True, eq=False)
class WindowsAroundNucleus(WindowsOnCell):
    """Windows that follow from the two outlines of a cell, without a map.

    Attributes
    ----------
    grid : Grid
    edges : NucleusEdges
    """

    grid: Grid
    edges: NucleusEdges

    @property
    def mask(self) -> BoolArray:
        """The cell's mask, shape (H, W) and dtype bool."""
        return self.edges.cell.mask

    @property
    def holes(self) -> PlacedMask | None:
        """Holes in the mask that belong to no window."""
        return self.edges.cell.holes

    @property
    def nucleus_mask(self) -> BoolArray:
        """The nucleus' mask, shape (H, W) and dtype bool."""
        return self.edges.nucleus.mask

    @property
    def outline_yx(self) -> FloatArray:
        """Outline of the cell, shape (B, 2), (row, column) in pixels."""
        return self.edges.cell.outline_yx

    @property
    def scale(self) -> Scale:
        """Scale of the cell's image."""
        return self.edges.cell.scale
