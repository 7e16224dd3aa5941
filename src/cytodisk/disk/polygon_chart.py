"""From a cell to the disk and back, where the map is linear in (u, v) on every triangle."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.circle import polygon_radius
from cytodisk.geometry.locate import TriangleLocator


class Chart(Protocol):
    """A map between a cell and the disk, as functions of points."""

    def to_disk(self, points_yx: FloatArray) -> FloatArray:
        """Points of the cell, (row, column), in the disk, (u, v); NaN outside, shape (N, 2)."""

    def to_cell(self, points_uv: FloatArray) -> FloatArray:
        """The inverse; NaN outside the disk."""

    def on_circle(self, edge: IntArray, fraction: FloatArray) -> FloatArray:
        """(u, v) of points at fractions of edges of the boundary, shape (N, 2)."""


class PolygonChart:
    """A map onto the polygon of the boundary's vertices in the disk, stretched to fill the round disk.

    Parameters
    ----------
    vertices_yx, vertices_uv : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
    boundary : ndarray of shape (B,) and dtype int
    angles : ndarray of shape (B,) and dtype float
        Of the boundary, increasing through one turn.
    onto_rim : bool
        Turned triangles can carry points beyond the rim: put them on it.
    """

    def __init__(
        self,
        vertices_yx: FloatArray,
        vertices_uv: FloatArray,
        triangles: IntArray,
        boundary: IntArray,
        angles: FloatArray,
        onto_rim: bool = False,
    ):
        self._vertices_yx, self._vertices_uv = vertices_yx, vertices_uv
        self._circle, self._angles, self._onto_rim = vertices_uv[boundary], angles, onto_rim
        self._triangles = triangles
        self._in_cell: TriangleLocator | None = None
        self._in_disk: TriangleLocator | None = None

    def to_disk(self, points_yx: FloatArray) -> FloatArray:
        """Points of the cell, (row, column), in the disk, (u, v); NaN outside, shape (N, 2)."""
        self._in_cell = self._in_cell or TriangleLocator(self._vertices_yx, self._triangles)
        uv = self._in_cell.carry(points_yx, self._vertices_uv)
        uv /= polygon_radius(uv, self._angles)[:, None]
        if self._onto_rim:
            uv /= np.maximum(np.hypot(uv[:, 0], uv[:, 1]), 1.0)[:, None]
        return uv

    def to_cell(self, points_uv: FloatArray) -> FloatArray:
        """The inverse; NaN outside the disk."""
        self._in_disk = self._in_disk or TriangleLocator(self._vertices_uv, self._triangles)
        inner = points_uv * polygon_radius(points_uv, self._angles)[:, None]
        return self._in_disk.carry(inner, self._vertices_yx)

    def on_circle(self, edge: IntArray, fraction: FloatArray) -> FloatArray:
        """(u, v) of points at fractions of edges of the boundary, shape (N, 2)."""
        circle = self._circle
        chord = circle[edge] + fraction[:, None] * (circle[(edge + 1) % len(circle)] - circle[edge])
        return np.asarray(chord / np.hypot(chord[:, 0], chord[:, 1])[:, None])
