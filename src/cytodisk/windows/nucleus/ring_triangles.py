"""Triangles of the cytoplasm, painted with its windows: rectangles in (share, turn)."""

import math

from numba import njit

from cytodisk.arrays import FloatArray, Int32Array
from cytodisk.windows.pixel_shares.raster import fill
from cytodisk.windows.pixel_shares.triangle_rows import (
    ON_EDGE,
    Corners,
    columns_of,
    from_top,
    sides_of,
    slopes_of,
)


@njit(cache=True, error_model="numpy")
def paint_ring_triangle(
    yx: Corners, places: Corners, borders: FloatArray, sectors: int, top: int, canvas: Int32Array
) -> None:
    """Paint what lies of a triangle in the rows from the top one on.

    Corners are in units of a subpixel, and (share of the cytoplasm from the membrane in, turn · sectors);
    `borders` are the shares between layers, from 0 to 1.
    """
    (p, q, r), (a, b, c) = yx, places
    corners = from_top(p, q, r)
    first_row = max(math.ceil(corners[0][0] - 0.5 - ON_EDGE), top)
    last_row = min(math.floor(corners[2][0] - 0.5 + ON_EDGE), top + len(canvas) - 1)
    if first_row > last_row:
        return
    layer, sector = _layer_near(a[0], 0, borders), math.floor(a[1])
    alike = _holds(b, layer, sector, borders) and _holds(c, layer, sector, borders)
    sides, (by_row, by_column) = sides_of(*corners), slopes_of(p, q, r, a, b, c)
    for row in range(first_row, last_row + 1):
        first, last = columns_of(row, corners, sides, canvas.shape[1])
        if alike:
            fill(canvas, row - top, first, last, layer * sectors + sector % sectors)
            continue
        down, right = row + 0.5 - p[0], 0.5 - p[1]
        share = a[0] + by_row[0] * down + by_column[0] * right
        turn = a[1] + by_row[1] * down + by_column[1] * right
        layer, sector = _layer_near(share + first * by_column[0], layer, borders), 0
        for column in range(first, last + 1):
            layer = _layer_near(share + column * by_column[0], layer, borders)
            sector = math.floor(turn + column * by_column[1])
            canvas[row - top, column] = layer * sectors + sector % sectors


@njit(cache=True, inline="always")
def _layer_near(share: float, layer: int, borders: FloatArray) -> int:
    """Layer of a place, found from one near by. A place on a border is in the outer layer."""
    share, last = min(share, 1.0), len(borders) - 2
    while layer < last and share > borders[layer + 1]:
        layer += 1
    while layer > 0 and share <= borders[layer]:
        layer -= 1
    return layer


@njit(cache=True, inline="always")
def _holds(place: tuple[float, float], layer: int, sector: int, borders: FloatArray) -> bool:
    """Whether a place is in a window, a rectangle: a triangle is if its corners are."""
    return _layer_near(place[0], layer, borders) == layer and math.floor(place[1]) == sector
