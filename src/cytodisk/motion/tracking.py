"""Boundary points from frame to frame: registration, tracker, order, restarts."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Literal, TypeAlias, get_args

import numpy as np
import shapely

from cytodisk.arrays import FloatArray
from cytodisk.disk.circle import boundary_angles
from cytodisk.errors import ParameterError
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.motion.contour import Contour
from cytodisk.motion.demons import DemonsParameters, propagate
from cytodisk.motion.matching import SMOOTHNESS_PX2, carry, first_guess, match
from cytodisk.motion.registration import IDENTITY, RigidTransform, believable, first_transform, register

Tracker: TypeAlias = Literal["matching", "demons"]
TRACKERS: tuple[Tracker, ...] = get_args(Tracker)

_LEAST_POINTS = 256
_LEAST_OVERLAP = 0.2  # of intersection and union, after registration, below which tracking starts anew
_LEAST_GAP = 1e-6  # of the mean gap between neighbouring points, so that order is strict


@dataclass(frozen=True)
class TrackingSettings:
    """How a boundary is followed.

    Attributes
    ----------
    tracker : {"matching", "demons"}
        "matching": `motion.matching`. "demons": the paper's, `motion.demons`.
    tension : float
        For "matching", share of the way from where matter went to equidistant points that the points go in
        each frame: 0 is pure matter, 1 the paper's redistribution.
    smoothness_px2 : float
        Of the matching energy, in square pixels.
    register : bool
        Take out rigid motion; if not, all transforms are the identity.
    renew_every : int
        Frames after which the reference of the registration is replaced by the last registered frame.
    demons : DemonsParameters
    """

    tracker: Tracker = "matching"
    tension: float = 0.01
    smoothness_px2: float = SMOOTHNESS_PX2
    register: bool = True
    renew_every: int = 5
    demons: DemonsParameters = field(default_factory=DemonsParameters)

    def __post_init__(self) -> None:
        if self.tracker not in TRACKERS:
            raise ParameterError(f"tracker must be one of {', '.join(TRACKERS)}, got {self.tracker!r}")
        if not (is_number(self.tension) and 0.0 <= self.tension <= 1.0):
            raise ParameterError(f"tension must be 0 to 1, got {self.tension!r}: 0.01 is the default")
        if not (is_number(self.smoothness_px2) and 0.0 < self.smoothness_px2 < np.inf):
            raise ParameterError(
                f"smoothness_px2 must be above 0, got {self.smoothness_px2!r}: "
                f"{SMOOTHNESS_PX2:g} is the default"
            )
        if (
            isinstance(self.renew_every, bool)
            or not isinstance(self.renew_every, int | np.integer)
            or self.renew_every < 1
        ):
            raise ParameterError(
                f"renew_every must be a whole number of at least 1, got {self.renew_every!r}"
            )


@dataclass(frozen=True, eq=False)
class TrackedBoundary:
    """Tracked points on the outline of one frame.

    Point i has the angle `point_angles(N)[i]` on the disk in every frame.

    Attributes
    ----------
    time : int
        Number of the frame.
    contour : Contour
        In the image's frame.
    s : ndarray of shape (N,) and dtype float
        Distance of the points along the contour, in pixels; strictly increasing through one turn.
    transform : RigidTransform
        From the image's frame to the common frame of the movie, that of its first frame.
    alignment : RigidTransform
        The part of it that "matching" believes in; see `registration.believable`.
    residual_px : float
        For "matching", mean distance between points and where they come to lie when carried on and back
        again; for "demons", mean distance of the propagated points from the outline. 0 in a first frame.
    order_violations : int
        Neighbouring points that had changed places before order was restored; "matching" has none.
    restarted : str
        Why tracking started anew here; empty if it did not.
    """

    time: int
    contour: Contour
    s: FloatArray
    transform: RigidTransform = IDENTITY
    alignment: RigidTransform = IDENTITY
    residual_px: float = 0.0
    order_violations: int = 0
    restarted: str = ""

    @property
    def points_yx(self) -> FloatArray:
        """Tracked points in the image, shape (N, 2), (row, column) in pixels."""
        return self.contour.at(self.s)

    @property
    def outline_points_yx(self) -> FloatArray:
        """Points of the unsmoothed outline that the tracked points belong to, shape (N, 2)."""
        return self.contour.outline_at(self.s)

    @property
    def normals_yx(self) -> FloatArray:
        """Outward unit normals at the points, in the image's frame, shape (N, 2)."""
        return self.contour.normals(self.s)

    @property
    def lengths_px(self) -> FloatArray:
        """Length of boundary that is nearer to each point than to its neighbours, shape (N,)."""
        gaps = np.diff(self.s, append=self.s[0] + self.contour.length)
        return np.asarray(0.5 * (gaps + np.roll(gaps, 1)))


def is_number(value: Any) -> bool:
    """Whether a parameter is a number; True and False are none."""
    return isinstance(value, int | float | np.number) and not isinstance(value, bool)


def point_angles(n: int) -> FloatArray:
    """Angle on the disk of each of n tracked points, in radians."""
    return np.asarray(2.0 * np.pi * (np.arange(n) + 0.5) / n)


def first_boundary(time: int, contour: Contour, angles: FloatArray) -> TrackedBoundary:
    """Points to be tracked, at even angles of the first frame.

    Parameters
    ----------
    time : int
    contour : Contour
    angles : ndarray of shape (B,) and dtype float
        Angle of each outline point on the disk, in radians, strictly increasing within one turn.

    Returns
    -------
    TrackedBoundary
        About one point a pixel, 256 at least.
    """
    return TrackedBoundary(
        time, contour, _at_even_angles(contour, angles, max(_LEAST_POINTS, round(contour.length)))
    )


def follow(
    time: int,
    contour: Contour,
    last: TrackedBoundary,
    reference: TrackedBoundary,
    settings: TrackingSettings,
) -> TrackedBoundary:
    """Carry tracked points to the next frame.

    Parameters
    ----------
    time : int
        Number of this frame.
    contour : Contour
        This frame's, in the image's frame.
    last : TrackedBoundary
        Of the last frame that had one.
    reference : TrackedBoundary
        Of the frame that registration refers to.
    settings : TrackingSettings

    Returns
    -------
    TrackedBoundary
        With as many points as the last; if the outlines hardly overlap even after registration, or the
        points do not go once around, tracking starts anew and says why.
    """
    here = last.transform.of(last.contour)
    smoothness = settings.smoothness_px2
    rough = first_transform(contour, here, last.transform.angle) if settings.register else IDENTITY
    guess = first_guess(here, rough.of(contour), last.s, smoothness)
    transform = alignment = rough
    if settings.register:
        fixed = reference.transform.of(reference.contour)
        transform = register(contour, fixed, rough, reference.s, guess, smoothness)
        moved = reference.alignment.after(reference.transform.undone())
        alignment = believable(
            last.alignment, moved.after(transform), contour, moved.of(fixed), reference.s, guess, smoothness
        )
    overlap = _overlap(here, transform.of(contour))
    if overlap < _LEAST_OVERLAP:
        why = f"outlines overlap by {overlap:.0%} only (frames {last.time} and {time})"
        return _restart(time, contour, transform, last, why)
    if settings.tracker == "demons":
        return _follow_demons(time, contour, last, transform, settings.demons)
    here, there = last.alignment.of(last.contour), alignment.of(contour)
    s = match(here, there, last.s, guess, smoothness)
    back = match(there, here, s, last.s, smoothness)
    residual = float(np.linalg.norm(here.at(back) - here.at(last.s), axis=1).mean())
    even = _towards_even(s, there.length, settings.tension)
    return TrackedBoundary(time, contour, even, transform, alignment, residual)


def _follow_demons(
    time: int,
    contour: Contour,
    last: TrackedBoundary,
    transform: RigidTransform,
    parameters: DemonsParameters,
) -> TrackedBoundary:
    here, there = last.transform.of(last.contour), transform.of(contour)
    try:
        points = propagate(here, there, here.at(last.s), parameters)
    except ParameterError as fault:  # of a cell of a few pixels; the movie goes on
        return _restart(time, contour, transform, last, f"demons cannot follow the outline: {fault}")
    edge, share = nearest_on_outline(points, there.points_yx)
    s = there.arc[edge] + share * (there.arc[edge + 1] - there.arc[edge])
    residual = float(np.linalg.norm(there.at(s) - points, axis=1).mean())
    steps = np.mod(np.diff(s, append=s[:1]) + 0.5 * there.length, there.length) - 0.5 * there.length
    if abs(steps.sum() - there.length) > 1e-6 * there.length:
        why = f"demons points do not go once around the outline (frames {last.time} and {time})"
        return _restart(time, contour, transform, last, why)
    ordered = np.maximum(steps, _LEAST_GAP * there.length / len(s))
    ordered *= there.length / ordered.sum()
    placed = s[0] + np.concatenate([[0.0], np.cumsum(ordered)[:-1]])
    violations = int((steps <= 0).sum())
    return TrackedBoundary(time, contour, placed, transform, transform, residual, violations)


def _restart(
    time: int, contour: Contour, transform: RigidTransform, last: TrackedBoundary, why: str
) -> TrackedBoundary:
    """Points anew, with the disk turned to the cell as it was in the last frame."""
    angles = boundary_angles(transform(contour.outline_yx))
    before = last.transform(last.points_yx)
    away = before - before.mean(axis=0)
    lead = point_angles(len(last.s)) - np.arctan2(away[:, 0], away[:, 1])
    angles = angles + float(np.angle(np.exp(1j * lead).sum()))
    s = _at_even_angles(contour, angles, len(last.s))
    return TrackedBoundary(time, contour, s, transform, transform, restarted=why)


def _at_even_angles(contour: Contour, angles: FloatArray, n: int) -> FloatArray:
    return carry(point_angles(n), angles, contour.arc[:-1], 2.0 * np.pi, contour.length)


def _towards_even(s: FloatArray, length: float, tension: float) -> FloatArray:
    even = length * np.arange(len(s)) / len(s)
    return np.asarray(s + tension * (even + (s - even).mean() - s))


def _overlap(here: Contour, there: Contour) -> float:
    a, b = shapely.Polygon(here.outline_yx), shapely.Polygon(there.outline_yx)
    shared = shapely.intersection(a, b).area
    return float(shared / (a.area + b.area - shared))
