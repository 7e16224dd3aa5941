"""Windows of the subpixels of all pixels of a cell, triangle after triangle and row after row.

Within a triangle the map is linear, so a row of subpixels goes to a straight line in the disk, and where that
meets the next ray or circle of the grid is known without looking at the subpixels before. A few rows of
pixels are painted at a time; of those that lie in one window as a whole no subpixels are kept.
"""

import math
from typing import TypeAlias

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.pixel_shares.shares import DIVIDED, NOWHERE, PER_SIDE, Subpixels, with_starts
from cytodisk.windows.pixel_shares.triangle_rows import (
    ON_EDGE,
    Corners,
    columns_of,
    from_top,
    sides_of,
    slopes_of,
)
from cytodisk.windows.pixel_shares.window_walls import (
    Point,
    Walls,
    Window,
    holds,
    holds_triangle,
    layer_bands,
    steps_inside,
    walls_of,
    window_near,
)
from cytodisk.windows.polar_layout import PolarLayout

_BEFORE_WALL = 1e-6  # of a subpixel: so far before a wall a stretch ends; its next subpixel is looked at
_LOOKED_AT = 3  # subpixels, before it is computed where a stretch ends
_AT_ONCE = 1 << 17  # subpixels that are painted before they are looked through: they stay in the cache

RoundGrid: TypeAlias = tuple[FloatArray, FloatArray, FloatArray, bool]
"""Bands of layers (`layer_bands`), rays between sectors, angles of the boundary, and whether angles grow
evenly along its chords; if not, angles are those of directions."""
Mesh: TypeAlias = tuple[FloatArray, FloatArray, IntArray]


def paint_windows(grid: PolarLayout, disk: DiskMap) -> Subpixels:
    """Window of each subpixel of a mask; a subpixel outside the outline goes with the nearest outline point.

    Parameters
    ----------
    grid : PolarLayout
    disk : DiskMap
        One to one: not by "advection", whose triangles may lie over each other.

    Returns
    -------
    Subpixels
        4×4 of each pixel that is divided.
    """
    inside = disk.placed_mask.box
    whole, window, places = _paint(
        mesh_in_subpixels(disk), _grid(grid, disk), inside, rows_at_once(inside.shape)
    )
    divided, number = np.divmod(np.flatnonzero(window.ravel() == NOWHERE), PER_SIDE**2)
    if divided.size:
        points = subpixel_points(disk, places[divided], number)
        window[divided, number] = grid.window_of(disk.nearest_on_circle(points))
    return undivided_where_alike(whole, window, divided)


def rows_at_once(shape: tuple[int, ...]) -> int:
    """Rows of pixels, of a mask's box of this shape, that are painted at a time."""
    height, width = shape
    return min(max(_AT_ONCE // (width * PER_SIDE**2), 1), height)


def subpixel_points(disk: DiskMap, places: IntArray, number: IntArray) -> FloatArray:
    """Middles of some subpixels, (row, column) in the image, shape (N, 2).

    Parameters
    ----------
    disk : DiskMap
    places : ndarray of shape (N,) and dtype int
        Of their pixels in the box of the mask, in row-major order of the box.
    number : ndarray of shape (N,) and dtype int
        In the pixel.
    """
    middles = (np.column_stack(np.divmod(number, PER_SIDE)) + 0.5) / PER_SIDE - 0.5
    pixels = np.column_stack(np.divmod(places, disk.placed_mask.box.shape[1]))
    return np.asarray(pixels + np.array(disk.placed_mask.corner) + middles)


def mesh_in_subpixels(disk: DiskMap) -> Mesh:
    """Vertices in units of a subpixel from the corner of the mask's box, and in the disk; and triangles."""
    corner = np.array(disk.placed_mask.corner)
    return (disk.vertices_yx - (corner - 0.5)) * PER_SIDE, disk.vertices_uv, disk.triangles


def _grid(grid: PolarLayout, disk: DiskMap) -> RoundGrid:
    """Bands of the layers, rays between the sectors, and angles of the boundary."""
    angles = disk.boundary_angles
    rays = np.column_stack([np.cos(grid.angles), np.sin(grid.angles)])
    return layer_bands(grid.radii, angles), rays, angles, False


def undivided_where_alike(whole: Int32Array, window: Int32Array, changed: IntArray) -> Subpixels:
    """Subpixels, without those of divided pixels that after a change are in one window as a whole.

    Parameters
    ----------
    whole : ndarray of shape (pixels,) and dtype int32
    window : ndarray of shape (divided pixels, 16) and dtype int32
    changed : ndarray of shape (N,) and dtype int
        Divided pixels that were changed, not decreasing.

    Returns
    -------
    Subpixels
    """
    some = changed[np.diff(changed, prepend=-1) > 0]
    some = some[(window[some] == window[some, :1]).all(axis=1)]
    if some.size:
        whole[np.flatnonzero(whole == DIVIDED)[some]] = window[some, 0]
        window = np.delete(window, some, axis=0)
    return with_starts(whole, window.ravel())


@njit(cache=True, error_model="numpy")
def _paint(
    mesh: Mesh, grid: RoundGrid, inside: BoolArray, at_once: int
) -> tuple[Int32Array, Int32Array, IntArray]:
    """Window of each pixel as a whole, and the subpixels and places of those that are divided.

    The mesh has its vertices in units of a subpixel, and in the disk; `at_once` counts rows of pixels.
    """
    vertices_yx, vertices_uv, triangles = mesh
    height, width = inside.shape
    start, listed = by_strip(vertices_yx, triangles, PER_SIDE * at_once, (height - 1) // at_once + 1)
    whole = np.empty(inside.sum(), dtype=np.int32)
    # Room for all pixels, of which memory is taken only where something is written.
    window, places = np.empty((len(whole), PER_SIDE**2), np.int32), np.empty(len(whole), np.int64)
    canvas = np.empty((PER_SIDE * at_once, PER_SIDE * width), np.int32)
    near, counts = (0, 0), (0, 0)
    for strip in range(len(start) - 1):
        canvas[:] = NOWHERE
        top = strip * at_once
        for entry in range(start[strip], start[strip + 1]):
            t = listed[entry]
            yx, uv = corners_of(vertices_yx, triangles, t), corners_of(vertices_uv, triangles, t)
            near = paint_triangle(yx, uv, near, grid, PER_SIDE * top, canvas)
        rows = top, min(top + at_once, height)
        counts = collect(canvas, inside, rows, counts, whole, window, places)
    return whole, window[: counts[1]].copy(), places[: counts[1]].copy()


@njit(cache=True)
def collect(
    canvas: Int32Array,
    inside: BoolArray,
    rows: tuple[int, int],
    counts: tuple[int, int],
    whole: Int32Array,
    window: Int32Array,
    places: IntArray,
) -> tuple[int, int]:
    """Look through the painted pixels of some rows; counts are those of pixels, and of divided ones."""
    (top, bottom), (pixel, divided) = rows, counts
    pairs = canvas.view(np.int64)  # of subpixels
    for row in range(top, bottom):
        y = PER_SIDE * (row - top)
        for column in range(inside.shape[1]):
            if not inside[row, column]:
                continue
            first = pairs[y, 2 * column]
            others = (first >> 32) ^ (first & 0xFFFFFFFF)
            for down in range(PER_SIDE):
                others |= (pairs[y + down, 2 * column] ^ first) | (pairs[y + down, 2 * column + 1] ^ first)
            if others == 0 and first >= 0:
                whole[pixel] = first & 0xFFFFFFFF
            else:
                whole[pixel] = DIVIDED
                places[divided] = row * inside.shape[1] + column
                for down in range(PER_SIDE):
                    for right in range(PER_SIDE):
                        window[divided, PER_SIDE * down + right] = canvas[y + down, PER_SIDE * column + right]
                divided += 1
            pixel += 1
    return pixel, divided


@njit(cache=True)
def by_strip(
    vertices_yx: FloatArray, triangles: IntArray, rows: int, strips: int
) -> tuple[IntArray, IntArray]:
    """Triangles that have a part in each strip of so many rows, in their order: starts, and triangles."""
    start = np.zeros(strips + 1, dtype=np.int64)
    first, last = np.empty(len(triangles), np.int64), np.empty(len(triangles), np.int64)
    for t in range(len(triangles)):
        a, b, c = corners_of(vertices_yx, triangles, t)
        first[t] = max(int(min(a[0], b[0], c[0]) - 1.0), 0) // rows
        last[t] = min(max(int(max(a[0], b[0], c[0])), 0) // rows, strips - 1)
        for strip in range(first[t], last[t] + 1):
            start[strip + 1] += 1
    start = np.cumsum(start)
    listed, free = np.empty(start[-1], np.int64), start[:-1].copy()
    for t in range(len(triangles)):
        for strip in range(first[t], last[t] + 1):
            listed[free[strip]] = t
            free[strip] += 1
    return start, listed


@njit(cache=True, error_model="numpy")
def paint_triangle(
    yx: Corners, uv: Corners, near: Window, grid: RoundGrid, top: int, canvas: Int32Array
) -> Window:
    """Paint what lies of a triangle in the rows from the top one on; give back a window of it."""
    bands, rays, boundary_angles, by_chords = grid
    sectors, columns = len(rays) - 1, canvas.shape[1]
    (p, q, r), (a, b, c) = yx, uv
    corners = from_top(p, q, r)
    first_row = max(math.ceil(corners[0][0] - 0.5 - ON_EDGE), top)
    last_row = min(math.floor(corners[2][0] - 0.5 + ON_EDGE), top + len(canvas) - 1)
    if first_row > last_row:
        return near
    if not holds(a[0], a[1], walls_of(near, bands, rays)):
        near = window_near(a[0], a[1], near, bands, rays, boundary_angles, by_chords)
    alike = holds_triangle(a, b, c, walls_of(near, bands, rays))
    begin = near  # window of the first subpixel of the row before
    sides, (by_row, by_column) = sides_of(*corners), slopes_of(p, q, r, a, b, c)
    for row in range(first_row, last_row + 1):
        column, last = columns_of(row, corners, sides, columns)
        if alike:
            fill(canvas, row - top, column, last, near[0] * sectors + near[1])
            continue
        down, right = row + 0.5 - p[0], 0.5 - p[1]
        u_row = a[0] + by_row[0] * down + by_column[0] * right
        v_row = a[1] + by_row[1] * down + by_column[1] * right
        near, first = begin, column
        walls = walls_of(near, bands, rays)
        while column <= last:
            u, v = u_row + column * by_column[0], v_row + column * by_column[1]
            if not holds(u, v, walls):
                near = window_near(u, v, near, bands, rays, boundary_angles, by_chords)
                walls = walls_of(near, bands, rays)
            if column == first:
                begin = near
            end = _end_of_stretch(u, v, by_column, column, last, walls)
            fill(canvas, row - top, column, end, near[0] * sectors + near[1])
            column = end + 1
    return near


@njit(cache=True, inline="always")
def fill(canvas: Int32Array, row: int, first: int, last: int, here: int) -> None:
    """Give a stretch of a row its window."""
    for column in range(first, last + 1):
        canvas[row, column] = here


@njit(cache=True)
def corners_of(vertices: FloatArray, triangles: IntArray, t: int) -> Corners:
    """Corners of a triangle."""
    i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
    a, b = (vertices[i, 0], vertices[i, 1]), (vertices[j, 0], vertices[j, 1])
    return a, b, (vertices[k, 0], vertices[k, 1])


@njit(cache=True, error_model="numpy")
def _end_of_stretch(u: float, v: float, step: Point, column: int, last: int, walls: Walls) -> int:
    """Last column of a row of subpixels that is surely in the same window as a first one."""
    if column == last or not holds(u, v, walls):
        return column  # on a wall: the next subpixel is looked at by itself
    for k in range(1, min(last - column, _LOOKED_AT) + 1):  # in small windows the end is near
        if not holds(u + k * step[0], v + k * step[1], walls):
            return column + k - 1
    if last - column <= _LOOKED_AT:
        return last
    steps = steps_inside(u, v, step, float(last - column), walls)
    if steps < last - column:
        return column + max(math.floor(steps - _BEFORE_WALL), 0)
    return last
