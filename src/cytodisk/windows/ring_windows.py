"""Rings and wedges around a cell's deepest point, as CellProfiler's radial distribution divides objects."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from skimage.graph import MCP_Geometric

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import Scale
from cytodisk.taking import takes
from cytodisk.windows.edge_windows import CellEdge
from cytodisk.windows.grid_parameters import CountParameters, RingWindowParameters
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.pixel_shares.shares import PER_SIDE
from cytodisk.windows.pixel_shares.subpixels import subpixel_places


@dataclass(frozen=True)
class RingGrid:
    """Rings by the share of the way from the edge (0) to the deepest point, wedges by angle around it.

    Attributes
    ----------
    layers, sectors : int

    Raises
    ------
    WindowError
        A count is not a positive whole number.

    See Also
    --------
    ring_windows : The same in one step.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.RingGrid(layers=3, sectors=8).on(cd.simulate.disk(20))
    >>> windows.layers, windows.sectors
    (3, 8)
    """

    layers: int
    sectors: int

    def __post_init__(self) -> None:
        CountParameters(layers=self.layers, sectors=self.sectors)

    def on(self, disk: DiskMap) -> RingWindows:
        """Lay the grid over a cell.

        Parameters
        ----------
        disk : DiskMap
            Its mask and outline are used, its inside is not.

        Returns
        -------
        RingWindows
        """
        return RingWindows(self, CellEdge.of(disk))


@dataclass(frozen=True, eq=False)
class RingWindows(WindowsOnCell):
    """Rings and wedges in a cell; they cover it, but a wedge may take in several arms of it.

    Near the deepest point windows of a fine grid are too small to hold a subpixel: they are empty.

    Attributes
    ----------
    grid : RingGrid
    edge : CellEdge

    See Also
    --------
    CellWindows : Windows of a map, of equal area.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.ring_windows(cd.simulate.disk(20), layers=3, sectors=8)
    >>> windows.areas.shape
    (3, 8)
    """

    grid: RingGrid
    edge: CellEdge

    @cached_property
    def _ways(self) -> FloatArray:
        """Length of the way from the deepest pixel to each pixel, shape (H, W)."""
        return _way_from(self.edge.deepest[0], self.mask)

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels lies in, shape (P, 16).

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        depth, _ = self.edge.subpixels_of(pixels_yx)
        centre, _ = self.edge.deepest
        away = subpixel_places(pixels_yx, PER_SIDE) - centre
        beyond = np.linalg.norm(away, axis=-1) - np.linalg.norm(pixels_yx - centre, axis=-1)[:, None]
        way = np.maximum(self._ways[tuple(pixels_yx.T)][:, None] + beyond, 0.0)
        share = depth / np.maximum(depth + way, 1e-12)
        layer = np.minimum((share * self.layers).astype(np.int64), self.layers - 1)
        turn = np.mod(np.arctan2(away[..., 0], away[..., 1]) / (2.0 * np.pi), 1.0)
        sector = np.minimum((turn * self.sectors).astype(np.int64), self.sectors - 1)
        return np.asarray(layer * self.sectors + sector)

    @property
    def mask(self) -> BoolArray:
        """The cell's mask, its holes filled, shape (H, W) and dtype bool."""
        return self.edge.mask

    @property
    def holes(self) -> PlacedMask | None:
        """Holes in the mask that belong to no window."""
        return self.edge.holes

    @property
    def outline_yx(self) -> FloatArray:
        """Outline of the cell, shape (B, 2), (row, column) in pixels."""
        return self.edge.outline_yx

    @property
    def scale(self) -> Scale:
        """Scale of the cell's image."""
        return self.edge.scale


@takes(RingWindowParameters)
def ring_windows(cell: Any, *in_order: Any, **settings: Any) -> RingWindows:
    """Rings and wedges around the deepest point of one cell, to compare with `polar_windows`.

    A place belongs to a ring by d_edge / (d_edge + d_centre), its distance from the edge over the sum of
    that and of its way through the cell from the deepest point; and to a wedge by its angle around that.

    Parameters
    ----------
    cell : array_like of shape (H, W), or DiskMap
        A mask, which `clean_mask` cleans, or a map, of which only the mask is used.
    **settings
        See `RingWindowParameters`; `holes` is for masks, a map has its own.

    Returns
    -------
    RingWindows
        Sector 0 begins at +x and goes towards +y.

    Raises
    ------
    MaskError
        The mask is not that of one cell.
    WindowError
        A count is not a positive whole number.

    See Also
    --------
    polar_windows : Windows of equal area by the map onto the disk.
    edge_windows : Windows by distance from the edge, as the field's.

    References
    ----------
    Carpenter et al., "CellProfiler", Genome Biology 7:R100 (2006), doi:10.1186/gb-2006-7-10-r100:
    MeasureObjectIntensityDistribution, in which layers are counted from the centre.

    Examples
    --------
    >>> import cytodisk as cd
    >>> mask = cd.simulate.star(arms=3, body_radius=12, arm_length=20)
    >>> windows = cd.ring_windows(mask, layers=3, sectors=8)
    >>> round(windows.coverage, 6)
    1.0
    """
    chosen = RingWindowParameters.of(*in_order, **settings)
    grid = RingGrid(chosen.layers, chosen.sectors)
    return RingWindows(grid, CellEdge.of(cell, chosen.holes))


def _way_from(centre: Any, mask: BoolArray) -> FloatArray:
    """Length of the shortest way from one pixel to each pixel through the mask, shape (H, W)."""
    walker = MCP_Geometric(np.where(mask, 1.0, np.inf))
    lengths, _ = walker.find_costs([tuple(int(step) for step in centre)])
    return np.asarray(lengths, dtype=np.float64)
