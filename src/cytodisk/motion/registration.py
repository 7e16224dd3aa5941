"""Rigid registration of outlines (paper, algorithm 1); transforms are numbers, images stay as they are."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import centroid
from cytodisk.motion.contour import Contour
from cytodisk.motion.matching import mean_square_displacement, rigid_motion

_HESITATION = 0.15


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

    def after(self, first: RigidTransform) -> RigidTransform:
        """The transform that applies another one first, then this one."""
        shift = self(first.shift)
        return RigidTransform(self.angle + first.angle, float(shift[0]), float(shift[1]))

    def undone(self) -> RigidTransform:
        """The transform that takes this one back."""
        shift = -(self.shift @ self.rotation)
        return RigidTransform(-self.angle, float(shift[0]), float(shift[1]))

    def of(self, contour: Contour) -> Contour:
        """The transformed contour."""
        return Contour(self(contour.points_yx), self(contour.outline_yx))


IDENTITY = RigidTransform()


@dataclass(frozen=True, eq=False)
class Registration:
    """A rigid motion that lays an outline onto a reference, and where points of the reference come to lie.

    Attributes
    ----------
    transform : RigidTransform
        From the frame of the outline to the common frame.
    reference_s : ndarray of shape (N,) and dtype float
        Points on the reference, in pixels along it.
    slid, turned : ndarray of shape (N,) and dtype float
        The same points on the outline, if it does not turn from where it was, and if it may turn freely.
    """

    transform: RigidTransform
    reference_s: FloatArray
    slid: FloatArray
    turned: FloatArray


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


def believable(
    last: RigidTransform,
    found: RigidTransform,
    contour: Contour,
    reference: Contour,
    start: Registration,
    smoothness: float,
) -> RigidTransform:
    """Go from the last frame's transform towards a new one, as far as that explains how the boundary moved.

    A shape that moves or turns as a whole is followed at once; of a change of shape that merely looks like a
    rotation, such as a wave of ruffles, little is taken for one. With q the share of the squared boundary
    displacement that the new transform takes away, the way gone is q / (q + 0.15 (1 - q)).

    Parameters
    ----------
    last, found : RigidTransform
        From the frame of `contour` to the common frame.
    contour, reference : Contour
        This frame's, and the reference's in the common frame.
    start : Registration
        Of the same two outlines; its points are where matching starts.
    smoothness : float
        Smoothness of the matching energy, in square pixels.

    Returns
    -------
    RigidTransform
    """
    before, after = (
        mean_square_displacement(reference, transform.of(contour), start.reference_s, places, smoothness)
        for transform, places in ((last, start.slid), (found, start.turned))
    )
    explained = 1.0 - after / before if after < before else 0.0
    way = explained / (explained + _HESITATION * (1.0 - explained))
    middle = centroid(contour.points_yx)
    angle = last.angle + way * (found.angle - last.angle)
    shift = (1.0 - way) * last(middle) + way * found(middle) - RigidTransform(angle)(middle)
    return RigidTransform(angle, float(shift[0]), float(shift[1]))


def register(
    moving: Contour,
    reference: Contour,
    start: RigidTransform,
    reference_s: FloatArray,
    moving_s: FloatArray,
    smoothness: float,
    stiff: bool = False,
) -> Registration:
    """Rigid motion that lays one outline onto another.

    The motion that leaves the least of the matching energy (`matching.rigid_motion`): a growing protrusion
    turns the cell less than it would turn a fit of overlap, and a round cell stays as it is.

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
        Smoothness of the matching energy, in square pixels.
    stiff : bool
        Of a body that hardly changes its shape; see `rigid_motion`.

    Returns
    -------
    Registration

    References
    ----------
    u-Unwrap, appendix A.1, algorithm 1.
    """
    fit = rigid_motion(reference, start.of(moving), reference_s, moving_s, smoothness, stiff)
    shift = RigidTransform(-fit.angle)(start.shift - fit.place) + fit.pivot
    transform = RigidTransform(start.angle - fit.angle, float(shift[0]), float(shift[1]))
    return Registration(transform, fit.s, fit.slid, fit.turned)
