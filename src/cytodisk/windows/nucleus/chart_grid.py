"""A grid of windows as it lies in the charts of a map with a nucleus.

On triangles of the cytoplasm the map is linear in (share, turn): the share of the cytoplasm's disk area
between a place and the membrane, and the angle in turns; windows are rectangles there. On triangles of the
nucleus it is linear in (u, v) of the nucleus' own unit disk, a polygon with its corners on the circle; that
goes to the round disk ray by ray, with angles that grow evenly along each chord. So rays between sectors stay
rays.
"""

from typing import NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.nucleus.cone import to_polygon
from cytodisk.windows.pixel_shares.raster import RoundGrid
from cytodisk.windows.pixel_shares.window_walls import layer_bands
from cytodisk.windows.polar_layout import PolarLayout


class ChartGrid(NamedTuple):
    """What kernels need of a grid on a map with a nucleus.

    Attributes
    ----------
    borders : ndarray of shape (cytoplasm layers + 1,) and dtype float
        Shares of the cytoplasm between its layers, from 0 to 1.
    sectors : int
    nucleus : RoundGrid
        In the nucleus' own disk. Layers of the cytoplasm have bands that hold no place of it.
    """

    borders: FloatArray
    sectors: int
    nucleus: RoundGrid


def chart_grid(grid: PolarLayout, nucleus_angles: FloatArray) -> ChartGrid:
    """A grid in the charts of a map.

    Parameters
    ----------
    grid : PolarLayout
        With the radius of the map's nucleus.
    nucleus_angles : ndarray of shape (N,) and dtype float
        Angles of the nuclear outline's vertices in radians, strictly increasing within one turn.

    Returns
    -------
    ChartGrid
    """
    outer = grid.cytoplasm_layers
    radius = grid.radii[outer]
    bands = layer_bands(grid.radii[outer:] / radius, nucleus_angles)
    bands = np.concatenate([np.full((outer, 3), np.inf), bands])
    rays = to_polygon(np.ones(len(grid.angles)), grid.angles, nucleus_angles)
    rays /= np.hypot(rays[:, 0], rays[:, 1])[:, None]
    return ChartGrid(cytoplasm_shares(grid), grid.sectors, (bands, rays, nucleus_angles, True))


def cytoplasm_shares(grid: PolarLayout) -> FloatArray:
    """Share of the cytoplasm's disk area between each of its borders and the membrane, from 0 to 1."""
    squares = np.square(grid.radii[: grid.cytoplasm_layers + 1])
    shares = (1.0 - squares) / (1.0 - squares[-1])
    shares[squares == squares[-1]] = 1.0
    return np.asarray(shares)
