"""Walls of a window in the disk, as numbers: on which side of them points and lines lie."""

import math
from typing import TypeAlias

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray
from cytodisk.disk.circle import polygon_radius_at

_MARGIN = 1e-12  # of the disk's radius: nearer to a wall than this, a point is looked at closely

Point: TypeAlias = tuple[float, float]
Window: TypeAlias = tuple[int, int]
"""Layer and sector."""
Walls: TypeAlias = tuple[float, float, Point, Point]
"""Squares of the inner and outer radius of a window, and the rays to its right and left, as unit vectors."""


def layer_bands(radii: FloatArray, boundary_angles: FloatArray) -> FloatArray:
    """Where the layers of a grid are in the polygon that the boundary of a map spans.

    Parameters
    ----------
    radii : ndarray of shape (layers + 1,) and dtype float
        Of the grid, from 1 to 0.
    boundary_angles : ndarray of shape (B,) and dtype float
        Of the map, in radians.

    Returns
    -------
    ndarray of shape (layers, 3) and dtype float
        A point between the square roots of the first two is surely in the layer; the third is the inner
        radius on the round disk.
    """
    widest = np.diff(boundary_angles, append=boundary_angles[0] + 2.0 * math.pi).max()
    inner, outer = np.square(radii[1:]) * (1.0 + _MARGIN), np.square(radii[:-1]) * (1.0 - _MARGIN)
    outer *= math.cos(0.5 * widest) ** 2  # the polygon is a little inside the circle
    inner[-1], outer[0] = -1.0, np.inf
    return np.column_stack([inner, outer, radii[1:]])


@njit(cache=True)
def walls_of(window: Window, bands: FloatArray, rays: FloatArray) -> Walls:
    """Walls of a window of a grid with these bands (`layer_bands`) and rays, (u, v) between sectors."""
    layer, sector = window
    right, left = (rays[sector, 0], rays[sector, 1]), (rays[sector + 1, 0], rays[sector + 1, 1])
    return bands[layer, 0], bands[layer, 1], right, left


@njit(cache=True)
def left_of(u: float, v: float, ray: Point) -> float:
    """Distance of a point to the left of a ray, where angles grow; below 0 to its right."""
    return ray[0] * v - ray[1] * u


@njit(cache=True)
def holds(u: float, v: float, walls: Walls) -> bool:
    """Whether a point is surely in a window. All walls but the inner one are convex."""
    inner, outer, right, left = walls
    return bool(
        inner <= u * u + v * v < outer and left_of(u, v, right) > _MARGIN and left_of(u, v, left) < -_MARGIN
    )


@njit(cache=True)
def holds_triangle(a: Point, b: Point, c: Point, walls: Walls) -> bool:
    """Whether all of a triangle is surely in a window; the centre of the disk is at most at its corner."""
    inner = walls[0]
    return (
        holds(a[0], a[1], walls)
        and holds(b[0], b[1], walls)
        and holds(c[0], c[1], walls)
        and _square_of_nearest(a, b) >= inner
        and _square_of_nearest(b, c) >= inner
        and _square_of_nearest(c, a) >= inner
    )


@njit(cache=True)
def _square_of_nearest(a: Point, b: Point) -> float:
    """Square of the distance from the centre of the disk to the segment between two points."""
    du, dv = b[0] - a[0], b[1] - a[1]
    length = du * du + dv * dv
    along = -(a[0] * du + a[1] * dv)
    if along <= 0.0:
        return a[0] * a[0] + a[1] * a[1]
    if along >= length:
        return b[0] * b[0] + b[1] * b[1]
    across = a[0] * dv - a[1] * du
    return across * across / length


@njit(cache=True, error_model="numpy")
def steps_inside(u: float, v: float, step: Point, most: float, walls: Walls) -> float:
    """Number of steps, at most `most`, that a point can go along a line before it meets a wall."""
    (du, dv), (inner, outer, right, left) = step, walls
    turning = left_of(du, dv, right)
    if turning < 0.0:
        most = min(most, (_MARGIN - left_of(u, v, right)) / turning)
    turning = -left_of(du, dv, left)
    if turning < 0.0:
        most = min(most, (_MARGIN + left_of(u, v, left)) / turning)
    square, length, along = u * u + v * v, du * du + dv * dv, u * du + v * dv
    there = square + most * (2.0 * along + most * length)
    if there >= outer:
        most = min(most, (math.sqrt(along * along + length * (outer - square)) - along) / length)
    if along < 0.0 and min(square, there) - 0.25 * most * most * length < inner:
        discriminant = along * along - length * (square - inner)
        if discriminant > 0.0:
            most = min(most, (-along - math.sqrt(discriminant)) / length)
    return most


@njit(cache=True)
def window_near(
    u: float,
    v: float,
    near: Window,
    bands: FloatArray,
    rays: FloatArray,
    boundary_angles: FloatArray,
    by_chords: bool,
) -> Window:
    """Window of a point, which most often is in the same sector as a window near by, or in the next one."""
    layer, sector = near
    square, last = u * u + v * v, len(rays) - 2
    while square < bands[layer, 0]:
        layer += 1
    while square >= bands[layer, 1]:
        layer -= 1
    if rays[sector, 0] * v - rays[sector, 1] * u <= _MARGIN:
        sector = sector - 1 if sector else last
    elif rays[sector + 1, 0] * v - rays[sector + 1, 1] * u >= -_MARGIN:
        sector = sector + 1 if sector < last else 0
    if holds(u, v, walls_of((layer, sector), bands, rays)):
        return layer, sector
    sector = _sector(u, v, last + 1, boundary_angles, by_chords)
    if holds(u, v, walls_of((layer, sector), bands, rays)):
        return layer, sector
    return exact_window(u, v, bands, last + 1, boundary_angles, by_chords)


@njit(cache=True)
def exact_window(
    u: float, v: float, bands: FloatArray, sectors: int, boundary_angles: FloatArray, by_chords: bool
) -> Window:
    """Window of any point of the mapped polygon, as `PolarGrid.window_of` after `to_disk`.

    With `by_chords`, angles grow evenly along each chord of the boundary, as in a nucleus.
    """
    radius = math.hypot(u, v) / polygon_radius_at(u, v, boundary_angles)
    layer = 0
    while layer < len(bands) - 1 and bands[layer, 2] > radius:
        layer += 1
    return layer, _sector(u, v, sectors, boundary_angles, by_chords)


@njit(cache=True)
def _sector(u: float, v: float, sectors: int, boundary_angles: FloatArray, by_chords: bool) -> int:
    """Sector of a point."""
    angle = math.atan2(v, u)
    if by_chords:
        angle = _angle_by_chord(angle, boundary_angles)
    return min(math.floor((angle / (2.0 * math.pi)) % 1.0 * sectors), sectors - 1)


@njit(cache=True)
def _angle_by_chord(angle: float, angles: FloatArray) -> float:
    """Angle between those of a chord's ends, in proportion to where a ray meets the chord."""
    turn, last = 2.0 * math.pi, len(angles) - 1
    lifted = angles[0] + (angle - angles[0]) % turn
    edge = min(max(np.searchsorted(angles, lifted, side="right") - 1, 0), last)
    end = angles[edge + 1] if edge < last else angles[0] + turn
    half, middle = 0.5 * (end - angles[edge]), 0.5 * (end + angles[edge])
    return float(middle + half * math.tan(lifted - middle) / math.tan(half))
