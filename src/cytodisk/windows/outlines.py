"""Window outlines in the cell, as polygons that fit together."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.polar_layout import PolarLayout

_POINTS_PER_RADIUS = 256  # samples along a radius of the disk, shared among the layers
_LONGEST_PX = 0.5  # between points of an outline, but where it would take more than so many halvings
_HALVINGS = 6


def window_polygons(grid: PolarLayout, disk: DiskMap) -> list[FloatArray]:
    """Outline of every window in the cell.

    Rings and spokes of the grid are sampled as finely as the boundary is, and more where they are drawn out,
    so neighbours share their points, and layer 0 follows the cell's outline exactly, the first layer of a
    nucleus that of the nucleus.

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
    spokes = [_spoke(grid, disk, angle) for angle in grid.angles[:-1]]
    polygons = []
    for layer in range(grid.layers):
        if not grid.present[layer]:
            polygons += [np.empty((0, 2))] * grid.sectors
            continue
        for sector in range(grid.sectors):
            here, following = spokes[sector][layer], spokes[(sector + 1) % grid.sectors][layer]
            outer, inner = rings[layer][sector], rings[layer + 1][sector]
            polygon = np.concatenate([outer, following[1:-1], inner[::-1], here[-2:0:-1]])
            moved = (np.diff(polygon, axis=0, append=polygon[:1]) != 0).any(axis=1)
            polygons.append(polygon[moved])
    return polygons


def _sector_arcs(grid: PolarLayout, disk: DiskMap, radius: float) -> list[FloatArray]:
    """Arc of each sector at one radius, mapped into the cell, both ends included."""
    corners = disk.boundary_angles
    if disk.nucleus is not None and radius <= disk.nucleus.radius:
        corners = disk.nucleus.boundary_angles
    within = np.unique(np.concatenate([np.mod(corners, 2.0 * np.pi), grid.angles]))
    on_outline = radius == 1.0 or (disk.nucleus is not None and radius == disk.nucleus.radius)
    halvings = 0 if on_outline else _HALVINGS  # an outline is straight between its points

    def points_at(angles: FloatArray) -> FloatArray:
        return disk.to_cell(radius * np.column_stack([np.cos(angles), np.sin(angles)]))

    angles, points = _finely(points_at, within, halvings)
    points[-1] = points[0]
    ends = np.searchsorted(angles, grid.angles)
    return [points[first : last + 1] for first, last in pairwise(ends)]


def _spoke(grid: PolarLayout, disk: DiskMap, angle: float) -> list[FloatArray]:
    """A sector's first side by layer, from outside in, both ends included."""
    samples = max(2, _POINTS_PER_RADIUS // grid.layers)
    layers = [np.linspace(outer, inner, samples) for outer, inner in pairwise(grid.radii)]
    direction = np.array([np.cos(angle), np.sin(angle)])

    def points_at(radii: FloatArray) -> FloatArray:
        return disk.to_cell(radii[:, None] * direction)

    along = np.concatenate([layers[0], *(layer[1:] for layer in layers[1:])])
    radii, points = _finely(points_at, along, _HALVINGS)
    ends = np.searchsorted(-radii, -grid.radii)
    return [points[first : last + 1] for first, last in pairwise(ends)]


def _finely(
    points_at: Callable[[FloatArray], FloatArray], places: FloatArray, halvings: int
) -> tuple[FloatArray, FloatArray]:
    """Places along a line, and their points in the cell, with more between points that lie far apart."""
    points = points_at(places)
    for _ in range(halvings):
        far = np.flatnonzero(np.hypot(*np.diff(points, axis=0).T) > _LONGEST_PX)
        if not len(far):
            break
        between = (places[far] + places[far + 1]) / 2.0
        places = np.insert(places, far + 1, between)
        points = np.insert(points, far + 1, points_at(between), axis=0)
    return places, points
