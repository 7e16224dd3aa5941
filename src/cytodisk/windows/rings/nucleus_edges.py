"""`NucleusEdges`: the two outlines that rings lie between, and the distance from the nucleus."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt
from skimage.graph import MCP_Geometric

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.mask import FilledMask
from cytodisk.geometry.mask_parameters import Holes
from cytodisk.geometry.nucleus_mask import fit_nucleus
from cytodisk.windows.edge_windows import CellEdge
from cytodisk.windows.pixel_shares.shares import PER_SIDE
from cytodisk.windows.pixel_shares.subpixels import distances_and_angles, subpixel_places


@dataclass(frozen=True, eq=False, repr=False)
class NucleusEdges:
    """Outlines of a cell and of its nucleus.

    Attributes
    ----------
    cell, nucleus : CellEdge
        In one image.
    """

    cell: CellEdge
    nucleus: CellEdge

    @classmethod
    def of(cls, cell: Any, nucleus: Any, holes: Holes = "fill") -> NucleusEdges:
        """Edges of a cell, or of that of a map, and of a nucleus, which is fitted into the cell.

        Of a mask it is said what becomes of holes; a map knows that. The nucleus is part of the cell.
        """
        edge = CellEdge.of(cell, "fill" if holes == "error" else holes)
        fitted, _ = fit_nucleus(edge.mask, nucleus)
        if holes == "error" and not isinstance(cell, DiskMap):
            FilledMask.of(cell).under(holes, fitted)
        return cls(_with_part(edge, fitted), CellEdge.of(fitted))

    @cached_property
    def centre_yx(self) -> FloatArray:
        """Centroid of the nucleus, (row, column) in pixels."""
        return np.asarray(np.argwhere(self.nucleus.mask).mean(axis=0), dtype=np.float64)

    def turns(self, places_yx: FloatArray) -> FloatArray:
        """Angle of places around the nucleus' centroid as shares of a turn from +x towards +y, 0 to 1.

        Parameters
        ----------
        places_yx : ndarray of shape (..., 2) and dtype float
            (row, column) in pixels.
        """
        away = places_yx - self.centre_yx
        return np.asarray(np.mod(np.arctan2(away[..., 0], away[..., 1]) / (2.0 * np.pi), 1.0))

    def ways_from_nucleus(self, pixels_yx: IntArray) -> FloatArray:
        """Length of the way through the cell from the nuclear outline to each subpixel, shape (P, 16).

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            Pixels of the cytoplasm, (row, column).

        Notes
        -----
        Where the straight line to the nucleus lies in the cell, the way is up to 8 % longer than that: it
        goes by steps to the eight neighbours of a pixel, as CellProfiler's does.
        """
        places = subpixel_places(pixels_yx, PER_SIDE)
        straight, _ = distances_and_angles(places, self.nucleus.outline_yx, self.nucleus.angles)
        return np.asarray(straight + self._detours[tuple(pixels_yx.T)][:, None])

    @cached_property
    def _detours(self) -> FloatArray:
        """How much longer than the straight line the way from the nucleus to each pixel is, shape (H, W)."""
        walker = MCP_Geometric(np.where(self.cell.mask, 1.0, np.inf))
        ways, _ = walker.find_costs(np.argwhere(self.nucleus.mask))
        straight = distance_transform_edt(~self.nucleus.mask)
        return np.asarray(np.where(self.cell.mask, np.maximum(ways - straight, 0.0), 0.0))


def _with_part(edge: CellEdge, part: BoolArray) -> CellEdge:
    """The edge of a cell in which no pixel of a part is a hole."""
    if edge.holes is None:
        return edge
    left = replace(edge.holes, box=edge.holes.box & ~edge.holes.cut_out_of(part))
    return replace(edge, holes=left if left.box.any() else None)
