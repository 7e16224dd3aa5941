"""Depth below a cell's outline, and the outline point above, of every part of its pixels."""

import math

import numpy as np
import shapely
from numba import njit

from cytodisk.arrays import FloatArray, IntArray

_PIXELS_AT_ONCE = 16  # neighbours, so what is near to one is near to all


def part_places(pixels_yx: IntArray, per_side: int) -> FloatArray:
    """Middle of each part of pixels that are divided into per_side × per_side parts.

    Parameters
    ----------
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column).
    per_side : int

    Returns
    -------
    ndarray of shape (P, parts, 2) and dtype float
        (row, column) in pixels.
    """
    steps = (np.arange(per_side) + 0.5) / per_side - 0.5
    offsets = np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)
    return np.asarray(pixels_yx[:, None, :] + offsets)


def depths_and_angles(
    places_yx: FloatArray, outline_yx: FloatArray, angles: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Distance to the outline, and the angle that the nearest point of the outline has.

    Parameters
    ----------
    places_yx : ndarray of shape (P, parts, 2) and dtype float
        Parts of P pixels, each inside its pixel.
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon, (row, column) in pixels.
    angles : ndarray of shape (B,) and dtype float
        Of the outline's points in radians, increasing within one turn; linear between points.

    Returns
    -------
    depth : ndarray of shape (P, parts) and dtype float
        In pixels, exact to rounding; 0 outside the outline.
    angle : ndarray of shape (P, parts) and dtype float
        In radians.
    """
    ends = np.append(angles[1:], angles[0] + 2.0 * np.pi)
    shape = places_yx.shape[:2]
    flat = np.ascontiguousarray(places_yx.reshape(-1, 2))
    depth, angle = (found.reshape(shape) for found in _nearest(flat, shape[1], outline_yx, angles, ends))
    rim = depth < 1.0  # parts further off are within pixels that the outline does not cut
    rim[rim] = ~shapely.contains_xy(shapely.Polygon(outline_yx), *places_yx[rim].T)
    depth[rim] = 0.0
    return depth, angle


@njit(cache=True)
def _nearest(
    places: FloatArray, n_parts: int, outline: FloatArray, angles: FloatArray, ends: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Outline points that can be near enough to a few pixels, of these to each pixel, then by part."""
    everything = np.arange(len(outline))
    longest = 0.0
    for i in everything:
        there = outline[(i + 1) % len(outline)]
        longest = max(longest, math.hypot(there[0] - outline[i, 0], there[1] - outline[i, 1]))
    depth, angle = np.empty(len(places)), np.empty(len(places))
    for first in range(0, len(places), _PIXELS_AT_ONCE * n_parts):
        last = min(first + _PIXELS_AT_ONCE * n_parts, len(places))
        around = _within_reach(outline, everything, places[first:last], longest)
        for pixel in range(first, last, n_parts):
            near = _within_reach(outline, around, places[pixel : pixel + n_parts], longest)
            for part in range(pixel, pixel + n_parts):
                y, x = places[part]
                best = np.inf
                for i in near:
                    j = i + 1 if i + 1 < len(outline) else 0
                    ey, ex = outline[j, 0] - outline[i, 0], outline[j, 1] - outline[i, 1]
                    dy, dx = y - outline[i, 0], x - outline[i, 1]
                    along = min(max((dy * ey + dx * ex) / (ey * ey + ex * ex), 0.0), 1.0)
                    away = (dy - along * ey) ** 2 + (dx - along * ex) ** 2
                    if away < best:
                        best = away
                        angle[part] = angles[i] + along * (ends[i] - angles[i])
                depth[part] = math.sqrt(best)
    return depth, angle


@njit(cache=True)
def _within_reach(outline: FloatArray, among: IntArray, places: FloatArray, longest: float) -> IntArray:
    """Outline points at which an edge can begin that is nearest to any of some places."""
    y, x = places[0]
    reach = 0.0  # from the first place to all
    for place in places:
        reach = max(reach, math.hypot(place[0] - y, place[1] - x))
    squared = np.empty(len(among))
    for entry, i in enumerate(among):
        squared[entry] = (outline[i, 0] - y) ** 2 + (outline[i, 1] - x) ** 2
    # The nearest edge of any place is at most √min + reach away from it, and as long as the longest.
    limit = math.sqrt(squared.min()) + 2.0 * reach + longest
    return among[squared <= limit**2]
