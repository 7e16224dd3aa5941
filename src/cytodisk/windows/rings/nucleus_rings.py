"""Rings by the share of the way from a cell's edge to its nucleus, as CellProfiler's users have them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import IntArray
from cytodisk.taking import takes
from cytodisk.windows.pixel_shares.shares import PER_SIDE
from cytodisk.windows.pixel_shares.subpixels import subpixel_places
from cytodisk.windows.ring_windows import RingGrid, RingWindows
from cytodisk.windows.rings.around_nucleus import WindowsAroundNucleus
from cytodisk.windows.rings.nucleus_edges import NucleusEdges
from cytodisk.windows.rings.nucleus_ring_grid import NucleusRingGrid
from cytodisk.windows.rings.nucleus_ring_parameters import NucleusRingWindowParameters


@dataclass(frozen=True, eq=False)
class NucleusRingWindows(WindowsAroundNucleus):
    """Rings and wedges around the nucleus of a cell; they cover it, but areas differ and windows are empty.

    Attributes
    ----------
    grid : NucleusRingGrid
    edges : NucleusEdges

    See Also
    --------
    CellWindows : Windows of a map, of equal area in the cytoplasm and in the nucleus.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> cell, nucleus = cd.simulate.disk(20), np.pad(cd.simulate.disk(8), 12)
    >>> windows = cd.nucleus_ring_windows(cell, nucleus, layers=4, sectors=8, nucleus_layers=1)
    >>> windows.areas.shape
    (5, 8)
    """

    grid: NucleusRingGrid
    edges: NucleusEdges

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels lies in, shape (P, 16).

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        in_nucleus = self.nucleus_mask[tuple(pixels_yx.T)]
        layer = np.empty((len(pixels_yx), PER_SIDE**2), dtype=np.int64)
        layer[~in_nucleus] = self._cytoplasm_layers_of(pixels_yx[~in_nucleus])
        layer[in_nucleus] = self.grid.cytoplasm_layers + self._within_nucleus.windows_of_subpixels(
            pixels_yx[in_nucleus]
        )
        turn = self.edges.turns(subpixel_places(pixels_yx, PER_SIDE))
        sector = np.minimum((turn * self.sectors).astype(np.int64), self.sectors - 1)
        return np.asarray(layer * self.sectors + sector)

    def _cytoplasm_layers_of(self, pixels_yx: IntArray) -> IntArray:
        depth, _ = self.edges.cell.subpixels_of(pixels_yx)
        way = self.edges.ways_from_nucleus(pixels_yx)
        share = depth / np.maximum(depth + way, 1e-12)
        count = self.grid.cytoplasm_layers
        return np.minimum((share * count).astype(np.int64), count - 1)

    @cached_property
    def _within_nucleus(self) -> RingWindows:
        """Rings of the nucleus around its deepest point; without wedges, so windows are layers."""
        return RingWindows(RingGrid(self.grid.nucleus_layers, 1), self.edges.nucleus)


@takes(NucleusRingWindowParameters)
def nucleus_ring_windows(cell: Any, nucleus: Any, *in_order: Any, **settings: Any) -> NucleusRingWindows:
    """Rings and wedges around the nucleus of one cell, to compare with `polar_windows`.

    A place of the cytoplasm belongs to a ring by d_membrane / (d_membrane + d_nucleus): its distance from
    the edge of the cell over the sum of that and of its way through the cell from the nucleus. A place of
    the nucleus belongs to a ring by its distance from the nuclear outline over the sum of that and of its way
    from the deepest point of the nucleus. Wedges are by angle around the nucleus' centroid.

    Parameters
    ----------
    cell : array_like of shape (H, W), or DiskMap
        A mask, which `clean_mask` cleans, or a map, of which only the mask is used.
    nucleus : array_like of shape (H, W)
        Mask of the nucleus in the same image, which `fit_nucleus` fits into the cell.
    **settings
        `holes` is for masks, a map has its own. See `NucleusRingWindowParameters`.

    Returns
    -------
    NucleusRingWindows
        Layer 0 is at the edge of the cell; layers of the nucleus follow those of the cytoplasm. Sector 0
        begins at +x and goes towards +y.

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
    interpolated_ring_windows : Rings between the two outlines, point by point.
    ring_windows : Rings around the deepest point of the cell.

    References
    ----------
    Carpenter et al., "CellProfiler", Genome Biology 7:R100 (2006), doi:10.1186/gb-2006-7-10-r100:
    MeasureObjectIntensityDistribution with the edges of other objects (the nuclei) as centres, where layers
    are counted from the nucleus, in eight wedges.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> cell, nucleus = cd.simulate.disk(20), np.pad(cd.simulate.disk(8), 12)
    >>> windows = cd.nucleus_ring_windows(cell, nucleus, layers=4, sectors=8, nucleus_layers=1)
    >>> shares = windows.areas.sum(axis=1) / cell.sum()  # by layer, the nucleus last
    >>> shares.round(2)
    array([0.29, 0.23, 0.18, 0.14, 0.16])
    """
    counts = NucleusRingWindowParameters.of(*in_order, **settings)
    grid = NucleusRingGrid(counts.layers + counts.nucleus_layers, counts.sectors, counts.nucleus_layers)
    return NucleusRingWindows(grid, NucleusEdges.of(cell, nucleus, counts.holes))
