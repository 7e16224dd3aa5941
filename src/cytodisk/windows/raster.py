"""Windows of the parts of all pixels of a cell, triangle after triangle and row after row.

Within a triangle the map is linear, so a row of parts goes to a straight line in the disk, and where that
meets the next ray or circle of the grid is known without looking at the parts before.
"""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, Int32Array, IntArray
from cytodisk.disk.circle import polygon_radius_at
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.edge_parts import part_places
from cytodisk.windows.grid import PolarGrid

_MARGIN = 1e-12  # of the disk's radius: nearer to a window's border than this, a point is looked at closely
_BEFORE_BORDER = 1e-6  # of a part: so far before a border a stretch ends, and its next part is looked at
_ON_EDGE = 1e-9  # of a part: a point so far beyond a triangle's edge is still on it


def windows_of_all_parts(grid: PolarGrid, disk: DiskMap, pixels_yx: IntArray, per_side: int) -> Int32Array:
    """Window that each part of each mask pixel maps into; a part outside goes with the nearest outline point.

    Parameters
    ----------
    grid : PolarGrid
    disk : DiskMap
        One to one: not by "advection", whose triangles may lie over each other.
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column) of all pixels of the mask, in row-major order.
    per_side : int
        Parts along a pixel's side.

    Returns
    -------
    ndarray of shape (P, parts) and dtype int32
        Parts row by row.
    """
    corner = pixels_yx.min(axis=0)
    height, width = pixels_yx.max(axis=0) - corner + 1
    number = np.full((height, width), -1, dtype=np.int32)
    inside = disk.mask[corner[0] : corner[0] + height, corner[1] : corner[1] + width]
    number[inside] = np.arange(len(pixels_yx), dtype=np.int32)
    window = np.full((len(pixels_yx), per_side**2), -1, dtype=np.int32)
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
    places = part_places(pixels_yx[pixel], per_side)[np.arange(len(pixel)), part]
    window[pixel, part] = grid.window_of(disk.to_disk(places, outside="nearest"))
    return window


@njit(cache=True)
def _outside(window: Int32Array) -> tuple[IntArray, IntArray]:
    """Pixel and part of every part that no triangle holds."""
    pixels, parts = [], []
    for pixel in range(window.shape[0]):
        signs = 0
        for part in range(window.shape[1]):
            signs |= window[pixel, part]
        if signs >= 0:
            continue
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
    layer, sector = 0, 0
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        y0, x0 = vertices_yx[i, 0], vertices_yx[i, 1]
        y1, x1 = vertices_yx[j, 0], vertices_yx[j, 1]
        y2, x2 = vertices_yx[k, 0], vertices_yx[k, 1]
        u0, v0 = vertices_uv[i, 0], vertices_uv[i, 1]
        u1, v1 = vertices_uv[j, 0] - u0, vertices_uv[j, 1] - v0
        u2, v2 = vertices_uv[k, 0] - u0, vertices_uv[k, 1] - v0
        u_by_y, u_by_x = _gradient(u1, u2, y1 - y0, x1 - x0, y2 - y0, x2 - x0)
        v_by_y, v_by_x = _gradient(v1, v2, y1 - y0, x1 - x0, y2 - y0, x2 - x0)
        if not _holds(u0, v0, u0 * u0 + v0 * v0, layer, sector, inner, outer, rays):
            layer, sector = _window_at(u0, v0, boundary_angles, radii, sectors)
        alike = _holds_triangle(u0, v0, u0 + u1, v0 + v1, u0 + u2, v0 + v2, layer, sector, inner, outer, rays)
        row_layer, row_sector = layer, sector  # of the first part of the row before
        (ya, xa), (yb, xb), (yc, xc) = _by_row((y0, x0), (y1, x1), (y2, x2))
        ab = (xb - xa) / (yb - ya) if yb > ya else 0.0
        bc = (xc - xb) / (yc - yb) if yc > yb else 0.0
        ac = (xc - xa) / (yc - ya)
        first_row = max(math.ceil(ya - 0.5 - _ON_EDGE), 0)
        last_row = min(math.floor(yc - 0.5 + _ON_EDGE), height * per_side - 1)
        for row in range(first_row, last_row + 1):
            y = min(max(row + 0.5, ya), yc)
            one = xa + (y - ya) * ac
            other = xa + (y - ya) * ab if y < yb else xb + (y - yb) * bc
            first = max(math.ceil(min(one, other) - 0.5 - _ON_EDGE), 0)
            last = min(math.floor(max(one, other) - 0.5 + _ON_EDGE), width * per_side - 1)
            y = row + 0.5
            u_row = u0 + u_by_y * (y - y0) + u_by_x * (0.5 - x0)
            v_row = v0 + v_by_y * (y - y0) + v_by_x * (0.5 - x0)
            pixel_row, part_row = row // per_side, (row % per_side) * per_side
            layer, sector = row_layer, row_sector
            low, high = inner[layer], outer[layer]
            right_u, right_v = rays[sector, 0], rays[sector, 1]
            left_u, left_v = rays[sector + 1, 0], rays[sector + 1, 1]
            column = first
            while column <= last:
                u, v = u_row + column * u_by_x, v_row + column * v_by_x
                square = u * u + v * v
                end = last
                if not alike and not (
                    low <= square < high
                    and right_u * v - right_v * u > _MARGIN
                    and left_u * v - left_v * u < -_MARGIN
                ):
                    layer, sector = _next_window(u, v, square, layer, sector, inner, outer, rays)
                    if layer < 0:
                        layer, sector = _window_at(u, v, boundary_angles, radii, sectors)
                    low, high = inner[layer], outer[layer]
                    right_u, right_v = rays[sector, 0], rays[sector, 1]
                    left_u, left_v = rays[sector + 1, 0], rays[sector + 1, 1]
                    if not _holds(u, v, square, layer, sector, inner, outer, rays):
                        end = column  # on a border: the next part is looked at by itself
                if column == first:
                    row_layer, row_sector = layer, sector
                if end > column and not alike:
                    steps = float(end - column)
                    by_step = right_u * v_by_x - right_v * u_by_x
                    if by_step < 0.0:
                        steps = min(steps, (_MARGIN - right_u * v + right_v * u) / by_step)
                    by_step = left_v * u_by_x - left_u * v_by_x
                    if by_step < 0.0:
                        steps = min(steps, (_MARGIN - left_v * u + left_u * v) / by_step)
                    steps = _steps_within(u, v, square, u_by_x, v_by_x, steps, low, high)
                    if steps < end - column:
                        end = column + max(math.floor(steps - _BEFORE_BORDER), 0)
                here = layer * sectors + sector
                for part in range(column, end + 1):
                    pixel = number[pixel_row, pixel_column[part]]
                    if pixel >= 0:
                        window[pixel, part_row + part_column[part]] = here
                column = end + 1


@njit(cache=True, error_model="numpy")
def _gradient(one: float, other: float, y1: float, x1: float, y2: float, x2: float) -> tuple[float, float]:
    """Slopes along y and x of a linear function that is 0 at the origin and known at two points."""
    twice = x1 * y2 - y1 * x2
    return (other * x1 - one * x2) / twice, (one * y2 - other * y1) / twice


@njit(cache=True)
def _holds(
    u: float,
    v: float,
    square: float,
    layer: int,
    sector: int,
    inner: FloatArray,
    outer: FloatArray,
    rays: FloatArray,
) -> bool:
    """Whether a point is surely in a window. All but the inner bound are convex."""
    return bool(
        inner[layer] <= square < outer[layer]
        and rays[sector, 0] * v - rays[sector, 1] * u > _MARGIN
        and rays[sector + 1, 0] * v - rays[sector + 1, 1] * u < -_MARGIN
    )


@njit(cache=True, error_model="numpy")
def _steps_within(
    u: float, v: float, square: float, du: float, dv: float, steps: float, low: float, high: float
) -> float:
    """How many steps (du, dv), at most `steps`, keep the square of a point's radius between two bounds."""
    length, along = du * du + dv * dv, u * du + v * dv
    there = square + steps * (2.0 * along + steps * length)
    if there >= high:
        steps = min(steps, (math.sqrt(along * along + length * (high - square)) - along) / length)
    if along < 0.0 and min(square, there) - 0.25 * steps * steps * length < low:
        discriminant = along * along - length * (square - low)
        if discriminant > 0.0:
            steps = min(steps, (-along - math.sqrt(discriminant)) / length)
    return steps


@njit(cache=True)
def _holds_triangle(
    u0: float,
    v0: float,
    u1: float,
    v1: float,
    u2: float,
    v2: float,
    layer: int,
    sector: int,
    inner: FloatArray,
    outer: FloatArray,
    rays: FloatArray,
) -> bool:
    """Whether all of a triangle is surely in a window; the centre of the disk is at most at its corner."""
    return (
        _holds(u0, v0, u0 * u0 + v0 * v0, layer, sector, inner, outer, rays)
        and _holds(u1, v1, u1 * u1 + v1 * v1, layer, sector, inner, outer, rays)
        and _holds(u2, v2, u2 * u2 + v2 * v2, layer, sector, inner, outer, rays)
        and _square_of_nearest(u0, v0, u1, v1) >= inner[layer]
        and _square_of_nearest(u1, v1, u2, v2) >= inner[layer]
        and _square_of_nearest(u2, v2, u0, v0) >= inner[layer]
    )


@njit(cache=True)
def _by_row(
    a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]
) -> tuple[tuple[float, float], tuple[float, float], tuple[float, float]]:
    """Three points by their first coordinate."""
    if b[0] < a[0]:
        a, b = b, a
    if c[0] < b[0]:
        b, c = c, b
    if b[0] < a[0]:
        a, b = b, a
    return a, b, c


@njit(cache=True)
def _square_of_nearest(u0: float, v0: float, u1: float, v1: float) -> float:
    """Square of the distance from the centre to the segment between two points."""
    du, dv = u1 - u0, v1 - v0
    length = du * du + dv * dv
    along = -(u0 * du + v0 * dv)
    if along <= 0.0:
        return u0 * u0 + v0 * v0
    if along >= length:
        return u1 * u1 + v1 * v1
    across = u0 * dv - v0 * du
    return across * across / length


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
    return (layer, sector) if _holds(u, v, square, layer, sector, inner, outer, rays) else (-1, -1)


@njit(cache=True)
def _least_polygon_radius(angles: FloatArray) -> float:
    """Radius of the polygon of points on the unit circle, at the middle of its longest side."""
    widest = angles[0] + 2.0 * math.pi - angles[-1]
    for n in range(len(angles) - 1):
        widest = max(widest, angles[n + 1] - angles[n])
    return math.cos(0.5 * widest)


@njit(cache=True)
def _window_at(
    u: float, v: float, boundary_angles: FloatArray, radii: FloatArray, sectors: int
) -> tuple[int, int]:
    """Layer and sector of a point of the mapped polygon, as `PolarGrid.window_of` after `to_disk`."""
    radius = math.hypot(u, v) / polygon_radius_at(u, v, boundary_angles)
    layer = 0
    while layer < len(radii) - 2 and radii[layer + 1] > radius:
        layer += 1
    sector = math.floor((math.atan2(v, u) / (2.0 * math.pi)) % 1.0 * sectors)
    return layer, min(sector, sectors - 1)
