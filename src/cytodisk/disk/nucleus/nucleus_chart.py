"""From a cell with its nucleus to the disk and back."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.nucleus.cone import TURN, rounded, to_polygon
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.geometry.locate import TriangleLocator, weighted_corners


class NucleusChart:
    """The map of a cell with its nucleus, as functions of points.

    Parameters
    ----------
    vertices_yx : ndarray of shape (V, 2) and dtype float
    triangles : ndarray of shape (F, 3) and dtype int
    nucleus : Nucleus
    boundary_angles : ndarray of shape (B,) and dtype float
        Of the membrane, increasing through one turn.
    """

    def __init__(
        self, vertices_yx: FloatArray, triangles: IntArray, nucleus: Nucleus, boundary_angles: FloatArray
    ):
        self._nucleus, self._triangles, self._vertices_yx = nucleus, triangles, vertices_yx
        self._boundary_angles = boundary_angles
        self._inner = triangles[nucleus.inside]

    @cached_property
    def _in_cell(self) -> TriangleLocator:
        return TriangleLocator(self._vertices_yx, self._triangles)

    @cached_property
    def _on_cylinder(self) -> tuple[TriangleLocator, IntArray]:
        """Triangles of the cytoplasm, some of them twice, and their numbers in the mesh."""
        outer = np.flatnonzero(~self._nucleus.inside)
        corners, numbers = _unrolled(self._nucleus.corners(self._triangles), outer)
        return TriangleLocator(*_separate(corners)), numbers

    @cached_property
    def _in_nucleus(self) -> TriangleLocator:
        return TriangleLocator(*_used(self._nucleus.own_uv, self._inner))

    def to_disk(self, points_yx: FloatArray) -> FloatArray:
        """Points of the cell, (row, column), in the whole disk, (u, v); NaN outside, shape (N, 2)."""
        triangle, weights = self._in_cell(points_yx)
        uv = np.full((len(points_yx), 2), np.nan)
        inner = (triangle >= 0) & self._nucleus.inside[triangle]
        own = self._nucleus.own_uv[self._triangles[triangle[inner]]]
        polygon = (weights[inner, :, None] * own).sum(axis=1)
        uv[inner] = self._nucleus.radius * rounded(polygon, self._nucleus.boundary_angles)
        outer = (triangle >= 0) & ~self._nucleus.inside[triangle]
        corners = self._nucleus.places[self._triangles[triangle[outer]]]
        corners[..., 1] += self._nucleus.lifts[triangle[outer]]
        share, turn = (weights[outer, :, None] * corners).sum(axis=1).T
        radius, angle = self._nucleus.radius_at(np.maximum(share, 0.0)), TURN * turn
        uv[outer] = radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
        return uv

    def to_cell(self, points_uv: FloatArray) -> FloatArray:
        """The inverse; NaN outside the disk."""
        yx = np.full((len(points_uv), 2), np.nan)
        radius, angle = np.hypot(*points_uv.T), np.arctan2(points_uv[:, 1], points_uv[:, 0])
        outer = (radius >= self._nucleus.radius) & (radius <= 1.0 + 1e-9)
        share, turn = self._nucleus.share_at(radius[outer]), np.mod(angle[outer] / TURN, 1.0)
        locator, numbers = self._on_cylinder
        triangle, weights = locator(np.column_stack([share, turn]))
        corners = self._vertices_yx[self._triangles[numbers[triangle]]]
        found = (weights[:, :, None] * corners).sum(axis=1)
        found[triangle < 0] = np.nan
        yx[outer] = found
        inner = radius < self._nucleus.radius
        polygon = to_polygon(
            radius[inner] / self._nucleus.radius, angle[inner], self._nucleus.boundary_angles
        )
        located = self._in_nucleus(polygon)
        yx[inner] = weighted_corners(self._vertices_yx, self._inner, *located)
        return yx

    def on_circle(self, edge: IntArray, fraction: FloatArray) -> FloatArray:
        """(u, v) of points at fractions of edges of the membrane, shape (N, 2)."""
        angles = self._boundary_angles
        steps = np.diff(angles, append=angles[0] + TURN)
        angle = angles[edge] + fraction * steps[edge]
        return np.column_stack([np.cos(angle), np.sin(angle)])


def _unrolled(corners: FloatArray, numbers: IntArray) -> tuple[FloatArray, IntArray]:
    """Triangles of the cylinder at turns from 0 to 1, twice if they cross that cut; and their numbers."""
    low = np.floor(corners[..., 1].min(axis=1))
    first = corners - np.stack([np.zeros_like(low), low], axis=-1)[:, None]
    copies, which = [first], [numbers]
    for turns in range(1, int(np.ceil(first[..., 1].max())) + 1):
        beyond = first[..., 1].max(axis=1) >= turns
        copies.append(first[beyond] - np.array([0.0, float(turns)]))
        which.append(numbers[beyond])
    return np.concatenate(copies), np.concatenate(which)


def _separate(corners: FloatArray) -> tuple[FloatArray, IntArray]:
    """Triangles that share no vertex."""
    return corners.reshape(-1, 2), np.arange(3 * len(corners)).reshape(-1, 3)


def _used(points: FloatArray, triangles: IntArray) -> tuple[FloatArray, IntArray]:
    """Triangles with their own vertices alone, so that others do not count for the extent."""
    used, renumbered = np.unique(triangles, return_inverse=True)
    return points[used], renumbered.reshape(-1, 3)
