"""Edges that grow where new matter is put in: a filopodium and a lamellipodium, both in closed form."""

from dataclasses import dataclass

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.simulate.resting_shapes import ANGLE, polar

FILOPODIUM_WIDTH = 5.0  # px
_EVEN_FRAME = 15  # of a filopodium: in frame 0 its sides are too short to hold points
_ROUNDING = 1e-6  # px
_LAMELLIPODIUM_WIDTH = 0.5  # radians, one standard deviation


@dataclass(frozen=True, eq=False)
class Filopodium:
    """A straight protrusion 5 px wide with a round tip that grows out of a disk towards +x.

    Attributes
    ----------
    radius : float
        Of the disk, in pixels.
    speed : float
        Of the tip, in pixels per frame.
    even_frame : int
        Frame in which the boundary points are evenly spaced.

    Notes
    -----
    Points of the disk stand, the tip moves as a whole, and what lies between them stretches along x. Before
    frame 0 nothing moves. Then only the front half of the round tip stands out of the disk.
    """

    radius: float
    speed: float
    even_frame: int = _EVEN_FRAME

    @property
    def outline_yx(self) -> FloatArray:
        """Edge at frame 0 from +x towards +y, a point at each corner; shape (N, 2)."""
        tip = np.linspace(-0.5 * np.pi, 0.5 * np.pi, 129)
        corner = np.arcsin(0.5 * FILOPODIUM_WIDTH / self.radius)
        disk = np.linspace(corner, 2.0 * np.pi - corner, 2000)
        half = 0.5 * FILOPODIUM_WIDTH
        round_tip = np.column_stack([half * np.sin(tip), self.radius + half * np.cos(tip)])
        around = self.radius * np.column_stack([np.sin(disk), np.cos(disk)])
        return np.concatenate([round_tip[64:], around, round_tip[:64]])

    def carry(self, points_yx: FloatArray, start: float, stop: float) -> FloatArray:
        """Where matter is at a time; shape (N, 2), in pixels from the disk's centre."""
        across, along = points_yx.T
        base = np.sqrt(self.radius**2 - 0.25 * FILOPODIUM_WIDTH**2)
        before, after = (self.radius + self.speed * max(time, 0.0) - base for time in (start, stop))
        out = along - base
        moved = np.where(out < before, out * (after / before), out + after - before)
        inside = (np.abs(across) <= 0.5 * FILOPODIUM_WIDTH + _ROUNDING) & (out > 0.0)
        return np.column_stack([across, base + np.where(inside, moved, out)])

    carry_edge = carry


@dataclass(frozen=True, eq=False)
class Lamellipodium:
    """One side of a disk that grows while all inside stands still: new matter is put in at the edge.

    Attributes
    ----------
    radius : float
        Of the disk at frame 0, in pixels.
    speed : float
        Of the edge in the direction +x, in pixels per frame; it falls off as a Gaussian of the angle.
    even_frame : int
        Frame in which the boundary points are evenly spaced.

    Notes
    -----
    Boundary points move along their ray. They are the edge, not matter.
    """

    radius: float
    speed: float
    even_frame: int = 0

    @property
    def outline_yx(self) -> FloatArray:
        """Edge at frame 0 from +x towards +y, shape (N, 2)."""
        return self.radius * polar(np.ones_like(ANGLE))

    def carry(self, points_yx: FloatArray, start: float, stop: float) -> FloatArray:
        """Where matter is at a time: where it was."""
        return points_yx

    def carry_edge(self, points_yx: FloatArray, start: float, stop: float) -> FloatArray:
        """Where boundary points are at a time; shape (N, 2), in pixels from the disk's centre."""
        angle = np.arctan2(points_yx[:, 0], points_yx[:, 1])
        return np.asarray(points_yx * (self._reach(angle, stop) / self._reach(angle, start))[:, None])

    def _reach(self, angle: FloatArray, frame: float) -> FloatArray:
        side = np.exp(-0.5 * (angle / _LAMELLIPODIUM_WIDTH) ** 2)
        return np.asarray(self.radius + self.speed * max(frame, 0.0) * side)


Growth = Filopodium | Lamellipodium


def swept_velocity(boundary_yx: FloatArray) -> FloatArray:
    """Velocity of each piece of an edge: the signed area that it sweeps over the mean of its two lengths.

    Parameters
    ----------
    boundary_yx : ndarray of shape (T, N, 2) and dtype float
        Closed polygons of the same points, from +x towards +y, in pixels.

    Returns
    -------
    ndarray of shape (T, N) and dtype float
        Of the piece from each point to the next, in pixels per frame, outward positive; NaN in the last
        frame. Velocities times mean lengths sum to the change of area exactly.
    """
    ahead = np.roll(boundary_yx, -1, axis=1)
    one, other = ahead[1:] - boundary_yx[:-1], boundary_yx[1:] - ahead[:-1]
    area = 0.5 * (one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0])
    length = np.stack([edge_lengths(outline) for outline in boundary_yx])
    mean = np.maximum(0.5 * (length[:-1] + length[1:]), 1e-12)
    return np.concatenate([area / mean, np.full((1, boundary_yx.shape[1]), np.nan)])
