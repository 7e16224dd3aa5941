"""Depth below a cell's outline, and the outline point above, of every part of its pixels."""

import math

import numpy as np
import shapely
from numba import njit

from cytodisk.arrays import FloatArray, IntArray


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
    depth, angle = _nearest(places_yx, outline_yx, angles, ends)
    rim = depth < 1.0  # parts further off are within pixels that the outline does not cut
    rim[rim] = ~shapely.contains_xy(shapely.Polygon(outline_yx), *places_yx[rim].T)
    depth[rim] = 0.0
    return depth, angle


@njit(cache=True)
def _nearest(
    places: FloatArray, outline: FloatArray, angles: FloatArray, ends: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """For each pixel the outline points that can be near enough, then of these the nearest edge by part."""
    n_points, n_parts = len(outline), places.shape[1]
    longest = 0.0
    for i in range(n_points):
        j = (i + 1) % n_points
        longest = max(longest, math.hypot(outline[j, 0] - outline[i, 0], outline[j, 1] - outline[i, 1]))
    depth, angle = np.empty(places.shape[:2]), np.empty(places.shape[:2])
    squared, chosen = np.empty(n_points), np.empty(n_points, dtype=np.int64)
    for pixel in range(len(places)):
        y, x = places[pixel, 0, 0], places[pixel, 0, 1]
        reach = 0.0  # of the parts around the first one
        for part in range(n_parts):
            reach = max(reach, math.hypot(places[pixel, part, 0] - y, places[pixel, part, 1] - x))
        least = np.inf
        for i in range(n_points):
            squared[i] = (outline[i, 0] - y) ** 2 + (outline[i, 1] - x) ** 2
            least = min(least, squared[i])
        # No part is further from the outline than this, and an edge is at most so far from its first point.
        limit = (math.sqrt(least) + 2.0 * reach + longest) ** 2
        n_chosen = 0
        for i in range(n_points):
            if squared[i] <= limit:
                chosen[n_chosen] = i
                n_chosen += 1
        for part in range(n_parts):
            py, px = places[pixel, part, 0], places[pixel, part, 1]
            best = np.inf
            for entry in range(n_chosen):
                i = chosen[entry]
                j = i + 1 if i + 1 < n_points else 0
                ey, ex = outline[j, 0] - outline[i, 0], outline[j, 1] - outline[i, 1]
                dy, dx = py - outline[i, 0], px - outline[i, 1]
                along = min(max((dy * ey + dx * ex) / (ey * ey + ex * ex), 0.0), 1.0)
                away = (dy - along * ey) ** 2 + (dx - along * ex) ** 2
                if away < best:
                    best = away
                    angle[pixel, part] = angles[i] + along * (ends[i] - angles[i])
            depth[pixel, part] = math.sqrt(best)
    return depth, angle
