"""`Contour`: a closed outline as a curve with arc length."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.geometry.polygon import edge_lengths, smooth_closed

SMOOTHING_PX = 2.0


@dataclass(frozen=True, eq=False)
class Contour:
    """A closed polygon with its arc length.

    Attributes
    ----------
    points_yx : ndarray of shape (B, 2) and dtype float
        From +x towards +y, (row, column) in pixels; the last point is not repeated.
    outline_yx : ndarray of shape (B, 2) and dtype float
        The outline that the curve was smoothed from, point by point.
    """

    points_yx: FloatArray
    outline_yx: FloatArray

    @classmethod
    def of_outline(cls, outline_yx: FloatArray, sigma_px: float = SMOOTHING_PX) -> Contour:
        """Smoothed copy of a pixel outline, one point for each of its points.

        The stair steps of an outline carry neither length nor direction; smoothing along the curve takes
        them away and moves straight edges by nothing.
        """
        return cls(smooth_closed(outline_yx, sigma_px), outline_yx)

    @cached_property
    def arc(self) -> FloatArray:
        """Distance along the curve of each point from the first, and the whole length, shape (B + 1,)."""
        return np.concatenate([[0.0], np.cumsum(edge_lengths(self.points_yx))])

    @property
    def length(self) -> float:
        """Length of the curve in pixels."""
        return float(self.arc[-1])

    def at(self, s: FloatArray) -> FloatArray:
        """Points at a distance along the curve.

        Parameters
        ----------
        s : ndarray of shape (N,) and dtype float
            In pixels; any number of turns.

        Returns
        -------
        ndarray of shape (N, 2) and dtype float
        """
        edge, share = self._edge_at(s)
        start = self.points_yx[edge]
        return np.asarray(start + share[:, None] * self._edges[edge])

    def outline_at(self, s: FloatArray) -> FloatArray:
        """Points of the unsmoothed outline that belong to a distance along the curve, shape (N, 2)."""
        edge, share = self._edge_at(s)
        start, stop = self.outline_yx[edge], self.outline_yx[(edge + 1) % len(self.outline_yx)]
        return np.asarray(start + share[:, None] * (stop - start))

    def normals(self, s: FloatArray) -> FloatArray:
        """Outward unit normals at a distance along the curve, shape (N, 2).

        Directions at the curve's points are the means of their edges', interpolated between points.
        """
        edge, share = self._edge_at(s)
        tangent = (1.0 - share[:, None]) * self._tangents[edge]
        tangent += share[:, None] * self._tangents[(edge + 1) % len(self.points_yx)]
        normal = np.column_stack([-tangent[:, 1], tangent[:, 0]])
        return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))

    @cached_property
    def _edges(self) -> FloatArray:
        return np.roll(self.points_yx, -1, axis=0) - self.points_yx

    @cached_property
    def _tangents(self) -> FloatArray:
        central = np.roll(self.points_yx, -1, axis=0) - np.roll(self.points_yx, 1, axis=0)
        return np.asarray(central / np.linalg.norm(central, axis=1, keepdims=True))

    def _edge_at(self, s: FloatArray) -> tuple[IntArray, FloatArray]:
        wrapped = np.mod(s, self.length)
        edge: IntArray = np.clip(
            np.searchsorted(self.arc, wrapped, side="right") - 1, 0, len(self.points_yx) - 1
        )
        return edge, (wrapped - self.arc[edge]) / (self.arc[edge + 1] - self.arc[edge])
