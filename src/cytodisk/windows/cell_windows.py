"""`CellWindows`: a grid of windows on one cell."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from scipy import sparse

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.windows.grid import PolarWindows
from cytodisk.windows.outlines import window_polygons
from cytodisk.windows.weights import window_weights


@dataclass(frozen=True, eq=False)
class CellWindows:
    """Windows in the cell.

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
    def mask(self) -> Any:
        """The cell's mask, shape (H, W) and dtype bool."""
        return self.disk.mask

    @cached_property
    def areas(self) -> FloatArray:
        """Area of each window in square pixels, shape (layers, sectors); they sum to the mask's."""
        return self._by_window(np.asarray(self.weights.sum(axis=1), dtype=np.float64).ravel())

    @cached_property
    def labels(self) -> IntArray:
        """Number of the window with the largest share of each pixel, shape (H, W); -1 outside."""
        by_pixel = sparse.csc_array(self.weights)
        pixel = np.repeat(np.arange(by_pixel.shape[1]), np.diff(by_pixel.indptr))
        order = np.lexsort((by_pixel.data, pixel))
        last = np.cumsum(np.diff(by_pixel.indptr)) - 1
        labels = np.full(self.mask.shape, -1, dtype=np.int64)
        labels[self.mask] = by_pixel.indices[order][last]
        return labels

    @property
    def completeness(self) -> FloatArray:
        """Share of windows that hold signal, by layer, shape (layers,)."""
        return np.asarray((self.areas > 0).mean(axis=1))

    @cached_property
    def centroids_yx(self) -> FloatArray:
        """Centre of mass of each window, shape (layers, sectors, 2), (row, column) in pixels."""
        moments = self.weights @ np.argwhere(self.mask).astype(np.float64)
        return np.asarray(moments.reshape(*self.areas.shape, 2) / self.areas[..., None])

    @cached_property
    def eccentricities(self) -> FloatArray:
        """Eccentricity of the ellipse with each window's second moments, shape (layers, sectors), 0 to 1.

        A pixel counts as a square of side 1, so no window has zero width.
        """
        points = np.argwhere(self.mask).astype(np.float64)
        products = np.column_stack([points[:, 0] ** 2, points[:, 1] ** 2, points[:, 0] * points[:, 1]])
        mean = (self.weights @ products).reshape(*self.areas.shape, 3) / self.areas[..., None]
        y, x = self.centroids_yx[..., 0], self.centroids_yx[..., 1]
        yy, xx, xy = mean[..., 0] - y * y + 1 / 12, mean[..., 1] - x * x + 1 / 12, mean[..., 2] - x * y
        middle, root = 0.5 * (yy + xx), np.hypot(0.5 * (yy - xx), xy)
        return np.asarray(np.sqrt(np.clip(2.0 * root / (middle + root), 0.0, 1.0)))

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

    def _by_window(self, values: FloatArray) -> FloatArray:
        return values.reshape(self.grid.layers, self.grid.sectors)


def _number(value: Any) -> float | None:
    """A float that JSON can hold: NaN becomes null."""
    return float(value) if np.isfinite(value) else None
