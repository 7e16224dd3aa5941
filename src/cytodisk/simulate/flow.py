"""Smooth flows of the plane that carry a simulated cell: its edge and everything inside it."""

from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.distance import cdist

from cytodisk.arrays import FloatArray

_STEPS_PER_FRAME = 3
_CALM = 0.3  # share of the cell's radius within which radial motion fades to nothing


@dataclass(frozen=True, eq=False)
class Swing:
    """Quantities that swing between two levels like a cosine, so that what they push comes back.

    Attributes
    ----------
    low, high : ndarray of shape (K,) and dtype float
        Levels; at phase 0 the first frame is at `low`.
    period : ndarray of shape (K,) and dtype float
        In frames.
    phase : ndarray of shape (K,) and dtype float
        In radians.
    """

    low: FloatArray
    high: FloatArray
    period: FloatArray
    phase: FloatArray

    def level(self, frame: float) -> FloatArray:
        """Levels at a time in frames, shape (K,)."""
        share = 0.5 - 0.5 * np.cos(2.0 * np.pi * frame / self.period + self.phase)
        return np.asarray(self.low + (self.high - self.low) * share)

    def rate(self, frame: float) -> FloatArray:
        """Change of the levels per frame, shape (K,)."""
        speed = np.pi / self.period * np.sin(2.0 * np.pi * frame / self.period + self.phase)
        return np.asarray((self.high - self.low) * speed)


def no_numbers() -> FloatArray:
    """An empty array."""
    return np.zeros(0)


NOTHING = Swing(*np.zeros((4, 0)))


@dataclass(frozen=True, eq=False)
class Ruffles:
    """Waves that travel around the edge and move it in and out.

    Attributes
    ----------
    waves : ndarray of shape (K,) and dtype float
        Whole number of waves around the cell.
    speed, period, phase : ndarray of shape (K,) and dtype float
        Largest radial speed in pixels per frame, frames per wave (negative: the other way round), radians.
    """

    waves: FloatArray
    speed: FloatArray
    period: FloatArray
    phase: FloatArray

    def __call__(self, angle: FloatArray, frame: float) -> FloatArray:
        """Radial speed at angles from the cell's heading, shape (N,)."""
        turn = np.outer(angle, self.waves) - 2.0 * np.pi * frame / self.period + self.phase
        return np.asarray(np.sin(turn) @ self.speed)


NO_RUFFLES = Ruffles(*np.zeros((4, 0)))


@dataclass(frozen=True, eq=False)
class Flow:
    """Velocity of every point of the plane at every time, made of a few smooth motions.

    The points that a flow carries start with its anchors: the cell's centre, then the place of each push.
    "Along" is the cell's heading, "across" is 90° from it, from +x towards +y.

    Attributes
    ----------
    radius : float
        Size of the cell, in pixels.
    heading : float
        At frame 0, in radians from +x towards +y.
    turn : float
        Of the heading and the whole cell, in radians per frame.
    speed : float
        Of the whole cell along its heading, in pixels per frame.
    push : Swing
        Height of each protrusion, in pixels: a Gaussian around its place, which moves with the material.
    push_width, push_angle : ndarray of shape (K,) and dtype float
        Standard deviation in pixels; direction from the heading, in radians.
    stretch : Swing of two
        Logarithms of the stretch along (and shortening across), and the same at 45°.
    bend : Swing of one
        Shift across of the two ends against the middle, in pixels.
    neck : Swing of one
        Logarithm of how much narrower the middle gets.
    neck_width : float
        Standard deviation of the neck along the cell, in pixels.
    ruffles : Ruffles
    growth : float
        Outward speed, in pixels per frame.

    Notes
    -----
    A single push moves points along one direction only and by a speed that depends on where they are from its
    place, so the path is the same forth and back: it returns exactly. Several at once return nearly.
    """

    radius: float
    heading: float = 0.0
    turn: float = 0.0
    speed: float = 0.0
    push: Swing = NOTHING
    push_width: FloatArray = field(default_factory=no_numbers)
    push_angle: FloatArray = field(default_factory=no_numbers)
    stretch: Swing = NOTHING
    bend: Swing = NOTHING
    neck: Swing = NOTHING
    neck_width: float = 1.0
    ruffles: Ruffles = NO_RUFFLES
    growth: float = 0.0

    def velocity(self, points_yx: FloatArray, frame: float) -> FloatArray:
        """Velocity of points at a time.

        Parameters
        ----------
        points_yx : ndarray of shape (1 + K + N, 2) and dtype float
            The anchors, then any points, (row, column) in pixels.
        frame : float
            Time in frames.

        Returns
        -------
        ndarray of shape (1 + K + N, 2) and dtype float
            In pixels per frame.
        """
        heading = self.heading + self.turn * frame
        away = points_yx - points_yx[0]
        velocity = self.turn * np.column_stack([away[:, 1], -away[:, 0]])
        velocity += self._radial(away, heading, frame)
        levels = (swing.rate(frame) for swing in (self.push, self.stretch, self.bend, self.neck))
        velocity += self._deform(points_yx, heading, *levels)
        velocity[0] = 0.0  # the centre is what the rest is measured from, not material
        return np.asarray(velocity + self.speed * _direction(heading))

    def shape_at_start(self, points_yx: FloatArray) -> FloatArray:
        """Points after the deformation that the swings have reached at frame 0.

        Parameters
        ----------
        points_yx : ndarray of shape (1 + K + N, 2) and dtype float
            The anchors, then the cell's points at level 0 of everything.

        Returns
        -------
        ndarray of shape (1 + K + N, 2) and dtype float
        """
        levels = [swing.level(0.0) for swing in (self.push, self.stretch, self.bend, self.neck)]
        steps = 30
        for _ in range(steps):
            middle = points_yx + 0.5 / steps * self._deform(points_yx, self.heading, *levels)
            points_yx = points_yx + self._deform(middle, self.heading, *levels) / steps
            points_yx[0] = 0.0
        return points_yx

    def carry(self, points_yx: FloatArray, start: float, stop: float) -> FloatArray:
        """Where the flow takes points in one frame or less, forwards or backwards (Runge-Kutta, 4th order).

        Parameters
        ----------
        points_yx : ndarray of shape (1 + K + N, 2) and dtype float
            The anchors at `start`, then any points.
        start, stop : float
            Times in frames.

        Returns
        -------
        ndarray of shape (1 + K + N, 2) and dtype float
        """
        step = (stop - start) / _STEPS_PER_FRAME
        for k in range(_STEPS_PER_FRAME):
            frame = start + k * step
            first = self.velocity(points_yx, frame)
            second = self.velocity(points_yx + 0.5 * step * first, frame + 0.5 * step)
            third = self.velocity(points_yx + 0.5 * step * second, frame + 0.5 * step)
            fourth = self.velocity(points_yx + step * third, frame + step)
            points_yx = points_yx + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
        return points_yx

    def _deform(
        self,
        points_yx: FloatArray,
        heading: float,
        push: FloatArray,
        stretch: FloatArray,
        bend: FloatArray,
        neck: FloatArray,
    ) -> FloatArray:
        """Velocity of the motions that change the shape, for a rate of each."""
        velocity = np.zeros_like(points_yx)
        ahead, aside = _direction(heading), _direction(heading + 0.5 * np.pi)
        away = points_yx - points_yx[0]
        along, across = away @ ahead, away @ aside
        if push.size:
            square = cdist(points_yx, points_yx[1 : 1 + push.size], "sqeuclidean")
            weight = np.exp(-0.5 * square / self.push_width**2)
            velocity += weight @ (push[:, None] * _direction(heading + self.push_angle))
        if stretch.size:
            velocity += np.outer(stretch[0] * along + stretch[1] * across, ahead)
            velocity += np.outer(stretch[1] * along - stretch[0] * across, aside)
        if bend.size:
            velocity += np.outer(bend[0] * ((along / self.radius) ** 2 - 0.25), aside)
        if neck.size:
            velocity -= np.outer(neck[0] * across * np.exp(-0.5 * (along / self.neck_width) ** 2), aside)
        return velocity

    def _radial(self, away: FloatArray, heading: float, frame: float) -> FloatArray:
        """Growth and ruffles, faded out at the centre, where outward has no direction."""
        if not (self.growth or self.ruffles.waves.size):
            return np.zeros_like(away)
        distance = np.hypot(away[:, 0], away[:, 1])
        angle = np.arctan2(away[:, 0], away[:, 1]) - heading
        share = np.minimum(distance / (_CALM * self.radius), 1.0)
        fade = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        speed = fade * (self.growth + self.ruffles(angle, frame)) / np.maximum(distance, 1e-9)
        return np.asarray(speed[:, None] * away)


def _direction(angle: float | FloatArray) -> FloatArray:
    """Unit vector or vectors (y, x) at an angle from +x towards +y."""
    return np.stack([np.sin(angle), np.cos(angle)], axis=-1)
