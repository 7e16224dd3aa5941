"""Windows of the parts of all pixels of a cell, triangle after triangle and row after row.

Within a triangle the map is linear, so a part's place in the disk follows from its neighbour's by an
addition, and nearly always it is in the same window.
"""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, Int32Array, IntArray
from cytodisk.disk.circle import polygon_radius_at
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.edge_parts import part_places
from cytodisk.windows.grid import PolarWindows

_MARGIN = 1e-12  # of the disk's radius: nearer to a window's border than this, a point is looked at closely
_ON_EDGE = 1e-9  # of a part: a point so far beyond a triangle's edge is still on it


def windows_of_all_parts(grid: PolarWindows, disk: DiskMap, per_side: int) -> Int32Array:
    """Window that each part of each mask pixel maps into; a part outside goes with the nearest outline point.

    Parameters
    ----------
    grid : PolarWindows
    disk : DiskMap
        One to one: not by "advection", whose triangles may lie over each other.
    per_side : int
        Parts along a pixel's side.

    Returns
    -------
    ndarray of shape (P, parts) and dtype int32
        Pixels of the mask in row-major order, parts row by row.
    """
    rows, columns = np.flatnonzero(disk.mask.any(axis=1)), np.flatnonzero(disk.mask.any(axis=0))
    corner = np.array([rows[0], columns[0]])
    inside = disk.mask[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    number = np.where(inside, np.cumsum(inside, dtype=np.int32).reshape(inside.shape) - 1, -1)
    window = np.full((int(inside.sum()), per_side**2), -1, dtype=np.int32)
    _paint(
        (disk.vertices_yx - (corner - 0.5)) * per_side,
        disk.vertices_uv,
        disk.triangles,
        disk.boundary_angles,
        grid.radii,
        np.column_stack([np.cos(grid.angles), np.sin(grid.angles)]),
        per_side,
        number,
        window,
    )
    pixel, part = _outside(window)
    places = part_places(np.argwhere(disk.mask)[pixel], per_side)[np.arange(len(pixel)), part]
    window[pixel, part] = grid.window_of(disk.to_disk(places, outside="nearest"))
    return window


@njit(cache=True)
def _outside(window: Int32Array) -> tuple[IntArray, IntArray]:
    """Pixel and part of every part that no triangle holds."""
    pixels, parts = [], []
    for pixel in range(window.shape[0]):
        for part in range(window.shape[1]):
            if window[pixel, part] < 0:
                pixels.append(pixel)
                parts.append(part)
    return np.array(pixels, dtype=np.int64), np.array(parts, dtype=np.int64)


@njit(cache=True, error_model="numpy")
def _paint(
    vertices_yx: FloatArray,
    vertices_uv: FloatArray,
    triangles: IntArray,
    boundary_angles: FloatArray,
    radii: FloatArray,
    rays: FloatArray,
    per_side: int,
    number: Int32Array,
    window: Int32Array,
) -> None:
    """Fill `window` for the parts that lie in a triangle; vertices are in units of a part."""
    sectors = len(rays) - 1
    height, width = number.shape
    inner, outer = np.square(radii[1:]) * (1.0 + _MARGIN), np.square(radii[:-1]) * (1.0 - _MARGIN)
    inner[-1] = -1.0
    outer *= _least_polygon_radius(boundary_angles) ** 2  # the rim is a polygon a little inside the circle
    outer[0] = np.inf
    pixel_column = np.arange(width * per_side, dtype=np.int32) // per_side
    part_column = np.arange(width * per_side, dtype=np.int32) % per_side
    layer, sector, here = 0, 0, 0  # of the part before
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        y0, x0 = vertices_yx[i, 0], vertices_yx[i, 1]
        y1, x1 = vertices_yx[j, 0], vertices_yx[j, 1]
        y2, x2 = vertices_yx[k, 0], vertices_yx[k, 1]
        u0, v0 = vertices_uv[i, 0], vertices_uv[i, 1]
        u1, v1 = vertices_uv[j, 0] - u0, vertices_uv[j, 1] - v0
        u2, v2 = vertices_uv[k, 0] - u0, vertices_uv[k, 1] - v0
        twice = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
        u_by_x = (u1 * (y2 - y0) - u2 * (y1 - y0)) / twice
        u_by_y = (u2 * (x1 - x0) - u1 * (x2 - x0)) / twice
        v_by_x = (v1 * (y2 - y0) - v2 * (y1 - y0)) / twice
        v_by_y = (v2 * (x1 - x0) - v1 * (x2 - x0)) / twice
        first_row = max(math.ceil(min(y0, y1, y2) - 0.5 - _ON_EDGE), 0)
        last_row = min(math.floor(max(y0, y1, y2) - 0.5 + _ON_EDGE), height * per_side - 1)
        for row in range(first_row, last_row + 1):
            y = row + 0.5
            left, right = np.inf, -np.inf
            for ya, xa, yb, xb in ((y0, x0, y1, x1), (y1, x1, y2, x2), (y2, x2, y0, x0)):
                if min(ya, yb) - _ON_EDGE <= y <= max(ya, yb) + _ON_EDGE:
                    s = min(max((y - ya) / (yb - ya), 0.0), 1.0) if ya != yb else 0.0
                    x = xa + s * (xb - xa)
                    left, right = min(left, x), max(right, x)
                    if ya == yb:
                        left, right = min(left, xb), max(right, xb)
            first = max(math.ceil(left - 0.5 - _ON_EDGE), 0)
            last = min(math.floor(right - 0.5 + _ON_EDGE), width * per_side - 1)
            u_row = u0 + u_by_y * (y - y0) + u_by_x * (0.5 - x0)
            v_row = v0 + v_by_y * (y - y0) + v_by_x * (0.5 - x0)
            pixel_row, part_row = row // per_side, (row % per_side) * per_side
            for column in range(first, last + 1):
                pixel = number[pixel_row, pixel_column[column]]
                if pixel < 0:
                    continue
                u, v = u_row + column * u_by_x, v_row + column * v_by_x
                square = u * u + v * v
                if not (
                    inner[layer] <= square < outer[layer]
                    and rays[sector, 0] * v - rays[sector, 1] * u > _MARGIN
                    and rays[sector + 1, 0] * v - rays[sector + 1, 1] * u < -_MARGIN
                ):
                    layer, sector = _next_window(u, v, square, layer, sector, inner, outer, rays)
                    if layer < 0:
                        layer, sector = _window_at(u, v, boundary_angles, radii, sectors)
                    here = layer * sectors + sector
                window[pixel, part_row + part_column[column]] = here


@njit(cache=True)
def _next_window(
    u: float,
    v: float,
    square: float,
    layer: int,
    sector: int,
    inner: FloatArray,
    outer: FloatArray,
    rays: FloatArray,
) -> tuple[int, int]:
    """Window of a point if that is surely one of the same sector or the next; else (-1, -1)."""
    last = len(rays) - 2
    while square < inner[layer]:
        layer += 1
    while square >= outer[layer]:
        layer -= 1
    if rays[sector, 0] * v - rays[sector, 1] * u <= _MARGIN:
        sector = sector - 1 if sector else last
    elif rays[sector + 1, 0] * v - rays[sector + 1, 1] * u >= -_MARGIN:
        sector = sector + 1 if sector < last else 0
    if (
        inner[layer] <= square
        and rays[sector, 0] * v - rays[sector, 1] * u > _MARGIN
        and rays[sector + 1, 0] * v - rays[sector + 1, 1] * u < -_MARGIN
    ):
        return layer, sector
    return -1, -1


@njit(cache=True)
def _least_polygon_radius(angles: FloatArray) -> float:
    """Of the polygon of points on the unit circle, at the middle of its longest side."""
    widest = angles[0] + 2.0 * math.pi - angles[-1]
    for n in range(len(angles) - 1):
        widest = max(widest, angles[n + 1] - angles[n])
    return math.cos(0.5 * widest)


@njit(cache=True)
def _window_at(
    u: float, v: float, boundary_angles: FloatArray, radii: FloatArray, sectors: int
) -> tuple[int, int]:
    """Layer and sector of a point of the mapped polygon, as `PolarWindows.window_of` after `to_disk`."""
    radius = math.hypot(u, v) / polygon_radius_at(u, v, boundary_angles)
    layer = 0
    while layer < len(radii) - 2 and radii[layer + 1] > radius:
        layer += 1
    sector = math.floor((math.atan2(v, u) / (2.0 * math.pi)) % 1.0 * sectors)
    return layer, min(sector, sectors - 1)
