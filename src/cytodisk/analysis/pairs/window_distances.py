"""How far windows of a cell are from each other: straight, through the inside, and along the edge."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra
from scipy.spatial.distance import cdist

from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.checks import whole_number
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.geometry.locate import TriangleLocator
from cytodisk.geometry.polygon import edge_lengths, smooth_closed
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.windows.polar_windows import PolarGrid

DISTANCE_DIMS = ("layer", "sector", "other_layer", "other_sector")
_SMOOTHING_PX = 1.0  # of the edge, whose stair steps of pixels are up to 8 % too long
_LOOK_EVERY = 0.5  # pixels between the places at which a straight line must be inside the cell


def window_distances(cell: DiskMap | DiskMovie, grid: PolarGrid, *, frames: int = 5) -> xr.Dataset:
    """Distances between the centres of all windows of a cell.

    Parameters
    ----------
    cell : DiskMap or DiskMovie
        For a movie, the mean over frames that are spread evenly over those with a map.
    grid : PolarGrid
    frames : int
        Number of frames of a movie, at least 1.

    Returns
    -------
    Dataset with dims (layer, sector, other_layer, other_sector)
        straight; interior, the shortest way that stays in the cell; edge, the shortest way along the edge
        between the sectors, whatever the layers. In µm when the cell knows its scale, else px, as attrs
        `units` says.

    Raises
    ------
    WindowError
        The movie has no map.
    ParameterError
        `frames` is below 1.

    See Also
    --------
    correlate_pairs : Correlation by these distances.

    Notes
    -----
    A window's centre is the middle of its radii and angles on the disk, brought to the cell. The way through
    the inside is the straight line where that stays in the cell (looked at every half pixel), else the
    shortest path along edges of the mesh and across pairs of its triangles, by Dijkstra, which is too long:
    around the slot of a U by 2 % in the mean and at most 9 %. The edge is smoothed over a pixel, as for the
    map's angles, before its length is taken.

    Examples
    --------
    >>> import cytodisk as cd
    >>> disk = cd.map_to_disk(cd.simulate.disk(20))
    >>> distances = cd.window_distances(disk, cd.polar_windows(layers=2, sectors=8))
    >>> first = distances.sel(layer=0, sector=0, other_layer=0, other_sector=4)  # across the cell
    >>> round(float(first["straight"])), round(float(first["edge"]))
    (34, 63)
    """
    frames = whole_number("frames", frames, 1)
    maps: list[DiskMap] = []
    if isinstance(cell, DiskMap):
        maps = [cell]
    else:
        mapped = np.flatnonzero(cell.mapped)
        if not mapped.size:
            raise WindowError("the movie has no frame with a map: there are no distances")
        chosen = mapped[
            np.unique(np.linspace(0, mapped.size - 1, min(frames, mapped.size)).round().astype(int))
        ]
        maps = [cell[int(number)] for number in chosen]
    tables = [_distances_on(disk, grid) for disk in maps]
    attrs = {"units": cell.scale.length_unit} | cell.scale.attrs
    shape = (grid.layers, grid.sectors, grid.layers, grid.sectors)
    data: dict[str, Any] = {
        name: (
            DISTANCE_DIMS,
            cell.scale.length(np.mean([table[name] for table in tables], axis=0)).reshape(shape),
            attrs,
        )
        for name in tables[0]
    }
    coords = {dim: np.arange(size) for dim, size in zip(DISTANCE_DIMS, shape, strict=True)}
    return xr.Dataset(data, coords, attrs=attrs)


def disk_distances(layers: int, sectors: int) -> FloatArray:
    """Straight distances between window centres on the unit disk with layers of equal area, (W, W)."""
    radius = np.sqrt(1.0 - (np.arange(layers) + 0.5) / layers)
    angle = 2.0 * np.pi * (np.arange(sectors) + 0.5) / sectors
    centres = radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.asarray(cdist(centres.reshape(-1, 2), centres.reshape(-1, 2)))


def _distances_on(disk: DiskMap, grid: PolarGrid) -> dict[str, FloatArray]:
    """Distances of one map in pixels, each of shape (W, W)."""
    grid = grid.on(disk).grid
    centres_uv = _centres_uv(grid)
    centres_yx = disk.to_cell(centres_uv.reshape(-1, 2))
    straight = cdist(centres_yx, centres_yx)
    interior = np.maximum(_along_mesh(disk, centres_yx), straight)
    interior = np.where(_sees(disk.mask, centres_yx), straight, interior)
    edge = _along_edge(disk, 0.5 * (grid.angles[:-1] + grid.angles[1:]))
    across = np.tile(edge, (grid.layers, grid.layers))
    return {"straight": straight, "interior": interior, "edge": across}


def _centres_uv(grid: PolarGrid) -> FloatArray:
    radius = 0.5 * (grid.radii[:-1] + grid.radii[1:])
    angle = 0.5 * (grid.angles[:-1] + grid.angles[1:])
    return np.asarray(radius[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=-1))


def _along_edge(disk: DiskMap, angles: FloatArray) -> FloatArray:
    """Shortest way along the outline between the places at angles of the disk, (S, S)."""
    loop = disk.vertices_yx[disk.boundary]
    uv = disk.vertices_uv[disk.boundary]
    theta = np.unwrap(np.arctan2(uv[:, 1], uv[:, 0]))
    steps = edge_lengths(smooth_closed(loop, _SMOOTHING_PX))
    along = np.concatenate([[0.0], np.cumsum(steps)])
    place = np.interp((angles - theta[0]) % (2.0 * np.pi), np.append(theta - theta[0], 2.0 * np.pi), along)
    apart = np.abs(place[:, None] - place)
    return np.asarray(np.minimum(apart, along[-1] - apart))


def _along_mesh(disk: DiskMap, points_yx: FloatArray) -> FloatArray:
    """Shortest paths between points over the mesh, (W, W)."""
    triangle, _ = TriangleLocator(disk.vertices_yx, disk.triangles)(points_yx)
    nodes = np.concatenate([disk.vertices_yx, points_yx])
    point = len(disk.vertices_yx) + np.arange(len(points_yx))
    spokes = np.column_stack([np.repeat(point, 3), disk.triangles[triangle].ravel()])
    links = np.concatenate([_links(disk), spokes])
    length = np.linalg.norm(nodes[links[:, 0]] - nodes[links[:, 1]], axis=1)
    graph = coo_array((length, tuple(links.T)), shape=(len(nodes), len(nodes))).tocsr()
    return np.asarray(dijkstra(graph, directed=False, indices=point)[:, point])


def _links(disk: DiskMap) -> IntArray:
    """Vertices that see each other: ends of edges, and far corners of convex pairs of triangles."""
    corners = disk.triangles
    edge = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    apex = np.concatenate([corners[:, 2], corners[:, 0], corners[:, 1]])
    key = np.sort(edge, axis=1)
    order = np.lexsort(key.T)
    key, apex = key[order], apex[order]
    twice = np.flatnonzero((key[1:] == key[:-1]).all(axis=1))
    shared, far = key[twice], np.column_stack([apex[twice], apex[twice + 1]])
    yx = disk.vertices_yx
    side = [_side(yx[far[:, 0]], yx[far[:, 1]], yx[shared[:, k]]) for k in (0, 1)]
    convex = side[0] * side[1] < 0  # the line between the far corners crosses the shared edge
    return np.concatenate([np.unique(key, axis=0), far[convex]])


def _side(start: FloatArray, stop: FloatArray, point: FloatArray) -> FloatArray:
    """Twice the signed area of triangles: on which side of a line a point lies."""
    along, away = stop - start, point - start
    return np.asarray(along[:, 1] * away[:, 0] - along[:, 0] * away[:, 1])


def _sees(mask: BoolArray, points_yx: FloatArray) -> BoolArray:
    """Whether the straight line between two points stays on pixels of the cell, (W, W)."""
    found = np.ones((len(points_yx), len(points_yx)), dtype=bool)
    for row, start in enumerate(points_yx[:-1]):
        away = points_yx[row + 1 :] - start
        steps = int(np.ceil(np.linalg.norm(away, axis=1).max() / _LOOK_EVERY)) + 1
        looked = start + away[:, None] * np.linspace(0.0, 1.0, steps)[:, None]
        y, x = np.moveaxis(np.rint(looked).astype(np.intp), -1, 0)
        y, x = np.clip(y, 0, mask.shape[0] - 1), np.clip(x, 0, mask.shape[1] - 1)
        found[row, row + 1 :] = found[row + 1 :, row] = mask[y, x].all(axis=1)
    return found
