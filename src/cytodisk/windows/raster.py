"""Windows of the subpixels of all pixels of a cell, triangle after triangle and row after row.

Within a triangle the map is linear, so a row of subpixels goes to a straight line in the disk, and where that
meets the next ray or circle of the grid is known without looking at the subpixels before.
"""

import math
from typing import TypeAlias

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, Int32Array, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.polar_layout import PolarLayout
from cytodisk.windows.subpixels import subpixel_places
from cytodisk.windows.window_walls import (
    Point,
    Walls,
    exact_window,
    holds,
    holds_triangle,
    layer_bands,
    steps_inside,
    walls_of,
    window_near,
)

_BEFORE_WALL = 1e-6  # of a subpixel: so far before a wall a stretch ends; its next subpixel is looked at
_ON_EDGE = 1e-9  # of a subpixel: a point so far beyond a triangle's edge is still on it

_Corners: TypeAlias = tuple[Point, Point, Point]
_Sides: TypeAlias = tuple[float, float, float]
_Slopes: TypeAlias = tuple[Point, Point]


def windows_of_all_subpixels(
    grid: PolarLayout, disk: DiskMap, pixels_yx: IntArray, per_side: int
) -> Int32Array:
    """Window of each subpixel of a mask; a subpixel outside the outline goes with the nearest outline point.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap
        One to one: not by "advection", whose triangles may lie over each other.
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column) of all pixels of the mask, in row-major order.
    per_side : int
        Subpixels along the side of a pixel.

    Returns
    -------
    ndarray of shape (P, subpixels) and dtype int32
        Subpixels row by row.
    """
    inside, corner = disk.placed_mask.box, np.array(disk.placed_mask.corner)
    number = np.full(inside.shape, -1, dtype=np.int32)
    number[inside] = np.arange(len(pixels_yx), dtype=np.int32)
    window = np.full((len(pixels_yx), per_side**2), -1, dtype=np.int32)
    _paint(
        (disk.vertices_yx - (corner - 0.5)) * per_side,
        disk.vertices_uv,
        disk.triangles,
        layer_bands(grid.radii, disk.boundary_angles),
        np.column_stack([np.cos(grid.angles), np.sin(grid.angles)]),
        disk.boundary_angles,
        number,
        window,
    )
    pixel, subpixel = _outside(window)
    places = subpixel_places(pixels_yx[pixel], per_side)[np.arange(len(pixel)), subpixel]
    window[pixel, subpixel] = grid.window_of(disk.to_disk(places, outside="nearest"))
    return window


@njit(cache=True)
def _outside(window: Int32Array) -> tuple[IntArray, IntArray]:
    """Pixel and number in it of every subpixel that no triangle holds."""
    pixels, subpixels = [], []
    for pixel in range(window.shape[0]):
        signs = 0
        for subpixel in range(window.shape[1]):
            signs |= window[pixel, subpixel]
        if signs >= 0:
            continue
        for subpixel in range(window.shape[1]):
            if window[pixel, subpixel] < 0:
                pixels.append(pixel)
                subpixels.append(subpixel)
    return np.array(pixels, dtype=np.int64), np.array(subpixels, dtype=np.int64)


@njit(cache=True, error_model="numpy")
def _paint(
    vertices_yx: FloatArray,
    vertices_uv: FloatArray,
    triangles: IntArray,
    bands: FloatArray,
    rays: FloatArray,
    boundary_angles: FloatArray,
    number: Int32Array,
    window: Int32Array,
) -> None:
    """Fill `window` for the subpixels that lie in a triangle; vertices are in units of a subpixel."""
    sectors, per_side = len(rays) - 1, round(math.sqrt(window.shape[1]))
    rows, columns = number.shape[0] * per_side, number.shape[1] * per_side
    pixel_of = np.arange(columns, dtype=np.int32) // per_side
    within = np.arange(columns, dtype=np.int32) % per_side
    near = (0, 0)
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        p, q = (vertices_yx[i, 0], vertices_yx[i, 1]), (vertices_yx[j, 0], vertices_yx[j, 1])
        r = (vertices_yx[k, 0], vertices_yx[k, 1])
        a, b = (vertices_uv[i, 0], vertices_uv[i, 1]), (vertices_uv[j, 0], vertices_uv[j, 1])
        c = (vertices_uv[k, 0], vertices_uv[k, 1])
        if not holds(a[0], a[1], walls_of(near, bands, rays)):
            near = exact_window(a[0], a[1], bands, sectors, boundary_angles)
        alike = holds_triangle(a, b, c, walls_of(near, bands, rays))
        begin = near  # window of the first subpixel of the row before
        corners = _from_top(p, q, r)
        sides, (by_row, by_column) = _sides(*corners), _slopes(p, q, r, a, b, c)
        first_row = max(math.ceil(corners[0][0] - 0.5 - _ON_EDGE), 0)
        last_row = min(math.floor(corners[2][0] - 0.5 + _ON_EDGE), rows - 1)
        for row in range(first_row, last_row + 1):
            column, last = _columns(row, corners, sides, columns)
            place = row // per_side, row % per_side * per_side
            if alike:
                here = near[0] * sectors + near[1]
                _fill(column, last, here, place, number, pixel_of, within, window)
                continue
            down, right = row + 0.5 - p[0], 0.5 - p[1]
            u_row = a[0] + by_row[0] * down + by_column[0] * right
            v_row = a[1] + by_row[1] * down + by_column[1] * right
            near, first = begin, column
            walls = walls_of(near, bands, rays)
            while column <= last:
                u, v = u_row + column * by_column[0], v_row + column * by_column[1]
                if not holds(u, v, walls):
                    near = window_near(u, v, near, bands, rays, boundary_angles)
                    walls = walls_of(near, bands, rays)
                if column == first:
                    begin = near
                end = _end_of_stretch(u, v, by_column, column, last, walls)
                here = near[0] * sectors + near[1]
                _fill(column, end, here, place, number, pixel_of, within, window)
                column = end + 1


@njit(cache=True)
def _from_top(a: Point, b: Point, c: Point) -> _Corners:
    """Three points by their row."""
    if b[0] < a[0]:
        a, b = b, a
    if c[0] < b[0]:
        b, c = c, b
    if b[0] < a[0]:
        a, b = b, a
    return a, b, c


@njit(cache=True, error_model="numpy")
def _sides(top: Point, middle: Point, bottom: Point) -> _Sides:
    """Columns by row along the upper, the lower and the longest side of a triangle."""
    return _side(top, middle), _side(middle, bottom), _side(top, bottom)


@njit(cache=True, error_model="numpy")
def _side(above: Point, below: Point) -> float:
    """Columns by row from one point to another below it; 0 where they are in one row."""
    down = below[0] - above[0]
    return (below[1] - above[1]) / down if down > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _slopes(p: Point, q: Point, r: Point, a: Point, b: Point, c: Point) -> _Slopes:
    """How (u, v) grows by row and by column where corners p, q, r of a triangle go to a, b, c."""
    y1, x1, y2, x2 = q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1]
    u1, v1, u2, v2 = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    twice = x1 * y2 - y1 * x2
    by_row = ((u2 * x1 - u1 * x2) / twice, (v2 * x1 - v1 * x2) / twice)
    return by_row, ((u1 * y2 - u2 * y1) / twice, (v1 * y2 - v2 * y1) / twice)


@njit(cache=True, error_model="numpy")
def _columns(row: int, corners: _Corners, sides: _Sides, columns: int) -> tuple[int, int]:
    """First and last subpixel of a row whose middle is in a triangle."""
    ((ya, xa), (yb, xb), (yc, _)), (upper, lower, longest) = corners, sides
    y = min(max(row + 0.5, ya), yc)
    one = xa + (y - ya) * longest
    other = xa + (y - ya) * upper if y < yb else xb + (y - yb) * lower
    first = max(math.ceil(min(one, other) - 0.5 - _ON_EDGE), 0)
    return first, min(math.floor(max(one, other) - 0.5 + _ON_EDGE), columns - 1)


@njit(cache=True, error_model="numpy")
def _end_of_stretch(u: float, v: float, step: Point, column: int, last: int, walls: Walls) -> int:
    """Last column of a row of subpixels that is surely in the same window as a first one."""
    if column == last or not holds(u, v, walls):
        return column  # on a wall: the next subpixel is looked at by itself
    steps = steps_inside(u, v, step, float(last - column), walls)
    if steps < last - column:
        return column + max(math.floor(steps - _BEFORE_WALL), 0)
    return last


@njit(cache=True, inline="always")
def _fill(
    first: int,
    last: int,
    here: int,
    place: tuple[int, int],
    number: Int32Array,
    pixel_of: IntArray,
    within: IntArray,
    window: Int32Array,
) -> None:
    """Give a stretch of a row its window; the place is the row of pixels, and its first subpixel in each."""
    for column in range(first, last + 1):
        pixel = number[place[0], pixel_of[column]]
        if pixel >= 0:
            window[pixel, place[1] + within[column]] = here
