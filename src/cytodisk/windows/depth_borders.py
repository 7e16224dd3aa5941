"""Circles of the disk that lie at given depths below the edge of a cell."""

from collections.abc import Sequence

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import WindowError
from cytodisk.geometry.edge_distance import EdgeDistance
from cytodisk.geometry.outline import on_border

_ANGLES = 180  # on a circle
_CIRCLES = 64  # that are looked at first
_HALVINGS = 8  # of the step between two of them


def radii_at_depths(
    disk: DiskMap, distance: EdgeDistance, depths_px: Sequence[float], innermost: float = 0.0
) -> FloatArray:
    """Radius of the outermost circle of the disk whose median depth in the cell is each of some depths.

    Parameters
    ----------
    disk : DiskMap
    distance : EdgeDistance
        Of the same cell.
    depths_px : sequence of float
        In pixels, increasing.
    innermost : float
        Radius of the last circle: that of the nucleus, or 0.

    Returns
    -------
    ndarray of shape (depths,) and dtype float
        Strictly decreasing, less than 1; `innermost` from the first depth on that no circle reaches.

    Raises
    ------
    WindowError
        The image shows no edge of the cell.

    Notes
    -----
    Where the border of the image cuts the cell, the angles of the disk that it cuts do not count. The median
    changes continuously with the radius: from the edge, where it is 0, it comes to the lesser of two depths
    first. The inside of a cell with a neck may be less deep again; it lies within all borders.
    """
    rays, wanted = _rays(disk), np.asarray(depths_px, dtype=np.float64)
    circles = np.linspace(1.0, innermost, _CIRCLES + 1)
    medians = np.append(0.0, _median_depths(disk, distance, rays, circles[1:]))
    reached = medians[:, None] >= wanted
    wanted = wanted[reached.any(axis=0)]
    first = reached.argmax(axis=0)[: len(wanted)]
    outer, inner = circles[first - 1], circles[first]
    above, below = medians[first - 1], medians[first]
    for _ in range(_HALVINGS):
        middle = 0.5 * (outer + inner)
        median = _median_depths(disk, distance, rays, middle)
        deep = median >= wanted
        inner, below = np.where(deep, middle, inner), np.where(deep, median, below)
        outer, above = np.where(deep, outer, middle), np.where(deep, above, median)
    radii = np.full(len(depths_px), innermost)
    radii[: len(wanted)] = outer - (wanted - above) / (below - above) * (outer - inner)
    return _decreasing(radii, innermost)


def _decreasing(radii: FloatArray, innermost: float) -> FloatArray:
    """Radii of which each is less than the one before, or the innermost, whatever rounding did."""
    for number in range(1, len(radii)):
        radii[number] = max(min(radii[number], np.nextafter(radii[number - 1], 0.0)), innermost)
    return radii


def _rays(disk: DiskMap) -> FloatArray:
    """Directions in which the cell has an edge, as unit vectors, shape (N, 2)."""
    angles = 2.0 * np.pi * (np.arange(_ANGLES) + 0.5) / _ANGLES
    directions = np.column_stack([np.cos(angles), np.sin(angles)])
    cut = on_border(disk.to_cell(directions), disk.placed_mask.image_shape)
    if cut.all():
        raise WindowError(
            "depth_um needs an edge of the cell, and the border of the image cuts it all around: pass layers"
        )
    return np.asarray(directions[~cut])


def _median_depths(disk: DiskMap, distance: EdgeDistance, rays: FloatArray, radii: FloatArray) -> FloatArray:
    """Median over the rays of the depth at each radius, shape (radii,)."""
    return np.asarray(np.median(distance.at(disk.to_cell(radii[:, None, None] * rays)), axis=1))
