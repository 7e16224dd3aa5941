"""Boundary points from frame to frame: registration, tracker, order, restarts."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.circle import boundary_angles
from cytodisk.errors import ParameterError
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.motion.contour import Contour
from cytodisk.motion.demons import propagate
from cytodisk.motion.demons_parameters import DemonsParameters
from cytodisk.motion.matching import carry, even_grid, first_guess, match
from cytodisk.motion.overlap import corner_distance, least_overlap, outline_distance, overlap
from cytodisk.motion.registration import IDENTITY, RigidTransform, believable, first_transform, register
from cytodisk.motion.tracking_parameters import TrackingSettings

_LEAST_POINTS = 256
_LEAST_OVERLAP = 0.2  # of intersection and union, after registration, below which tracking starts anew
_USUAL_TURN = math.radians(3.0)  # more in one frame must be seen from the last frame, too
_LEAP = 3.0  # times the distance of the outlines, and
_SLACK_PX = 4.0  # more, is as far as a point may move after registration
_NEAR_PX = 1.0  # starts of the registration that lie nearer to each other are not compared
_LEAST_GAP = 1e-6  # of the mean gap between neighbouring points, so that order is strict


@dataclass(frozen=True, eq=False)
class TrackedBoundary:
    """Tracked points on the outline of one frame.

    Point i has the angle `point_angles(N)[i]` on the disk in every frame.

    Attributes
    ----------
    frame : int
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
    matched_s : ndarray of shape (2, M) and dtype float, or None
        Distances along the contour of the frame before and along this one that the step between them
        matched, evenly spaced on the former; None where they are those of the tracked points.
    """

    frame: int
    contour: Contour
    s: FloatArray
    transform: RigidTransform = IDENTITY
    alignment: RigidTransform = IDENTITY
    residual_px: float = 0.0
    order_violations: int = 0
    restarted: str = ""
    matched_s: FloatArray | None = None

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


def point_angles(n: int) -> FloatArray:
    """Angle on the disk of each of n tracked points, in radians."""
    return np.asarray(2.0 * np.pi * (np.arange(n) + 0.5) / n)


def first_boundary(frame: int, contour: Contour, angles: FloatArray) -> TrackedBoundary:
    """Points to be tracked, at even angles of the first frame.

    Parameters
    ----------
    frame : int
    contour : Contour
    angles : ndarray of shape (B,) and dtype float
        Angle of each outline point on the disk, in radians, strictly increasing within one turn.

    Returns
    -------
    TrackedBoundary
        About one point a pixel, 256 at least.
    """
    return TrackedBoundary(
        frame, contour, _at_even_angles(contour, angles, max(_LEAST_POINTS, round(contour.length)))
    )


def follow(
    frame: int,
    contour: Contour,
    last: TrackedBoundary,
    reference: TrackedBoundary,
    settings: TrackingSettings,
    *,
    in_lab: bool = False,
    stiff: bool = False,
) -> TrackedBoundary:
    """Carry tracked points to the next frame.

    Parameters
    ----------
    frame : int
        Number of this frame.
    contour : Contour
        This frame's, in the image's frame.
    last : TrackedBoundary
        Boundary of the last frame that had one.
    reference : TrackedBoundary
        Boundary of the frame that registration refers to.
    settings : TrackingSettings
    in_lab : bool
        Match the outlines as they lie in the image, not as registered: points move as little as they can.
    stiff : bool
        The outline of a body that hardly changes its shape, such as a nucleus: it may turn by more.

    Returns
    -------
    TrackedBoundary
        With as many points as the last; if the outlines hardly overlap even after registration, points move
        much farther than the outlines are apart, or do not go once around, tracking starts anew and says why.
    """
    here = last.transform.of(last.contour)
    smoothness = settings.smoothness_px2
    rough = _rough_transform(contour, here, last) if settings.registration else IDENTITY
    grid = even_grid(here)
    guess_on_grid = first_guess(here, rough.of(contour), grid, smoothness)
    guess = carry(last.s, grid, guess_on_grid, here.length, contour.length)
    transform = alignment = rough
    if settings.registration:
        fixed = reference.transform.of(reference.contour)
        registration = register(contour, fixed, rough, reference.s, guess, smoothness, stiff)
        transform = alignment = registration.transform
    if settings.registration and not stiff:
        transform = _seen_from_last(
            registration.transform, contour, last, reference, rough, guess, smoothness
        )
        moved = reference.alignment.after(reference.transform.undone())
        found = moved.after(transform)
        alignment = believable(last.alignment, found, contour, moved.of(fixed), registration, smoothness)
    placed = transform.of(contour)
    if least_overlap(here, placed, grid, guess_on_grid) < _LEAST_OVERLAP:
        shared = overlap(here, placed)
        if shared < _LEAST_OVERLAP:
            why = f"outlines overlap by {shared:.0%} only (frames {last.frame} and {frame})"
            return _restart(frame, contour, transform, last, why)
    if settings.tracker == "demons":
        return _follow_demons(frame, contour, last, transform, settings.demons or DemonsParameters())
    if in_lab:
        last, alignment = replace(last, alignment=IDENTITY), IDENTITY
        guess_on_grid = first_guess(last.contour, contour, grid, smoothness)
    return _follow_matching(frame, contour, last, transform, alignment, guess_on_grid, settings)


def _rough_transform(contour: Contour, here: Contour, last: TrackedBoundary) -> RigidTransform:
    """Either the centroid stays where it was, or the cell: what makes the outlines overlap more.

    A thin cell that draws in an arm has its centroid elsewhere, and is where it was.
    """
    moved, stayed = first_transform(contour, here, last.transform.angle), last.transform
    if np.linalg.norm(moved.shift - stayed.shift) < _NEAR_PX:
        return moved
    return max(moved, stayed, key=lambda transform: overlap(here, transform.of(contour)))


def _follow_matching(
    frame: int,
    contour: Contour,
    last: TrackedBoundary,
    transform: RigidTransform,
    alignment: RigidTransform,
    guess_on_grid: FloatArray,
    settings: TrackingSettings,
) -> TrackedBoundary:
    here, there = last.alignment.of(last.contour), alignment.of(contour)
    grid, smoothness = even_grid(here), settings.smoothness_px2
    matched = match(here, there, grid, guess_on_grid, smoothness)
    steps = np.linalg.norm(there.at(matched) - here.at(grid), axis=1)
    farthest = float(steps.max())
    bound = _SLACK_PX
    if farthest > bound:  # mostly the outlines are so far apart there, too
        bound += _LEAP * corner_distance(here, there, float(grid[steps.argmax()]))
    if farthest > bound:
        bound = _SLACK_PX + _LEAP * outline_distance(here, there)
    if farthest > bound:
        frames = f"frames {last.frame} and {frame}"
        why = f"points would move {farthest:.0f} px, outlines allow {bound:.0f} ({frames})"
        return _restart(frame, contour, transform, last, why)
    s = carry(last.s, grid, matched, here.length, there.length)
    back = match(there, here, s, last.s, smoothness)
    residual = float(np.linalg.norm(here.at(back) - here.at(last.s), axis=1).mean())
    even = _towards_even(s, there.length, settings.tension)
    both = np.stack([grid, matched])
    return TrackedBoundary(frame, contour, even, transform, alignment, residual, matched_s=both)


def _seen_from_last(
    found: RigidTransform,
    contour: Contour,
    last: TrackedBoundary,
    reference: TrackedBoundary,
    rough: RigidTransform,
    guess: FloatArray,
    smoothness: float,
) -> RigidTransform:
    """Registration to the reference, in which a large turn must be seen from the last frame, too.

    Several frames after the reference, the lobes of a cell may have grown and shrunk into the same shape,
    turned; from frame to frame they did not turn.
    """
    if reference is last or abs(found.angle - rough.angle) <= _USUAL_TURN:
        return found
    to_last = last.transform.of(last.contour)
    since_last = register(contour, to_last, rough, last.s, guess, smoothness).transform
    allowed = abs(since_last.angle - rough.angle) + _USUAL_TURN
    return found if abs(found.angle - since_last.angle) <= allowed else since_last


def _follow_demons(
    frame: int,
    contour: Contour,
    last: TrackedBoundary,
    transform: RigidTransform,
    parameters: DemonsParameters,
) -> TrackedBoundary:
    here, there = last.transform.of(last.contour), transform.of(contour)
    try:
        points = propagate(here, there, here.at(last.s), parameters)
    except ParameterError as fault:  # of a cell of a few pixels; the movie goes on
        return _restart(frame, contour, transform, last, f"demons cannot follow the outline: {fault}")
    edge, share = nearest_on_outline(points, there.points_yx)
    s = there.arc[edge] + share * (there.arc[edge + 1] - there.arc[edge])
    residual = float(np.linalg.norm(there.at(s) - points, axis=1).mean())
    steps = np.mod(np.diff(s, append=s[:1]) + 0.5 * there.length, there.length) - 0.5 * there.length
    if abs(steps.sum() - there.length) > 1e-6 * there.length:
        why = f"demons points do not go once around the outline (frames {last.frame} and {frame})"
        return _restart(frame, contour, transform, last, why)
    ordered = np.maximum(steps, _LEAST_GAP * there.length / len(s))
    ordered *= there.length / ordered.sum()
    placed = s[0] + np.concatenate([[0.0], np.cumsum(ordered)[:-1]])
    violations = int((steps <= 0).sum())
    return TrackedBoundary(frame, contour, placed, transform, transform, residual, violations)


def _restart(
    frame: int, contour: Contour, transform: RigidTransform, last: TrackedBoundary, why: str
) -> TrackedBoundary:
    """Points anew, with the disk turned to the cell as it was in the last frame."""
    angles = boundary_angles(transform(contour.outline_yx))
    before = last.transform(last.points_yx)
    away = before - before.mean(axis=0)
    lead = point_angles(len(last.s)) - np.arctan2(away[:, 0], away[:, 1])
    angles = angles + float(np.angle(np.exp(1j * lead).sum()))
    s = _at_even_angles(contour, angles, len(last.s))
    return TrackedBoundary(frame, contour, s, transform, transform, restarted=why)


def _at_even_angles(contour: Contour, angles: FloatArray, n: int) -> FloatArray:
    return carry(point_angles(n), angles, contour.arc[:-1], 2.0 * np.pi, contour.length)


def _towards_even(s: FloatArray, length: float, tension: float) -> FloatArray:
    even = length * np.arange(len(s)) / len(s)
    return np.asarray(s + tension * (even + (s - even).mean() - s))
