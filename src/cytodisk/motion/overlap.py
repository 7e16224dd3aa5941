"""How far two outlines overlap, and how far apart they are."""

from __future__ import annotations

import numpy as np
import shapely
from scipy.spatial import KDTree

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import signed_area
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import carry


def overlap(here: Contour, there: Contour) -> float:
    """Intersection of the insides of two outlines over their union, 0 to 1."""
    a, b = shapely.Polygon(here.outline_yx), shapely.Polygon(there.outline_yx)
    shared = shapely.intersection(a, b).area
    return float(shared / (a.area + b.area - shared))


def least_overlap(here: Contour, there: Contour, s: FloatArray, places: FloatArray) -> float:
    """The least that `overlap` can be, in a fraction of its time.

    What one outline sweeps on its way to the other covers all that lies in only one of them.

    Parameters
    ----------
    here, there : Contour
    s, places : ndarray of shape (N,) and dtype float
        Distances along `here` and along `there` that match, increasing through one turn.

    Returns
    -------
    float
        At most 1; negative where they match badly.
    """
    of_there = np.mod(carry(there.arc[:-1], places, s, there.length, here.length), here.length)
    corners = np.sort(np.concatenate([here.arc[:-1], of_there]))
    a = here.outline_at(corners)
    b = there.outline_at(carry(corners, s, places, here.length, there.length))
    a_next, b_next = np.roll(a, -1, axis=0), np.roll(b, -1, axis=0)
    swept = np.abs(_cross(a_next - a, b - a)).sum() + np.abs(_cross(b_next - a_next, b - a_next)).sum()
    areas = 2.0 * (signed_area(here.outline_yx) + signed_area(there.outline_yx))
    return float((areas - swept) / (areas + swept))


def _cross(one: FloatArray, other: FloatArray) -> FloatArray:
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])


def outline_distance(here: Contour, there: Contour) -> float:
    """Largest distance from a corner of either outline to the nearest corner of the other, in pixels."""
    one, other = here.points_yx, there.points_yx
    away, back = KDTree(other).query(one)[0], KDTree(one).query(other)[0]
    return float(max(np.max(away), np.max(back)))


def corner_distance(here: Contour, there: Contour, s: float) -> float:
    """Distance from the corner of `here` before s to the nearest of `there`; at most `outline_distance`."""
    corner = here.points_yx[np.searchsorted(here.arc, s, side="right") - 1]
    return float(np.sqrt(np.square(there.points_yx - corner).sum(axis=1).min()))
