"""Window outlines in the cell, as polygons that fit together."""

from itertools import pairwise

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.polar_layout import PolarLayout

_POINTS_PER_RADIUS = 256  # samples along a radius of the disk, shared among the layers


def window_polygons(grid: PolarLayout, disk: DiskMap) -> list[FloatArray]:
    """Outline of every window in the cell.

    Rings and spokes of the grid are sampled as finely as the boundary is, so neighbours share their points,
    and layer 0 follows the cell's outline exactly.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap

    Returns
    -------
    list of ndarray of shape (N, 2) and dtype float
        By window number, (row, column) in pixels, last point not repeated.
    """
    rings = [_sector_arcs(grid, disk, radius) for radius in grid.radii]
    per_layer = max(2, _POINTS_PER_RADIUS // grid.layers)
    polygons = []
    for layer in range(grid.layers):
        spokes = _spokes(grid, disk, layer, per_layer)
        for sector in range(grid.sectors):
            following = (sector + 1) % grid.sectors
            outer, inner = rings[layer][sector], rings[layer + 1][sector]
            polygon = np.concatenate([outer, spokes[following][1:-1], inner[::-1], spokes[sector][-2:0:-1]])
            moved = (np.diff(polygon, axis=0, append=polygon[:1]) != 0).any(axis=1)
            polygons.append(polygon[moved])
    return polygons


def _sector_arcs(grid: PolarLayout, disk: DiskMap, radius: float) -> list[FloatArray]:
    """Arc of each sector at one radius, mapped into the cell, both ends included."""
    turn = 2.0 * np.pi
    within = np.unique(np.concatenate([np.mod(disk.boundary_angles, turn), grid.angles]))
    points = disk.to_cell(np.column_stack([radius * np.cos(within), radius * np.sin(within)]))
    points[-1] = points[0]
    ends = np.searchsorted(within, grid.angles)
    return [points[first : last + 1] for first, last in pairwise(ends)]


def _spokes(grid: PolarLayout, disk: DiskMap, layer: int, samples: int) -> FloatArray:
    """Each sector's first side within a layer, from outside in, shape (sectors, samples, 2)."""
    radius = np.linspace(grid.radii[layer], grid.radii[layer + 1], samples)
    angle = grid.angles[:-1, None]
    return disk.to_cell(np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1))
