"""Depth below a cell's outline, and the outline point above, of every subpixel of its pixels."""

import math

import numpy as np
import shapely
from numba import njit

from cytodisk.arrays import FloatArray, IntArray

_PIXELS_AT_ONCE = 16  # neighbours, so what is near to one is near to all


def subpixel_places(pixels_yx: IntArray, per_side: int) -> FloatArray:
    """Middle of each subpixel of pixels that are divided into per_side × per_side subpixels.

    Parameters
    ----------
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column).
    per_side : int

    Returns
    -------
    ndarray of shape (P, subpixels, 2) and dtype float
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
    places_yx : ndarray of shape (P, subpixels, 2) and dtype float
        Subpixels of P pixels, each inside its pixel.
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon, (row, column) in pixels.
    angles : ndarray of shape (B,) and dtype float
        Angles of the outline's points in radians, increasing within one turn; linear between points.

    Returns
    -------
    depth : ndarray of shape (P, subpixels) and dtype float
        In pixels, exact to rounding; 0 outside the outline.
    angle : ndarray of shape (P, subpixels) and dtype float
        In radians.
    """
    depth, angle = distances_and_angles(places_yx, outline_yx, angles)
    rim = depth < 1.0  # subpixels further off are within pixels that the outline does not cut
    rim[rim] = ~shapely.contains_xy(shapely.Polygon(outline_yx), *places_yx[rim].T)
    depth[rim] = 0.0
    return depth, angle


def distances_and_angles(
    places_yx: FloatArray, outline_yx: FloatArray, angles: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """As `depths_and_angles`, but the distance of places outside the outline is that to it, too.

    Parameters
    ----------
    places_yx : ndarray of shape (P, subpixels, 2) and dtype float
        Subpixels of P pixels, on either side of the outline.
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon, (row, column) in pixels.
    angles : ndarray of shape (B,) and dtype float
        In radians, increasing within one turn.

    Returns
    -------
    distance, angle : ndarray of shape (P, subpixels) and dtype float
    """
    if not len(places_yx):
        return np.empty(places_yx.shape[:2]), np.empty(places_yx.shape[:2])
    ends = np.append(angles[1:], angles[0] + 2.0 * np.pi)
    shape = places_yx.shape[:2]
    flat = np.ascontiguousarray(places_yx.reshape(-1, 2))
    distance, angle = (found.reshape(shape) for found in _nearest(flat, shape[1], outline_yx, angles, ends))
    return distance, angle


@njit(cache=True)
def _nearest(
    places: FloatArray, n_subpixels: int, outline: FloatArray, angles: FloatArray, ends: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Edges that can be near enough to a few pixels, of these to each pixel, then by subpixel."""
    along = np.empty_like(outline)
    along[:-1] = outline[1:] - outline[:-1]
    along[-1] = outline[0] - outline[-1]
    squared = along[:, 0] ** 2 + along[:, 1] ** 2
    middles, half = outline + 0.5 * along, 0.5 * math.sqrt(squared.max())
    everything = np.arange(len(outline))
    depth, angle = np.empty(len(places)), np.empty(len(places))
    for first in range(0, len(places), _PIXELS_AT_ONCE * n_subpixels):
        last = min(first + _PIXELS_AT_ONCE * n_subpixels, len(places))
        around = _within_reach(middles, everything, places[first:last], half)
        for pixel in range(first, last, n_subpixels):
            near = _within_reach(middles, around, places[pixel : pixel + n_subpixels], half)
            for subpixel in range(pixel, pixel + n_subpixels):
                y, x = places[subpixel]
                best = limit = np.inf
                for i in near:
                    if (y - middles[i, 0]) ** 2 + (x - middles[i, 1]) ** 2 > limit:
                        continue  # no point of the edge is nearer than the best one
                    dy, dx = y - outline[i, 0], x - outline[i, 1]
                    share = (dy * along[i, 0] + dx * along[i, 1]) / squared[i]
                    share = min(max(share, 0.0), 1.0)
                    away = (dy - share * along[i, 0]) ** 2 + (dx - share * along[i, 1]) ** 2
                    if away < best:
                        best = away
                        limit = (math.sqrt(best) + half) ** 2 * (1.0 + 1e-12)
                        angle[subpixel] = angles[i] + share * (ends[i] - angles[i])
                depth[subpixel] = math.sqrt(best)
    return depth, angle


@njit(cache=True)
def _within_reach(middles: FloatArray, among: IntArray, places: FloatArray, half: float) -> IntArray:
    """Edges that can be the nearest one to any of some places; none is longer than 2 half."""
    y, x = 0.5 * (places[0] + places[-1])
    reach = 0.0  # from there to all places
    for place in places:
        reach = max(reach, math.hypot(place[0] - y, place[1] - x))
    squared = np.empty(len(among))
    for entry, i in enumerate(among):
        squared[entry] = (middles[i, 0] - y) ** 2 + (middles[i, 1] - x) ** 2
    # A place is at most √min + reach from its nearest edge, whose middle is half its length further.
    limit = (math.sqrt(squared.min()) + 2.0 * reach + half) * (1.0 + 1e-12)
    return among[squared <= limit**2]
