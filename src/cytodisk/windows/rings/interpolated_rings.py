"""Rings interpolated between the outlines of a cell and its nucleus, as shape spaces of cells have them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.taking import takes
from cytodisk.windows.pixel_shares.shares import PER_SIDE
from cytodisk.windows.rings.around_nucleus import WindowsAroundNucleus
from cytodisk.windows.rings.nucleus_edges import NucleusEdges
from cytodisk.windows.rings.nucleus_ring_grid import InterpolatedRingGrid
from cytodisk.windows.rings.nucleus_ring_parameters import InterpolatedRingWindowParameters
from cytodisk.windows.rings.paint_triangles import paint_triangles
from cytodisk.windows.rings.ring_points import (
    RingCounts,
    ring_points,
    ring_triangles,
    turned_over,
    window_of_triangles,
)


@dataclass(frozen=True, eq=False)
class InterpolatedRingWindows(WindowsAroundNucleus):
    """Quadrilaterals between interpolated rings; they may fold, overlap, leave the cell, or be empty.

    What several windows hold belongs to the outermost of those that are not turned over.

    Attributes
    ----------
    grid : InterpolatedRingGrid
    edges : NucleusEdges

    See Also
    --------
    CellWindows : Windows of a map, which is proven to be one to one.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> cell, nucleus = cd.simulate.disk(20), np.pad(cd.simulate.disk(8), 12)
    >>> windows = cd.interpolated_ring_windows(cell, nucleus, layers=4, sectors=8)
    >>> windows.n_turned_over, windows.n_empty
    (0, 0)
    """

    grid: InterpolatedRingGrid
    edges: NucleusEdges

    @cached_property
    def points_yx(self) -> FloatArray:
        """Points of the rings, from the edge of the cell to the nucleus' centroid.

        Shape (layers + 1, points, 2), (row, column) in pixels.
        """
        grid = self.grid
        counts = RingCounts(grid.cytoplasm_layers, grid.nucleus_layers, grid.n_points, grid.harmonics)
        return ring_points(self.edges, counts)

    @cached_property
    def turned_over(self) -> BoolArray:
        """Which of the two triangles at each place between rings turn over, shape (layers, points, 2)."""
        return turned_over(self.points_yx)

    @property
    def n_turned_over(self) -> int:
        """Number of triangles that are turned over."""
        return int(self.turned_over.sum())

    @property
    def outside(self) -> float:
        """Share of the points of rings between the two outlines that lie outside the cell, 0 to 1; or NaN."""
        between = self.points_yx[1 : self.grid.cytoplasm_layers].reshape(-1, 2)
        if not len(between):
            return float("nan")
        pixel = np.floor(between + 0.5).astype(np.int64)
        within = pixel[((pixel >= 0) & (pixel < self.mask.shape)).all(axis=1)]
        return float(1.0 - self.mask[tuple(within.T)].sum() / len(pixel))

    @property
    def overlap(self) -> float:
        """Share of the cell's area that lies in more than one window, 0 to 1."""
        _, overlap = self._painted
        return float(overlap.mean())

    @cached_property
    def _painted(self) -> tuple[IntArray, BoolArray]:
        """Window of each of the subpixels of the mask's box, and where several overlap in the cell."""
        triangles = ring_triangles(self.points_yx)
        windows = window_of_triangles(self.layers, self.grid.n_points, self.sectors)
        order = np.argsort(self.turned_over.ravel(), kind="stable")
        box = self.placed_mask.box
        corner = np.array(self.placed_mask.corner)
        places = (triangles.reshape(-1, 3, 2)[order] - corner + 0.5) * PER_SIDE - 0.5
        shape = box.shape[0] * PER_SIDE, box.shape[1] * PER_SIDE
        window, overlap = paint_triangles(places, windows.ravel()[order], shape)
        return window, overlap[box.repeat(PER_SIDE, axis=0).repeat(PER_SIDE, axis=1)]

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels lies in, shape (P, 16); -1 for none.

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        window, _ = self._painted
        row, column = (pixels_yx - np.array(self.placed_mask.corner)).T
        blocks = window.reshape(window.shape[0] // PER_SIDE, PER_SIDE, -1, PER_SIDE)
        return np.asarray(blocks[row, :, column, :].reshape(len(pixels_yx), PER_SIDE**2))


@takes(InterpolatedRingWindowParameters)
def interpolated_ring_windows(
    cell: Any, nucleus: Any, *in_order: Any, **settings: Any
) -> InterpolatedRingWindows:
    """Windows between rings interpolated from the outline of a cell to that of its nucleus.

    Both outlines get equally many points at equal distances, from the one at +x of the nucleus' centroid
    on. Points with one number are joined by a straight line, and each ring has its points at one share of
    these lines; within the nucleus the lines go on to its centroid. Nothing keeps the lines from crossing
    each other or the edge of the cell, so windows may fold, overlap, leave the cell, or be empty.

    Parameters
    ----------
    cell : array_like of shape (H, W), or DiskMap
        A mask, which `clean_mask` cleans, or a map, of which only the mask is used.
    nucleus : array_like of shape (H, W)
        Mask of the nucleus in the same image, which `fit_nucleus` fits into the cell.
    **settings
        `holes` is for masks, a map has its own. See `InterpolatedRingWindowParameters`.

    Returns
    -------
    InterpolatedRingWindows
        Layer 0 is at the edge of the cell; layers of the nucleus follow those of the cytoplasm. What is
        turned over is counted in `n_turned_over`; `outside` says which share of the rings lies outside the
        cell, `overlap` which share of the cell lies in several windows, and `coverage` which in any.

    Raises
    ------
    MaskError
        The mask is not that of one cell.
    NucleusError
        The other one is not that of its nucleus.
    WindowError
        A count is not a positive whole number.

    See Also
    --------
    polar_windows : Windows of equal area by the map onto the disk.
    nucleus_ring_windows : Rings by distance, as CellProfiler's.

    References
    ----------
    Viana et al., "Integrated intracellular organization and its variations in human iPS cells", Nature 613
    (2023), doi:10.1038/s41586-022-05563-7, whose package aics-cytoparam interpolates spherical harmonics
    between the two surfaces. 2D_shapespace (github.com/trangle1302/2D_shapespace) does so with Fourier
    coefficients of outlines, DypFISH (github.com/cbib/dypfish) along rays from the nucleus' centroid.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> cell, nucleus = cd.simulate.disk(20), np.pad(cd.simulate.disk(8), 12)
    >>> windows = cd.interpolated_ring_windows(cell, nucleus, layers=4, sectors=8)
    >>> windows.n_turned_over, windows.outside
    (0, 0.0)
    """
    chosen = InterpolatedRingWindowParameters.of(*in_order, **settings)
    layers = chosen.layers + chosen.nucleus_layers
    grid = InterpolatedRingGrid(
        layers, chosen.sectors, chosen.nucleus_layers, chosen.points, chosen.harmonics
    )
    return InterpolatedRingWindows(grid, NucleusEdges.of(cell, nucleus, chosen.holes))
