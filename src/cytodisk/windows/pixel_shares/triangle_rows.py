"""Rows of subpixels in a triangle: where they begin and end, and how the map grows along them."""

import math
from typing import TypeAlias

from numba import njit

from cytodisk.windows.pixel_shares.window_walls import Point

ON_EDGE = 1e-9  # of a subpixel: a point so far beyond a triangle's edge is still on it

Corners: TypeAlias = tuple[Point, Point, Point]
Sides: TypeAlias = tuple[float, float, float]
Slopes: TypeAlias = tuple[Point, Point]


@njit(cache=True)
def from_top(a: Point, b: Point, c: Point) -> Corners:
    """Three points by their row."""
    if b[0] < a[0]:
        a, b = b, a
    if c[0] < b[0]:
        b, c = c, b
    if b[0] < a[0]:
        a, b = b, a
    return a, b, c


@njit(cache=True, error_model="numpy")
def sides_of(top: Point, middle: Point, bottom: Point) -> Sides:
    """Columns by row along the upper, the lower and the longest side of a triangle."""
    return _side(top, middle), _side(middle, bottom), _side(top, bottom)


@njit(cache=True, error_model="numpy")
def _side(above: Point, below: Point) -> float:
    """Columns by row from one point to another below it; 0 where they are in one row."""
    down = below[0] - above[0]
    return (below[1] - above[1]) / down if down > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def slopes_of(p: Point, q: Point, r: Point, a: Point, b: Point, c: Point) -> Slopes:
    """How (u, v) grows by row and by column where corners p, q, r of a triangle go to a, b, c."""
    y1, x1, y2, x2 = q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1]
    u1, v1, u2, v2 = b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]
    twice = x1 * y2 - y1 * x2
    by_row = ((u2 * x1 - u1 * x2) / twice, (v2 * x1 - v1 * x2) / twice)
    return by_row, ((u1 * y2 - u2 * y1) / twice, (v1 * y2 - v2 * y1) / twice)


@njit(cache=True, error_model="numpy")
def columns_of(row: int, corners: Corners, sides: Sides, columns: int) -> tuple[int, int]:
    """First and last subpixel of a row whose middle is in a triangle."""
    ((ya, xa), (yb, xb), (yc, _)), (upper, lower, longest) = corners, sides
    y = min(max(row + 0.5, ya), yc)
    one = xa + (y - ya) * longest
    other = xa + (y - ya) * upper if y < yb else xb + (y - yb) * lower
    first = max(math.ceil(min(one, other) - 0.5 - ON_EDGE), 0)
    return first, min(math.floor(max(one, other) - 0.5 + ON_EDGE), columns - 1)
