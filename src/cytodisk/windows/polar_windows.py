"""Polar windows: a grid on the unit disk, and its windows on a cell."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.geometry.edge_distance import EdgeDistance
from cytodisk.taking import takes
from cytodisk.windows.area_ratios import area_ratios
from cytodisk.windows.depth_borders import radii_at_depths
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.nucleus.nucleus_distance import nucleus_distances
from cytodisk.windows.nucleus.nucleus_grid import with_nucleus_of
from cytodisk.windows.on_map import WindowsOnMap
from cytodisk.windows.outlines import window_polygon, window_polygons
from cytodisk.windows.pixel_shares.shares import PER_SIDE, WindowShares
from cytodisk.windows.polar_layout import PolarLayout
from cytodisk.windows.weights import window_shares, windows_of_subpixels
from cytodisk.windows.window_features import window_features


@dataclass(frozen=True)
class PolarGrid(PolarLayout):
    """Layers from the edge (0) inwards, sectors from angle 0 (+u) towards +v.

    Window (layer, sector) has number layer · sectors + sector. Layers of a nucleus follow the others.

    Attributes
    ----------
    layers, sectors : int
        All layers, those of the nucleus too.
    spacing : {"area", "radius"}
        Within the cytoplasm, and within the nucleus.
    depth_um : tuple of float or None
        Depths in µm of the borders between layers before the nucleus or the centre.
    borders : tuple of float or None
        Radii of these borders in one cell, decreasing; for layers that are deeper than the cell or its
        cytoplasm the radius of the nucleus, or 0.
    nucleus_layers : int
        How many of the layers are in the nucleus, the last ones.
    nucleus_radius : float or None
        Of the nucleus in the disk.

    Examples
    --------
    >>> import numpy as np
    >>> import cytodisk as cd
    >>> grid = cd.polar_windows(layers=2, sectors=4)
    >>> grid.n_windows, grid.radii.round(2)
    (8, array([1.  , 0.71, 0.  ]))
    >>> grid.window_of(np.array([[0.9, 0.1]]))  # at the edge, just past angle 0
    array([0])
    """

    def on(self, disk: DiskMap) -> CellWindows:
        """Carry the grid onto a cell.

        Parameters
        ----------
        disk : DiskMap

        Returns
        -------
        CellWindows
            No window is empty, whatever the grid, but for layers by depth that are deeper than the cell or
            its cytoplasm. Its grid has the radii of this cell.

        Raises
        ------
        WindowError
            `disk` is no map; only one of it and the grid has a nucleus; or layers are by depth, and its scale
            is unknown or the image shows no edge.
        """
        if not isinstance(disk, DiskMap):
            raise WindowError(f"disk must be a DiskMap, got {type(disk).__name__}: pass map_to_disk(mask)")
        grid = with_nucleus_of(self, disk)
        if self.depth_um is None:
            return CellWindows(grid, disk)
        pixel_size_um = disk.scale.pixel_size_um
        if pixel_size_um is None:
            raise WindowError(
                "depth_um needs the scale of the map: pass pixel_size_um to map_to_disk or map_movie"
            )
        distance = EdgeDistance(disk.placed_mask, disk.outline_yx)
        depths_px = [depth / pixel_size_um for depth in self.depth_um]
        radii = radii_at_depths(disk, distance, depths_px, grid.nucleus_radius or 0.0)
        windows = CellWindows(replace(grid, borders=tuple(radii.tolist())), disk)
        windows.__dict__["edge_distance"] = distance  # which took some time
        return windows


@dataclass(frozen=True, eq=False)
class CellWindows(WindowsOnMap):
    """Polar windows in the cell: none is empty, and their areas sum to the mask's.

    Layers by depth that are deeper than the cell are none of it: their windows have the area 0. So have
    windows that lie wholly in excluded holes.

    Attributes
    ----------
    grid : PolarGrid
    disk : DiskMap

    See Also
    --------
    EdgeWindows : Windows by distance from the edge.
    RingWindows : Rings and wedges.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(cd.map_to_disk(cd.simulate.disk(12)))
    >>> windows.areas.shape, windows.n_empty, windows.area_error < 0.05
    ((3, 8), 0, True)
    >>> len(windows.geojson()["features"])
    24
    """

    grid: PolarGrid
    disk: DiskMap

    @cached_property
    def shares(self) -> WindowShares:
        """Shares of pixels in windows, and the windows' moments; columns of the weights sum to 1."""
        return window_shares(self.grid, self.disk)

    def windows_of_subpixels(self, pixels_yx: IntArray) -> IntArray:
        """Number of the window that each subpixel of some pixels maps into, shape (P, 16).

        Parameters
        ----------
        pixels_yx : ndarray of shape (P, 2) and dtype int
            (row, column).
        """
        return windows_of_subpixels(self.grid, self.disk, pixels_yx, PER_SIDE)

    @property
    def n_empty(self) -> int:
        """Number of windows that hold nothing of the cell; layers deeper than the cell do not count."""
        return int((self.areas == 0)[self.grid.present].sum())

    @property
    def completeness(self) -> FloatArray:
        """Share of windows that hold signal, by layer, shape (layers,); NaN if deeper than the cell."""
        return np.where(self.grid.present, super().completeness, np.nan)

    @property
    def area_error(self) -> float:
        """Mean |ln| of each window's share of the cell over its share of the disk; 0 is perfect.

        At 0.1 the areas of windows are about 10 % off. Layers deeper than the cell do not count. With a
        nucleus, shares are those of the window's compartment. Excluded holes count as cell: the map's do.
        """
        return float(np.nanmean(np.abs(np.log(self.area_ratios))))

    @property
    def area_errors(self) -> dict[str, float]:
        """`area_error` by compartment."""
        found = np.abs(np.log(self.area_ratios))
        compartment = self.grid.compartments[self.grid.present]
        return {str(name): float(np.nanmean(found[compartment == name])) for name in np.unique(compartment)}

    @property
    def area_ratios(self) -> FloatArray:
        """Each window's share of its compartment over its share of that in the disk, without layers too deep.

        Excluded holes count as cell; NaN for windows that are so small that no subpixel of a hole is theirs.
        """
        ratios = area_ratios(self.grid, self.filled_areas)
        return ratios if self.holes is None else np.where(ratios > 0.0, ratios, np.nan)

    @cached_property
    def nucleus_distances(self) -> FloatArray | None:
        """As `depths`, from the nuclear outline on either side of it; None without a nucleus."""
        if self.disk.nucleus is None:
            return None
        found = nucleus_distances(self.disk, self.shares.subpixels, self.grid.n_windows)
        return found.reshape(*self.areas.shape, -1)

    def polygons(self) -> list[FloatArray]:
        """Outline of each window in the cell, by window number.

        Returns
        -------
        list of ndarray of shape (N, 2) and dtype float
            Closed polygons, (row, column) in pixels, last point not repeated; neighbours share their points.
            Without points for layers deeper than the cell.
        """
        return window_polygons(self.grid, self.disk)

    def polygon(self, layer: int, sector: int) -> FloatArray:
        """One of `polygons`, without the time that the others take."""
        return window_polygon(self.grid, self.disk, layer * self.sectors + sector)

    def geojson(
        self,
        values: Mapping[str, FloatArray] | None = None,
        *,
        cell: str = "",
        corner: tuple[int, int] = (0, 0),
    ) -> dict[str, Any]:
        """Windows as a GeoJSON feature collection, for QuPath, Fiji or napari.

        Parameters
        ----------
        values : dict of str to ndarray of shape (layers, sectors), optional
            Measurements of the windows, by name.
        cell : str
            Name of the cell, which then is the first feature, an annotation; without it windows alone.
        corner : (int, int)
            (row, column) of the mask's first pixel in the image that coordinates count in.

        Returns
        -------
        dict
            Each window is a detection with a name, its layer, its sector, and measurements; NaN is left
            out. Coordinates are (x, y) in pixels from the image's corner, as in QuPath and Fiji: pixel
            (0, 0) covers 0 to 1. All polygons are valid: one that touches itself is given in pieces.

        Raises
        ------
        WindowError
            An array of values has another shape.
        """
        features = list(window_features(self, self.polygons(), values or {}, cell, corner))
        return {"type": "FeatureCollection", "features": features}


@takes(PolarGridParameters)
def polar_windows(*in_order: Any, **settings: Any) -> PolarGrid:
    """Grid of windows on the unit disk.

    Parameters
    ----------
    **settings
        See `PolarGridParameters`.

    Returns
    -------
    PolarGrid

    Raises
    ------
    WindowError
        A count is not a positive whole number, the spacing is unknown, or depths do not increase.

    See Also
    --------
    edge_windows : Windows by distance from the edge, as the field's.
    ring_windows : Rings and wedges, as CellProfiler's.
    sample : The signal in each window.

    References
    ----------
    u-Unwrap, section 3, "Windowing the cell using the disk parameterization".

    Examples
    --------
    >>> import cytodisk as cd
    >>> grid = cd.polar_windows(layers=3, sectors=8)
    >>> windows = grid.on(cd.map_to_disk(cd.simulate.dumbbell(radius=12)))
    >>> windows.n_empty, round(windows.coverage, 6)
    (0, 1.0)

    Layers by depth, the same in cells of all sizes:

    >>> grid = cd.polar_windows(sectors=8, depth_um=(0.5, 1.0))
    >>> windows = grid.on(cd.map_to_disk(cd.simulate.disk(30), pixel_size_um=0.1))
    >>> windows.depths[:, :, 2].mean(axis=1).round()  # in pixels: the last one is the rest
    array([ 5., 10., 25.])

    Layers of the cytoplasm, then of the nucleus:

    >>> cd.polar_windows(layers=2, sectors=60, nucleus_layers=1).compartments.tolist()
    ['cytoplasm', 'cytoplasm', 'nucleus']
    """
    return polar_grid(PolarGridParameters.of(*in_order, **settings))


def polar_grid(parameters: PolarGridParameters) -> PolarGrid:
    """The grid that some parameters describe."""
    given, nucleus = parameters, parameters.nucleus_layers or 0
    layers = given.cell_layers + nucleus
    return PolarGrid(layers, given.sectors, given.spacing, given.depth_um, nucleus_layers=nucleus)
