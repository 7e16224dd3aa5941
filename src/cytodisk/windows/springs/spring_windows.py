"""Edge-based windows whose sides are springs: u-Register's idea, from the paper's words."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.taking import takes
from cytodisk.windows.edge_windows import CellEdge, EdgeGrid, EdgeWindows
from cytodisk.windows.pixel_shares.shares import PER_SIDE
from cytodisk.windows.pixel_shares.subpixels import subpixel_places
from cytodisk.windows.springs.layer_borders import Border
from cytodisk.windows.springs.spring_parameters import (
    EVENNESS,
    SpringGridParameters,
    SpringWindowParameters,
)
from cytodisk.windows.springs.spring_sides import CrossedBorder, Sides, cross_borders


@dataclass(frozen=True)
class SpringGrid(EdgeGrid):
    """Layers of equal depth from the edge (0) inwards, whose windows are evened out by springs.

    Attributes
    ----------
    layers, sectors : int
    depth_px : float
        Thickness of a layer in pixels: the same in all frames of a movie.
    evenness : float
        Over how many neighbouring windows of a layer the springs even out widths.

    Raises
    ------
    WindowError
        A count is not a positive whole number, the depth is not above 0, or the evenness is negative.

    See Also
    --------
    spring_windows : The same in one step.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.SpringGrid(layers=2, sectors=8, depth_px=5.0).on(cd.simulate.disk(20))
    >>> windows.layers, windows.sectors
    (2, 8)
    """

    evenness: float = EVENNESS

    def __post_init__(self) -> None:
        SpringGridParameters(
            layers=self.layers, sectors=self.sectors, depth_px=self.depth_px, evenness=self.evenness
        )

    def on(self, disk: DiskMap) -> SpringWindows:
        """Lay the grid along the edge of a cell.

        Parameters
        ----------
        disk : DiskMap
            Its outline and boundary angles are used, its inside is not.

        Returns
        -------
        SpringWindows
        """
        return SpringWindows(self, CellEdge.of(disk))


@dataclass(frozen=True, eq=False)
class SpringWindows(EdgeWindows):
    """Edge-based windows evened out by springs; where two sides of a window meet, the window ends.

    Attributes
    ----------
    grid : SpringGrid
    edge : CellEdge

    See Also
    --------
    EdgeWindows : Without springs.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.spring_windows(cd.simulate.disk(20), layers=4, sectors=8)
    >>> windows.n_empty
    0
    """

    grid: SpringGrid

    @cached_property
    def borders(self) -> list[list[CrossedBorder]]:
        """Borders between layers by depth, the edge first, with the sides that cross them."""
        edge, sectors = self.edge, self.sectors
        border = Border(edge.outline_yx)
        turn = np.append(edge.angles, edge.angles[0] + 2.0 * np.pi)
        wanted = 2.0 * np.pi * np.arange(sectors) / sectors
        first = int(np.argmin(np.mod(wanted - turn[0], 2.0 * np.pi)))
        lifted = turn[0] + np.mod(wanted - turn[0], 2.0 * np.pi)
        places = np.roll(np.interp(lifted, turn, border.arc), -first)
        sides = Sides(np.roll(np.arange(sectors), -first), places, np.zeros(sectors, dtype=bool))
        return cross_borders(
            CrossedBorder(border, sides), float(self.depth_px), self.layers, self.grid.evenness
        )

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels lies in, shape (P, 16); -1 for none.

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        depth, _ = self.edge.subpixels_of(pixels_yx)
        layer = self.grid.layer_of(depth)
        places = subpixel_places(pixels_yx, PER_SIDE)
        windows = np.full(layer.shape, -1)
        for number in range(self.layers):
            level = min(number, len(self.borders) - 1)
            rows = np.flatnonzero((layer == number).any(axis=1))
            if len(rows):
                share = np.clip(depth[rows] / self.depth_px - level, 0.0, 1.0)
                found = number * self.sectors + _sectors(
                    self.borders[level], places[rows], share, float(self.depth_px)
                )
                windows[rows] = np.where(layer[rows] == number, found, windows[rows])
        return windows


@takes(SpringWindowParameters)
def spring_windows(cell: Any, *in_order: Any, **settings: Any) -> SpringWindows:
    """Edge-based windows evened out by springs, as u-Register's are in the paper's words.

    The edge is divided equally. From there sides of windows follow the gradient of the distance from the edge
    inwards. Where they cross the border of the next layer they are beads on springs: those along the border
    even out the widths of windows, and those along the sides hold them to where the gradient leads. A window
    whose two sides meet has ended: deeper layers do not have it.

    Parameters
    ----------
    cell : array_like of shape (H, W), or DiskMap
        A mask, which `clean_mask` cleans, or a map, as for `edge_windows`.
    **settings
        See `SpringWindowParameters`; `holes` is for masks, a map has its own.

    Returns
    -------
    SpringWindows
        Its empty windows are counted in `n_empty`. With a `depth_px`, what lies deeper than all layers
        belongs to no window, and `coverage` says how much that is.

    Raises
    ------
    MaskError
        The mask is not that of one cell.
    WindowError
        A count is not a positive whole number, the depth is not above 0, or the evenness is negative.

    See Also
    --------
    edge_windows : Without springs.
    polar_windows : Windows of equal area by the map onto the disk.

    Notes
    -----
    Written from the paper's words alone. What they leave open is chosen here: layers have equal depth, so
    equal widths make areas and aspect ratios of a layer equal; the strength of the springs is that which
    keeps most windows and makes them most alike on simulated cells (``benchmarks/comparators.py``).

    References
    ----------
    u-Unwrap, sections 1, 2 and 4.1, Fig. 1D and 3. Machacek and Danuser 2006,
    doi:10.1529/biophysj.105.070383.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.spring_windows(cd.simulate.migrating(seed=1, size=0.4), layers=4, sectors=24)
    >>> windows.completeness.round(2)  # by layer: fewer windows reach the middle
    array([1.  , 0.79, 0.79, 0.67])
    """
    grid = SpringWindowParameters.of(*in_order, **settings)
    edge = CellEdge.of(cell, grid.holes)
    depth = edge.greatest_depth / grid.layers if grid.depth_px is None else grid.depth_px
    return SpringWindows(SpringGrid(grid.layers, grid.sectors, depth, grid.evenness), edge)


def _sectors(
    borders: list[CrossedBorder], places: FloatArray, share: FloatArray, depth_px: float
) -> IntArray:
    """Sectors of places below borders, those at the top of a layer.

    Parameters
    ----------
    borders : list of CrossedBorder
    places : ndarray of shape (P, n, 2) and dtype float
    share : ndarray of shape (P, n) and dtype float
        How far the places are on the way through the layer.
    depth_px : float
        Thickness of the layer.

    Returns
    -------
    ndarray of shape (P, n) and dtype int
    """
    away = [crossed.border.nearest(places) for crossed in borders]
    nearest = np.argmin([distance[:, 0] for distance, _ in away], axis=0)
    found = np.zeros(share.shape, dtype=np.int64)
    for number, (crossed, (_, arc)) in enumerate(zip(borders, away, strict=True)):
        rows = nearest == number
        if rows.any():
            found[rows] = crossed.windows_below(places[rows], arc[rows], share[rows], depth_px)
    return found
