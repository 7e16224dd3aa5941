"""Borders between layers of equal depth: the curves at one distance from a cell's edge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import shapely

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import edge_lengths, signed_area
from cytodisk.windows.pixel_shares.subpixels import distances_and_angles

_STEP_PX = 0.5  # between points of a border, at most
_QUARTER = 16  # points of a quarter of a circle
_LEAST_AREA = 1e-6  # of what a border surrounds, in square pixels


@dataclass(frozen=True, eq=False)
class Border:
    """A closed curve at one depth below the edge of a cell; the edge itself is the one at depth 0.

    Attributes
    ----------
    points_yx : ndarray of shape (B, 2) and dtype float
        (row, column) in pixels, in the direction of the cell's outline; the last point is not repeated.
    """

    points_yx: FloatArray

    @cached_property
    def arc(self) -> FloatArray:
        """Distance along the curve of each point from the first, and the whole length, shape (B + 1,)."""
        return np.concatenate([[0.0], np.cumsum(edge_lengths(self.points_yx))])

    @property
    def length(self) -> float:
        """Length of the curve in pixels."""
        return float(self.arc[-1])

    def at(self, arc: FloatArray) -> FloatArray:
        """Points at a distance along the curve, shape (n, 2), (row, column) in pixels.

        Parameters
        ----------
        arc : ndarray of shape (n,) and dtype float
            In pixels; any number of turns.
        """
        closed = np.append(self.points_yx, self.points_yx[:1], axis=0)
        within = np.mod(arc, self.length)
        return np.column_stack([np.interp(within, self.arc, column) for column in closed.T])

    def nearest(self, places_yx: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distance of places to the curve, and how far along it the nearest point is.

        Parameters
        ----------
        places_yx : ndarray of shape (P, n, 2) and dtype float
            The n places of a row are near each other.

        Returns
        -------
        distance, arc : ndarray of shape (P, n) and dtype float
        """
        turn = 2.0 * np.pi / self.length
        distance, angle = distances_and_angles(places_yx, self.points_yx, turn * self.arc[:-1])
        return distance, np.mod(angle / turn, self.length)

    def feet_of(self, inner: Border) -> FloatArray:
        """How far along this border the nearest point to each point of the next inner one is.

        Parameters
        ----------
        inner : Border

        Returns
        -------
        ndarray of shape (inner points + 1,) and dtype float
            Not decreasing; the last is the first, a turn further on.
        """
        _, arc = self.nearest(inner.points_yx[:, None])
        return one_turn(arc[:, 0], self.length)


def one_turn(arc: FloatArray, length: float) -> FloatArray:
    """Distances along a closed curve as a sequence that goes once around and not back.

    Parameters
    ----------
    arc : ndarray of shape (n,) and dtype float
        Within one turn each, of points in their order, but for steps back.
    length : float
        Of the curve.

    Returns
    -------
    ndarray of shape (n + 1,) and dtype float
        The last is the first, a turn further on.
    """
    steps = np.diff(arc, append=arc[:1])
    steps -= length * np.round(steps / length)
    short = round((length - steps.sum()) / length)
    steps[int(np.argmin(steps) if short > 0 else np.argmax(steps))] += short * length
    there = arc[0] + np.concatenate([[0.0], np.cumsum(steps)])
    ahead = np.maximum.accumulate(there)
    behind = np.minimum.accumulate(there[::-1])[::-1]
    return np.asarray(np.clip(0.5 * (ahead + behind), there[0], there[0] + length))


def inner_borders(outline_yx: FloatArray, depth: float) -> list[Border]:
    """All curves at one depth below an outline.

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon, (row, column) in pixels.
    depth : float
        Above 0, in pixels.

    Returns
    -------
    list of Border
        Several where the cell falls into parts at this depth, none where it ends before.
    """
    within = shapely.buffer(shapely.Polygon(outline_yx), -depth, quad_segs=_QUARTER)
    direction = np.sign(signed_area(outline_yx))
    found = []
    for part in shapely.get_parts(within):
        if part.area < _LEAST_AREA:
            continue
        ring = shapely.get_coordinates(shapely.segmentize(part.exterior, _STEP_PX))[:-1]
        ring = ring[edge_lengths(ring) > 0]
        found.append(Border(ring if np.sign(signed_area(ring)) == direction else ring[::-1].copy()))
    return found
