"""Where windows lie in an image, by their pixels."""

from __future__ import annotations

import numpy as np
import shapely

import cytodisk as cd
from cytodisk.arrays import AnyArray, BoolArray, FloatArray
from cytodisk.windows.polar_windows import CellWindows

GRID = {"layers": 2, "sectors": 6}
SIZE_UM = 0.25


def two_cells() -> AnyArray:
    """Labels 2 and 5; the first touches the image's border."""
    labels = np.zeros((40, 70), dtype=np.uint8)
    for label, seed, row, column in ((2, 1, 0, 3), (5, 4, 6, 36)):
        cell = cd.simulate.random_smooth(seed, radius=12, margin=0)[: 40 - row, : 70 - column]
        labels[row : row + cell.shape[0], column : column + cell.shape[1]][cell] = label
    return labels


def windows_of(study: cd.Study, cell: int, frame: int | None = None) -> CellWindows:
    return cd.polar_windows(**GRID).on(study.map(cell, frame))


def centres_in(area: FloatArray | shapely.Geometry, shape: tuple[int, int]) -> BoolArray:
    """Pixels whose centres lie in a polygon (x, y), where pixel (0, 0) covers 0 to 1."""
    polygon = area if isinstance(area, shapely.Geometry) else shapely.Polygon(area)
    y, x = np.mgrid[: shape[0], : shape[1]] + 0.5
    return np.asarray(shapely.contains_xy(polygon, x, y))


def check_places(windows: CellWindows, areas: list[FloatArray] | list[shapely.Geometry]) -> None:
    """Each polygon holds all pixels that are wholly in its window, and none but those that it touches."""
    assert len(areas) == windows.grid.n_windows
    shares = windows.weights.toarray()
    for area, share in zip(areas, shares, strict=True):
        held = centres_in(area, windows.mask.shape)[windows.mask]
        assert (share > 1 - 1e-9).any()
        assert held[share > 1 - 1e-9].all()
        assert (share[held] > 0).all()
