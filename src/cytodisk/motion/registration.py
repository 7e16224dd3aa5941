"""Rigid registration of consecutive outlines (paper algorithm 1); transforms are numbers, images stay as they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import centroid
from cytodisk.motion.contour import Contour

_SAMPLES = 400
_ROUNDS = 40
_STILL_PX = 1e-4
_ROUND_SHAPE = 0.01  # share of outline motion along the normal below which a rotation cannot be seen


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
        c, s = math.cos(self.angle), math.sin(self.angle)
        return np.array([[c, s], [-s, c]])

    @property
    def shift(self) -> FloatArray:
        """(row, column) in pixels, shape (2,)."""
        return np.array([self.shift_y, self.shift_x])

    def __call__(self, points_yx: FloatArray) -> FloatArray:
        """Transformed points, shape (N, 2)."""
        return np.asarray(points_yx @ self.rotation.T + self.shift)

    def inverse(self, points_yx: FloatArray) -> FloatArray:
        """Points whose transforms are given, shape (N, 2)."""
        return np.asarray((points_yx - self.shift) @ self.rotation)

    def of(self, contour: Contour) -> Contour:
        """The transformed contour."""
        return Contour(self(contour.points_yx))


def register(moving: Contour, reference: Contour, start: RigidTransform) -> RigidTransform:
    """Rigid motion that lays one outline onto another.

    Least squares of the distance along the normal, by Gauss-Newton steps with far parts weighted down, so
    that a growing protrusion does not turn the cell. It starts from a rotation that is known to be near, so
    it cannot flip by half a turn; and where the outline is too round for a rotation to be seen, that
    rotation stays as it is.

    Parameters
    ----------
    moving : Contour
    reference : Contour
        In the common frame.
    start : RigidTransform
        Its rotation is the first guess; the shift starts where the centroids meet.

    Returns
    -------
    RigidTransform
        From the frame of `moving` to the common frame.

    References
    ----------
    u-Unwrap, appendix A.1, algorithm 1. Point-to-plane distance: Chen & Medioni 1992,
    doi:10.1016/0262-8856(92)90066-C.
    """
    points = moving.at(moving.length * np.arange(_SAMPLES) / _SAMPLES)
    middle = centroid(moving.points_yx)
    target_s = reference.length * np.arange(4 * _SAMPLES) / (4 * _SAMPLES)
    target, normals = reference.at(target_s), reference.normals(target_s)
    tree = cKDTree(target)
    radius = math.sqrt(float(np.square(points - middle).sum(axis=1).mean()))
    angle, place = start.angle, centroid(reference.points_yx)
    for _ in range(_ROUNDS):
        turned = (points - middle) @ RigidTransform(angle).rotation.T
        _, nearest = tree.query(turned + place)
        normal = normals[nearest]
        gap = ((target[nearest] - turned - place) * normal).sum(axis=1)
        weight = 1.0 / np.maximum(1.0, np.abs(gap) / max(0.5, float(np.median(np.abs(gap)))))
        sideways = np.column_stack([turned[:, 1], -turned[:, 0]]) / radius
        columns = np.column_stack([normal, (sideways * normal).sum(axis=1)])
        square = columns.T @ (weight[:, None] * columns)
        visible = square[2, 2] / weight.sum()
        square[2, 2] *= 1.0 + (_ROUND_SHAPE / max(visible, 1e-9)) ** 3
        step = np.linalg.solve(square, columns.T @ (weight * gap))
        place = place + step[:2]
        angle += step[2] / radius
        if np.abs(step).max() < _STILL_PX:
            break
    shift = place - RigidTransform(angle).rotation @ middle
    return RigidTransform(float(angle), float(shift[0]), float(shift[1]))
