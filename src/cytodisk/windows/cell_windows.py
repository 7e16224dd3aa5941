"""`CellWindows`: a polar grid of windows on one cell."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.windows.edge_parts import part_places
from cytodisk.windows.grid import PolarWindows
from cytodisk.windows.on_cell import PARTS, WindowsOnCell
from cytodisk.windows.outlines import window_polygons
from cytodisk.windows.weights import window_weights


@dataclass(frozen=True, eq=False)
class CellWindows(WindowsOnCell):
    """Polar windows in the cell: none is empty, and their areas sum to the mask's.

    Attributes
    ----------
    grid : PolarWindows
    disk : DiskMap
    """

    grid: PolarWindows
    disk: DiskMap

    @cached_property
    def weights(self) -> sparse.csr_array:
        """Share of each mask pixel (row-major order) in each window, (windows, pixels); columns sum to 1."""
        return window_weights(self.grid, self.disk)

    @property
    def part_windows(self) -> IntArray:
        """Number of the window that each part of each mask pixel maps into, shape (pixels, 16)."""
        places = part_places(np.argwhere(self.mask), PARTS)
        found = self.grid.window_of(self.disk.to_disk(places.reshape(-1, 2), outside="nearest"))
        return found.reshape(places.shape[:2])

    @property
    def mask(self) -> BoolArray:
        """The cell's mask, shape (H, W) and dtype bool."""
        return self.disk.mask

    @property
    def layers(self) -> int:
        """Number of layers."""
        return self.grid.layers

    @property
    def sectors(self) -> int:
        """Number of sectors."""
        return self.grid.sectors

    def polygons(self) -> list[FloatArray]:
        """Outline of each window in the cell, by window number.

        Returns
        -------
        list of ndarray of shape (N, 2) and dtype float
            Closed polygons, (row, column) in pixels, last point not repeated; neighbours share their points.
        """
        return window_polygons(self.grid, self.disk)

    def geojson(self, values: dict[str, FloatArray] | None = None) -> dict[str, Any]:
        """Window outlines as a GeoJSON feature collection, for QuPath, Fiji or napari.

        Parameters
        ----------
        values : dict of str to ndarray of shape (layers, sectors), optional
            Numbers to put into each window's properties.

        Returns
        -------
        dict
            Coordinates are (x, y) in pixels with pixel centres at integers: add 0.5 for programs that count
            from the pixel's corner. With a single sector a window is a ring, which is cut open along a line;
            windows thinner than their outline's points lie apart may touch themselves.

        Raises
        ------
        WindowError
            An array of values has another shape.
        """
        columns = {name: np.asarray(array) for name, array in (values or {}).items()}
        for name, array in columns.items():
            if array.shape != self.areas.shape:
                raise WindowError(f"values[{name!r}] has shape {array.shape}, the windows {self.areas.shape}")
        features = []
        for number, polygon in enumerate(self.polygons()):
            layer, sector = divmod(number, self.grid.sectors)
            ring = np.concatenate([polygon, polygon[:1]])[:, ::-1].tolist()
            numbers = {name: _number(array[layer, sector]) for name, array in columns.items()}
            properties = {"layer": layer, "sector": sector, "area_px": float(self.areas[layer, sector])}
            features.append(
                {
                    "type": "Feature",
                    "geometry": {"type": "Polygon", "coordinates": [ring]},
                    "properties": properties | numbers,
                }
            )
        return {"type": "FeatureCollection", "features": features}


def _number(value: Any) -> float | None:
    """A float that JSON can hold: NaN becomes null."""
    return float(value) if np.isfinite(value) else None
