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
            polygons.append(_joined(outer, following, inner, here))
    return polygons


def window_polygon(grid: PolarLayout, disk: DiskMap, number: int) -> FloatArray:
    """Outline of one window in the cell; see `window_polygons`, which makes all of them faster.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap
    number : int
        Of the window, layer · sectors + sector.

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        (row, column) in pixels, last point not repeated; without points for a layer deeper than the cell.
    """
    layer, sector = divmod(number, grid.sectors)
    if not grid.present[layer]:
        return np.empty((0, 2))
    outer, inner = (_arc(grid, disk, radius, sector) for radius in grid.radii[layer : layer + 2])
    here, following = (_side(grid, disk, angle, layer) for angle in grid.angles[sector : sector + 2])
    return _joined(outer, following, inner, here)


def _joined(outer: FloatArray, following: FloatArray, inner: FloatArray, here: FloatArray) -> FloatArray:
    """A window's outline from its four sides; the inner one and the first run against it."""
    polygon = np.concatenate([outer, following[1:-1], inner[::-1], here[-2:0:-1]])
    moved = (np.diff(polygon, axis=0, append=polygon[:1]) != 0).any(axis=1)
    return np.asarray(polygon[moved])


def _sector_arcs(grid: PolarLayout, disk: DiskMap, radius: float) -> list[FloatArray]:
    """Arc of each sector at one radius, mapped into the cell, both ends included."""
    angles, points = _around(disk, radius, np.unique(np.concatenate([_corners(disk, radius), grid.angles])))
    points[-1] = points[0]
    ends = np.searchsorted(angles, grid.angles)
    return [points[first : last + 1] for first, last in pairwise(ends)]


def _arc(grid: PolarLayout, disk: DiskMap, radius: float, sector: int) -> FloatArray:
    """One of `_sector_arcs`."""
    first, last = grid.angles[sector : sector + 2]
    corners = _corners(disk, radius)
    within = np.unique([first, *corners[(corners > first) & (corners < last)], last])
    return _around(disk, radius, within)[1]


def _corners(disk: DiskMap, radius: float) -> FloatArray:
    """Angles of the points of the outline that a circle of the disk follows, from 0 to 2π."""
    within = disk.nucleus is not None and radius <= disk.nucleus.radius
    angles = disk.nucleus.boundary_angles if disk.nucleus is not None and within else disk.boundary_angles
    return np.mod(angles, 2.0 * np.pi)


def _around(disk: DiskMap, radius: float, angles: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Angles along a circle of the disk, with more where it is drawn out, and their points in the cell."""
    on_outline = radius == 1.0 or (disk.nucleus is not None and radius == disk.nucleus.radius)
    halvings = 0 if on_outline else _HALVINGS  # an outline is straight between its points

    def points_at(places: FloatArray) -> FloatArray:
        return disk.to_cell(radius * np.column_stack([np.cos(places), np.sin(places)]))

    return _finely(points_at, angles, halvings)


def _spoke(grid: PolarLayout, disk: DiskMap, angle: float) -> list[FloatArray]:
    """A sector's first side by layer, from outside in, both ends included."""
    layers = [_steps(grid, layer) for layer in range(grid.layers)]
    along = np.concatenate([layers[0], *(layer[1:] for layer in layers[1:])])
    radii, points = _inwards(disk, angle, along)
    ends = np.searchsorted(-radii, -grid.radii)
    return [points[first : last + 1] for first, last in pairwise(ends)]


def _side(grid: PolarLayout, disk: DiskMap, angle: float, layer: int) -> FloatArray:
    """One of a `_spoke`."""
    return _inwards(disk, angle, _steps(grid, layer))[1]


def _steps(grid: PolarLayout, layer: int) -> FloatArray:
    """Radii of the samples along a side of a window."""
    outer, inner = grid.radii[layer : layer + 2].tolist()
    return np.linspace(outer, inner, max(2, _POINTS_PER_RADIUS // grid.layers))


def _inwards(disk: DiskMap, angle: float, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Radii along a ray of the disk, with more where it is drawn out, and their points in the cell."""
    direction = np.array([np.cos(angle), np.sin(angle)])

    def points_at(places: FloatArray) -> FloatArray:
        return disk.to_cell(places[:, None] * direction)

    return _finely(points_at, radii, _HALVINGS)


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
