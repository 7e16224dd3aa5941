"""Rigid registration of outlines (paper, algorithm 1); transforms are numbers, images stay as they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import centroid
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import rigid_motion


@dataclass(frozen=True)
class RigidTransform:
    """Rotation about the origin, then shift: x → R x + shift.

    Attributes
    ----------
    angle : float
        In radians, from +x towards +y.
    shift_y, shift_x : float
        In pixels.
    """

    angle: float = 0.0
    shift_y: float = 0.0
    shift_x: float = 0.0

    @property
    def rotation(self) -> FloatArray:
        """Matrix for (row, column) vectors, shape (2, 2)."""
        cosine, sine = math.cos(self.angle), math.sin(self.angle)
        return np.array([[cosine, sine], [-sine, cosine]])

    @property
    def shift(self) -> FloatArray:
        """(row, column) in pixels, shape (2,)."""
        return np.array([self.shift_y, self.shift_x])

    def __call__(self, points_yx: FloatArray) -> FloatArray:
        """Transformed points, of the shape that came, (..., 2)."""
        return np.asarray(points_yx @ self.rotation.T + self.shift)

    def inverse(self, points_yx: FloatArray) -> FloatArray:
        """Points whose transforms are given, of the shape that came, (..., 2)."""
        return np.asarray((points_yx - self.shift) @ self.rotation)

    def of(self, contour: Contour) -> Contour:
        """The transformed contour."""
        return Contour(self(contour.points_yx), self(contour.outline_yx))


IDENTITY = RigidTransform()


def first_transform(moving: Contour, reference: Contour, angle: float) -> RigidTransform:
    """Transform with a known rotation that brings the centroids together.

    Parameters
    ----------
    moving : Contour
    reference : Contour
        In the common frame.
    angle : float
        In radians; that of the last frame, so that no cell can flip by half a turn.

    Returns
    -------
    RigidTransform
        From the frame of `moving` to the common one.
    """
    shift = centroid(reference.points_yx) - RigidTransform(angle)(centroid(moving.points_yx))
    return RigidTransform(angle, float(shift[0]), float(shift[1]))


def register(
    moving: Contour,
    reference: Contour,
    start: RigidTransform,
    reference_s: FloatArray,
    moving_s: FloatArray,
    smoothness: float,
) -> RigidTransform:
    """Rigid motion that lays one outline onto another.

    The motion that leaves the least of the matching energy (`matching.rigid_motion`): a growing protrusion
    turns the cell less than it would turn a fit of overlap. A rotation counts only in so far as it explains
    how the boundary moved, so a round cell stays as it is.

    Parameters
    ----------
    moving : Contour
    reference : Contour
        In the common frame.
    start : RigidTransform
        First guess.
    reference_s, moving_s : ndarray of shape (N,) and dtype float
        Points on the reference and a guess of the same points on `moving`, distances along each in pixels.
    smoothness : float
        Of the matching energy, in square pixels.

    Returns
    -------
    RigidTransform
        From the frame of `moving` to the common frame.

    References
    ----------
    u-Unwrap, appendix A.1, algorithm 1.
    """
    angle, pivot, place = rigid_motion(reference, start.of(moving), reference_s, moving_s, smoothness)
    back = RigidTransform(-angle)
    shift = back(start.shift - place) + pivot
    return RigidTransform(start.angle - angle, float(shift[0]), float(shift[1]))
