"""Edge-based windows, the field's: layers by distance from the edge, sectors of the edge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy.ndimage import distance_transform_edt

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.disk_map import DiskMap
from cytodisk.geometry.mask import FilledMask
from cytodisk.geometry.mask_parameters import Holes
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.scale import UNKNOWN, Scale
from cytodisk.taking import takes
from cytodisk.windows.grid_parameters import EdgeGridParameters, EdgeWindowParameters
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.pixel_shares.shares import PER_SIDE, strips
from cytodisk.windows.pixel_shares.subpixels import depths_and_angles, subpixel_places

_ROUGH = 2.0  # pixels by which depths from the distance transform are off, at most


@dataclass(frozen=True)
class EdgeGrid:
    """Layers of equal depth from the edge (0) inwards, sectors of the edge.

    Sectors are of equal length along the edge of a mask or a single map; in later frames of a movie they are
    those that the edge was tracked to, and may differ in length.

    Attributes
    ----------
    layers, sectors : int
    depth_px : float
        Thickness of a layer in pixels: the same in all frames of a movie.

    Raises
    ------
    WindowError
        A count is not a positive whole number, or the depth is not above 0.

    See Also
    --------
    edge_windows : The same in one step.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.EdgeGrid(layers=2, sectors=8, depth_px=5.0).on(cd.simulate.disk(20))
    >>> windows.layers, windows.sectors
    (2, 8)
    """

    layers: int
    sectors: int
    depth_px: float

    def __post_init__(self) -> None:
        EdgeGridParameters(layers=self.layers, sectors=self.sectors, depth_px=self.depth_px)

    def on(self, disk: DiskMap) -> EdgeWindows:
        """Lay the grid along the edge of a cell.

        Parameters
        ----------
        disk : DiskMap
            Its outline and boundary angles are used, its inside is not.

        Returns
        -------
        EdgeWindows
        """
        return EdgeWindows(self, CellEdge.of(disk))

    def window_of(self, depth: FloatArray, angle: FloatArray) -> IntArray:
        """Number of the window at a depth below a place of the edge.

        Parameters
        ----------
        depth : ndarray of shape (...) and dtype float
            In pixels.
        angle : ndarray of shape (...) and dtype float
            In radians.

        Returns
        -------
        ndarray of shape (...) and dtype int
            -1 for what lies deeper than the last layer.
        """
        layer = self.layer_of(depth)
        turn = np.mod(angle / (2.0 * np.pi), 1.0)
        sector = np.minimum(np.floor(turn * self.sectors).astype(np.int64), self.sectors - 1)
        return np.where(layer < self.layers, layer * self.sectors + sector, -1)

    def layer_of(self, depth: FloatArray) -> IntArray:
        """Layer at a depth, of the shape of `depth`, in pixels; the number of layers or more if too deep."""
        beyond = float(self.depth_px) * (self.layers + 1)  # a tiny depth_px would count past any integer
        return np.maximum(np.ceil(np.minimum(depth, beyond) / self.depth_px - 1e-9).astype(np.int64) - 1, 0)


@dataclass(frozen=True, eq=False, repr=False)
class CellEdge:
    """Outline of a cell with the angle of each of its points.

    Attributes
    ----------
    mask : ndarray of shape (H, W) and dtype bool
        Its holes are filled.
    outline_yx : ndarray of shape (B, 2) and dtype float
        (row, column) in pixels.
    angles : ndarray of shape (B,) and dtype float
        In radians, strictly increasing, all within one turn.
    scale : Scale
    holes : PlacedMask or None
        Holes in the mask that belong to no window.
    """

    mask: BoolArray
    outline_yx: FloatArray
    angles: FloatArray
    scale: Scale = UNKNOWN
    holes: PlacedMask | None = None

    @classmethod
    def of(cls, cell: Any, holes: Holes = "fill") -> CellEdge:
        """Edge of a mask, whose angles are those of the upright disk, or of a DiskMap, with its own.

        Of a mask it is said what becomes of holes; a map knows that.
        """
        if isinstance(cell, DiskMap):
            return cls(cell.mask, cell.outline_yx, cell.boundary_angles, cell.scale, cell.holes)
        found = FilledMask.of(cell).under(holes)
        outline = trace_outline(found.filled)
        left_out = None if found.holes is None else PlacedMask.of(found.filled).beside(found.holes)
        return cls(found.filled, outline, boundary_angles(outline), Scale.of(cell), left_out)

    def subpixels_of(self, pixels_yx: IntArray) -> tuple[FloatArray, FloatArray]:
        """Depth and angle of each subpixel of some of the mask's pixels, each (P, 16): `depths_and_angles`.

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        return depths_and_angles(subpixel_places(pixels_yx, PER_SIDE), self.outline_yx, self.angles)

    @cached_property
    def rough_depths(self) -> FloatArray:
        """Distance from each pixel's centre to that of the next pixel outside of the cell, shape (H, W).

        In pixels, 0 outside; the depth of each subpixel of the pixel differs from it by at most 2 px.
        """
        return np.asarray(distance_transform_edt(np.pad(self.mask, 1))[1:-1, 1:-1], dtype=np.float64)

    @cached_property
    def deepest(self) -> tuple[IntArray, float]:
        """Pixel of the subpixel that is deepest inside, (row, column), and the depth of that subpixel.

        The depth is in pixels; of several such pixels the first in row-major order.
        """
        rough = self.rough_depths
        pixels = np.argwhere(self.mask & (rough >= rough.max() - 2.0 * _ROUGH))
        depths = np.concatenate([self.subpixels_of(block)[0].max(axis=1) for _, block in strips(pixels)])
        found = int(depths.argmax())
        return pixels[found], float(depths[found])

    @property
    def greatest_depth(self) -> float:
        """Depth of the subpixel that is deepest inside, in pixels."""
        return self.deepest[1]


@dataclass(frozen=True, eq=False)
class EdgeWindows(WindowsOnCell):
    """Edge-based windows in a cell; where the cell is thin, windows of inner layers are empty.

    Attributes
    ----------
    grid : EdgeGrid
    edge : CellEdge

    See Also
    --------
    CellWindows : Windows of a map, none of them empty.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.edge_windows(cd.simulate.disk(20), layers=4, sectors=8, depth_px=8)
    >>> windows.n_empty  # the cell is not deep enough for the innermost layer
    8
    """

    grid: EdgeGrid
    edge: CellEdge

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels lies in, shape (P, 16); -1 for none.

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        windows = np.full((len(pixels_yx), PER_SIDE**2), -1)
        near = self.edge.rough_depths[tuple(pixels_yx.T)] - _ROUGH <= self.layers * float(self.depth_px)
        windows[near] = self.grid.window_of(*self.edge.subpixels_of(pixels_yx[near]))
        return windows

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

    @property
    def depth_px(self) -> float:
        """Thickness of a layer in pixels."""
        return self.grid.depth_px


@takes(EdgeWindowParameters)
def edge_windows(cell: Any, *in_order: Any, **settings: Any) -> EdgeWindows:
    """Edge-based windows of one cell: the field's, to compare with `polar_windows`.

    The edge is divided into sectors, of equal length but for a later frame of a movie, and every place in the
    cell belongs to the sector of the edge point it is nearest to, and to a layer by its distance from there.
    Every pixel is divided into 4×4 subpixels, each of which goes whole to its window.

    Parameters
    ----------
    cell : array_like of shape (H, W), or DiskMap
        A mask, which `clean_mask` cleans; its sectors start where those of the upright disk do. Or a map: its
        sectors are those of its polar windows, in a movie those of the tracked edge.
    **settings
        See `EdgeWindowParameters`; `holes` is for masks, a map has its own.

    Returns
    -------
    EdgeWindows
        Its empty windows are counted in `n_empty`. With a `depth_px`, what lies deeper than all layers
        belongs to no window, and `coverage` says how much that is.

    Raises
    ------
    MaskError
        The mask is not that of one cell.
    WindowError
        A count is not a positive whole number, or the depth is not above 0.

    See Also
    --------
    polar_windows : Windows of equal area by the map onto the disk.
    spring_windows : Sides are springs, which make windows more regular, as u-Register's are.
    ring_windows : Rings and wedges, as CellProfiler's.

    Notes
    -----
    Sides of windows are where the nearest edge point changes.

    References
    ----------
    Machacek et al., "Coordination of Rho GTPase activities during cell protrusion", Nature 461 (2009),
    doi:10.1038/nature08242. u-Unwrap, sections 2 and 4.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.edge_windows(cd.simulate.disk(20), layers=4, sectors=8, depth_px=5)
    >>> windows.n_empty
    0
    >>> windows.areas.round()[:, 0]  # by layer: rings of the same depth shrink inwards
    array([71., 48., 29.,  9.])
    """
    grid = EdgeWindowParameters.of(*in_order, **settings)
    edge = CellEdge.of(cell, grid.holes)
    depth = edge.greatest_depth / grid.layers if grid.depth_px is None else grid.depth_px
    return EdgeWindows(EdgeGrid(grid.layers, grid.sectors, depth), edge)
