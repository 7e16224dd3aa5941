"""Windows of the subpixels of all pixels of a cell with a nucleus, as `raster` does without one."""

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.windows.nucleus.chart_grid import ChartGrid, chart_grid
from cytodisk.windows.nucleus.compartment_rule import nuclear_box, nucleus_of, windows_at_border
from cytodisk.windows.nucleus.ring_triangles import paint_ring_triangle
from cytodisk.windows.pixel_shares.raster import (
    by_strip,
    collect,
    corners_of,
    mesh_in_subpixels,
    paint_triangle,
    rows_at_once,
    subpixel_points,
    undivided_where_alike,
)
from cytodisk.windows.pixel_shares.shares import NOWHERE, PER_SIDE, Subpixels
from cytodisk.windows.polar_layout import PolarLayout

_BEYOND = -3  # for a window: on the other side of the nuclear outline than the pixel


def paint_nucleus_windows(grid: PolarLayout, disk: DiskMap) -> Subpixels:
    """Window of each subpixel of the mask of a cell with a nucleus; see `compartment_rule`.

    Parameters
    ----------
    grid : PolarLayout
        With the radius of the map's nucleus.
    disk : DiskMap

    Returns
    -------
    Subpixels
        4×4 of each pixel that is divided.
    """
    nucleus, inside, nuclear = nucleus_of(disk), disk.placed_mask.box, nuclear_box(disk)
    corners = np.empty((len(disk.triangles), 3, 2))
    corners[nucleus.inside] = nucleus.own_uv[disk.triangles[nucleus.inside]]
    corners[~nucleus.inside] = nucleus.corners(disk.triangles) * (1.0, grid.sectors)
    vertices_yx, _, triangles = mesh_in_subpixels(disk)
    mesh, masks = (vertices_yx, corners, triangles, nucleus.inside), (inside, nuclear)
    laid = chart_grid(grid, nucleus.boundary_angles)
    whole, window, places = _paint(mesh, laid, masks, rows_at_once(inside.shape))
    divided, number = np.divmod(np.flatnonzero(window.ravel() < 0), PER_SIDE**2)
    points = subpixel_points(disk, places[divided], number)
    beyond = window[divided, number] == _BEYOND
    found = np.empty(len(divided), dtype=np.int64)
    found[beyond] = windows_at_border(grid, disk, points[beyond], nuclear.ravel()[places[divided[beyond]]])
    found[~beyond] = grid.window_of(disk.nearest_on_circle(points[~beyond]))
    window[divided, number] = found
    return undivided_where_alike(whole, window, divided)


@njit(cache=True, error_model="numpy")
def _paint(
    mesh: tuple[FloatArray, FloatArray, IntArray, BoolArray],
    grid: ChartGrid,
    masks: tuple[BoolArray, BoolArray],
    at_once: int,
) -> tuple[Int32Array, Int32Array, IntArray]:
    """Window of each pixel as a whole, and the subpixels and places of those that are divided.

    The mesh has its vertices in units of a subpixel, the corners of its triangles in their charts, and which
    triangles lie in the nucleus; the masks are those of the cell and of its nucleus, in one box.
    """
    (vertices_yx, charts, triangles, in_nucleus), (inside, nuclear) = mesh, masks
    height, width = inside.shape
    start, listed = by_strip(vertices_yx, triangles, PER_SIDE * at_once, (height - 1) // at_once + 1)
    whole = np.empty(inside.sum(), dtype=np.int32)
    window, places = np.empty((len(whole), PER_SIDE**2), np.int32), np.empty(len(whole), np.int64)
    canvas = np.empty((PER_SIDE * at_once, PER_SIDE * width), np.int32)
    near, counts = (0, 0), (0, 0)
    for strip in range(len(start) - 1):
        canvas[:] = NOWHERE
        top = strip * at_once
        for entry in range(start[strip], start[strip + 1]):
            t = listed[entry]
            yx = corners_of(vertices_yx, triangles, t)
            a, b, c = charts[t, 0], charts[t, 1], charts[t, 2]
            places_in_chart = (a[0], a[1]), (b[0], b[1]), (c[0], c[1])
            if in_nucleus[t]:
                near = paint_triangle(yx, places_in_chart, near, grid.nucleus, PER_SIDE * top, canvas)
            else:
                paint_ring_triangle(yx, places_in_chart, grid.borders, grid.sectors, PER_SIDE * top, canvas)
        rows = top, min(top + at_once, height)
        _keep_to_compartments(canvas, inside, nuclear, rows, (len(grid.borders) - 1) * grid.sectors)
        counts = collect(canvas, inside, rows, counts, whole, window, places)
    return whole, window[: counts[1]].copy(), places[: counts[1]].copy()


@njit(cache=True)
def _keep_to_compartments(
    canvas: Int32Array, inside: BoolArray, nuclear: BoolArray, rows: tuple[int, int], first: int
) -> None:
    """Mark subpixels that lie on the other side of the nuclear outline than their pixel belongs to.

    `first` is the first window of the nucleus.
    """
    top, bottom = rows
    for row in range(top, bottom):
        for column in range(inside.shape[1]):
            if not inside[row, column]:
                continue
            own = nuclear[row, column]
            for y in range(PER_SIDE * (row - top), PER_SIDE * (row - top + 1)):
                for x in range(PER_SIDE * column, PER_SIDE * (column + 1)):
                    here = canvas[y, x]
                    if (here >= 0 and (here >= first) != own) or (here < 0 and own):
                        canvas[y, x] = _BEYOND
