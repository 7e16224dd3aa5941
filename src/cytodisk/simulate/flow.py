"""Flow of a simulated cell: smooth velocities that carry its edge and everything inside it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.distance import cdist

from cytodisk.arrays import FloatArray
from cytodisk.simulate.fluctuation import NO_FLUCTUATION, Fluctuation

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
    """Velocity of every point of the plane at every time, in the frame of the cell: heading +x, centre 0.

    The points that a flow carries start with the place of each push.

    Attributes
    ----------
    radius : float
        Size of the cell, in pixels.
    push : Swing
        Height of each protrusion, in pixels: a Gaussian around its place, which moves with the material.
    push_width, push_angle : ndarray of shape (K,) and dtype float
        Standard deviation in pixels; direction, in radians.
    ruffles : Ruffles
    fluctuation : Fluctuation
    growth : float
        Outward speed, in pixels per frame.

    Notes
    -----
    A push moves points along one direction, by a speed that depends only on where they are from its place.
    So the path forth is the path back: alone it returns exactly, and overlapping ones return nearly. A
    fluctuation moves points along their ray from the centre, which neither turns nor crosses another: there
    all of its pushes together return exactly, and a cell that every ray leaves once stays one.
    """

    radius: float
    push: Swing = NOTHING
    push_width: FloatArray = field(default_factory=no_numbers)
    push_angle: FloatArray = field(default_factory=no_numbers)
    ruffles: Ruffles = NO_RUFFLES
    fluctuation: Fluctuation = NO_FLUCTUATION
    growth: float = 0.0

    @property
    def moves(self) -> bool:
        """Whether there is any motion in the frame of the cell."""
        return bool(self.push.low.size or self._moves_radially)

    @property
    def _moves_radially(self) -> bool:
        return bool(self.growth or self.ruffles.waves.size or self.fluctuation.angle.size)

    def shape_at_start(self, points_yx: FloatArray) -> FloatArray:
        """Points after the pushes have risen to their levels at frame 0.

        Parameters
        ----------
        points_yx : ndarray of shape (K + N, 2) and dtype float
            The places, then the cell's points, before any push.

        Returns
        -------
        ndarray of shape (K + N, 2) and dtype float
        """
        level = self.push.level(0.0) / 10.0
        height = self.fluctuation.level(0.0) / 10.0

        def rise(points: FloatArray, _: float) -> FloatArray:
            pushed = self._pushed(points, level)
            if not height.size:
                return pushed
            return pushed + self._radial(points, lambda angle: self.fluctuation(angle, height))

        for step in range(10):
            points_yx = _runge_kutta(rise, points_yx, step, 1.0)
        return points_yx

    def carry(self, points_yx: FloatArray, start: float, stop: float) -> FloatArray:
        """Where the flow takes points in one frame or less, forwards or backwards.

        Parameters
        ----------
        points_yx : ndarray of shape (K + N, 2) and dtype float
            The places at `start`, then any points, (row, column) in pixels from the cell's centre.
        start, stop : float
            Times in frames.

        Returns
        -------
        ndarray of shape (K + N, 2) and dtype float
        """
        if not self.moves:
            return points_yx
        step = (stop - start) / _STEPS_PER_FRAME
        for k in range(_STEPS_PER_FRAME):
            points_yx = _runge_kutta(self._velocity, points_yx, start + k * step, step)
        return points_yx

    def _velocity(self, points_yx: FloatArray, frame: float) -> FloatArray:
        velocity = self._pushed(points_yx, self.push.rate(frame))
        if not self._moves_radially:
            return velocity
        return velocity + self._radial(points_yx, lambda angle: self._outward_speed(angle, frame))

    def _outward_speed(self, angle: FloatArray, frame: float) -> FloatArray:
        speed = self.growth + self.ruffles(angle, frame)
        if self.fluctuation.angle.size:
            speed = speed + self.fluctuation(angle, self.fluctuation.rate(frame))
        return speed

    def _pushed(self, points_yx: FloatArray, rate: FloatArray) -> FloatArray:
        """Velocity for a speed of each push."""
        if not rate.size:
            return np.zeros_like(points_yx)
        square = cdist(points_yx, points_yx[: rate.size], "sqeuclidean")
        direction = np.column_stack([np.sin(self.push_angle), np.cos(self.push_angle)])
        return np.asarray(np.exp(-0.5 * square / self.push_width**2) @ (rate[:, None] * direction))

    def _radial(self, points_yx: FloatArray, speed_at: Callable[[FloatArray], FloatArray]) -> FloatArray:
        """Velocity for an outward speed by angle, faded out at the centre, where outward has no direction."""
        distance = np.hypot(points_yx[:, 0], points_yx[:, 1])
        share = np.minimum(distance / (_CALM * self.radius), 1.0)
        fade = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
        angle = np.arctan2(points_yx[:, 0], points_yx[:, 1])
        speed = fade * speed_at(angle) / np.maximum(distance, 1e-9)
        return np.asarray(speed[:, None] * points_yx)


def _runge_kutta(
    velocity: Callable[[FloatArray, float], FloatArray], points: FloatArray, time: float, step: float
) -> FloatArray:
    """One step of the classical scheme of fourth order."""
    first = velocity(points, time)
    second = velocity(points + 0.5 * step * first, time + 0.5 * step)
    third = velocity(points + 0.5 * step * second, time + 0.5 * step)
    fourth = velocity(points + step * third, time + step)
    return points + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth)
