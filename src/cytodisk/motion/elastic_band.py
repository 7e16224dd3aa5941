"""Gauss-Newton relaxation of an elastic band: points of one closed curve slide along another."""

import math
from typing import NamedTuple

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray
from cytodisk.motion.cyclic_system import solve_cyclic

_SPRING = 1.0  # weight of even stretch against even displacement
_ROUNDS = 40
_HALVINGS = 12
_STILL_PX = 1e-3
_LONGEST_STEP_PX = 3.0
_MOST_SHRINKING = 0.8  # of the gap between neighbours in one round, so that order is kept


class Target(NamedTuple):
    """The curve along which points slide.

    Attributes
    ----------
    corners : ndarray of shape (B, 2) and dtype float
        Closed polygon.
    arc : ndarray of shape (B + 1,) and dtype float
        Distance along it.
    """

    corners: FloatArray
    arc: FloatArray


class _Band(NamedTuple):
    """What the places of the points give.

    Attributes
    ----------
    d : ndarray of shape (N, 2) and dtype float
        Displacements.
    gaps : ndarray of shape (N,) and dtype float
        From each place to the next, along the target.
    tangent : ndarray of shape (N, 2) and dtype float
        Derivative of d by the place.
    by_motion : ndarray of shape (N, 2, 3) and dtype float
        Derivative of d by the rigid motion.
    """

    d: FloatArray
    gaps: FloatArray
    tangent: FloatArray
    by_motion: FloatArray


@njit(cache=True)
def relax_band(
    points: FloatArray,
    target: Target,
    places: FloatArray,
    spacing: float,
    smoothness: float,
    motion: FloatArray,
    rigid: bool,
    doubt: float,
) -> tuple[FloatArray, FloatArray, float]:
    """Minimise Σ spacing |d|² + smoothness (|Δd|² + Δσ²) / spacing over the points' places σ on the target.

    Parameters
    ----------
    points : ndarray of shape (N, 2) and dtype float
        Evenly spaced along a closed curve; d is the displacement from a point, after the rigid motion, to
        its place.
    target : Target
    places : ndarray of shape (N,) and dtype float
        Start: distance of each point's place along the target, strictly increasing through one turn.
    spacing : float
        Distance of neighbouring points.
    smoothness : float
    motion : ndarray of shape (3,) and dtype float
        Angle and shift (y, x) of the rigid motion.
    rigid : bool
        Free the rigid motion; otherwise it stays.
    doubt : float
        Weight of the square of the angle, when it is free.

    Returns
    -------
    places : ndarray of shape (N,) and dtype float
        Strictly increasing through one turn.
    motion : ndarray of shape (3,) and dtype float
    left_over : float
        Mean |d|².
    """
    n = points.shape[0]
    stiffness = smoothness / spacing
    reach = math.sqrt((points**2).sum() / n)
    places, motion = places.copy(), motion.copy()
    band = _Band(np.empty((n, 2)), np.empty(n), np.empty((n, 2)), np.zeros((n, 2, 3)))
    d, gaps = band.d, band.gaps
    band.by_motion[:, 0, 1] = -1.0
    band.by_motion[:, 1, 2] = -1.0
    _displace(points, target, places, motion, band)
    value = _energy(d, gaps, spacing, stiffness, doubt, motion)
    for _ in range(_ROUNDS):
        change, moved = _newton_step(band, spacing, stiffness, rigid, doubt, motion)
        longest = max(np.abs(change).max(), reach * abs(moved[0]), abs(moved[1]), abs(moved[2]))
        scale = min(1.0, _LONGEST_STEP_PX / max(longest, 1e-12))
        for i in range(n):
            shrinking = change[i] - change[(i + 1) % n]
            if shrinking > _MOST_SHRINKING * gaps[i]:
                scale = min(scale, _MOST_SHRINKING * gaps[i] / shrinking)
        for _ in range(_HALVINGS):
            new_places, new_motion = places + scale * change, motion + scale * moved
            _displace(points, target, new_places, new_motion, band)
            new_value = _energy(d, gaps, spacing, stiffness, doubt, new_motion)
            if new_value <= value:
                break
            scale *= 0.5
        if not new_value <= value:  # the polygon's corners leave no descent: this is as far as it goes
            _displace(points, target, places, motion, band)
            break
        places, motion, value = new_places, new_motion, new_value
        if scale * longest < _STILL_PX:
            break
    return places, motion, float((d**2).sum() / n)


@njit(cache=True)
def energy_and_slope(
    points: FloatArray,
    target: Target,
    places: FloatArray,
    spacing: float,
    smoothness: float,
    motion: FloatArray,
) -> tuple[float, float]:
    """Energy of a band, without doubt, and its derivative by the angle of the motion; see `relax_band`."""
    n = points.shape[0]
    stiffness = smoothness / spacing
    band = _Band(np.empty((n, 2)), np.empty(n), np.empty((n, 2)), np.zeros((n, 2, 3)))
    _displace(points, target, places, motion, band)
    d, by_motion = band.d, band.by_motion
    slope = 0.0
    for i in range(n):
        after = i + 1 if i < n - 1 else 0
        for k in range(2):
            step = by_motion[after, k, 0] - by_motion[i, k, 0]
            slope += 2.0 * spacing * by_motion[i, k, 0] * d[i, k]
            slope += 2.0 * stiffness * step * (d[after, k] - d[i, k])
    return _energy(d, band.gaps, spacing, stiffness, 0.0, motion), slope


@njit(cache=True)
def _energy(
    d: FloatArray, gaps: FloatArray, weight: float, stiffness: float, doubt: float, motion: FloatArray
) -> float:
    total = doubt * motion[0] ** 2
    for i in range(d.shape[0]):
        after = i + 1 if i < d.shape[0] - 1 else 0
        change = (d[after, 0] - d[i, 0]) ** 2 + (d[after, 1] - d[i, 1]) ** 2
        total += weight * (d[i, 0] ** 2 + d[i, 1] ** 2) + stiffness * (change + _SPRING * gaps[i] ** 2)
    return float(total)


@njit(cache=True)
def _displace(
    points: FloatArray, target: Target, places: FloatArray, motion: FloatArray, band: _Band
) -> None:
    """Fill in displacements, their derivatives by place (the tangent) and by the angle, and the gaps."""
    corners, arc = target
    d, gaps, tangent, by_motion = band
    cosine, sine = math.cos(motion[0]), math.sin(motion[0])
    total, edges = arc[-1], corners.shape[0]
    n = points.shape[0]
    edge = 0
    for i in range(n):
        gaps[i] = places[i + 1] - places[i] if i < n - 1 else places[0] - places[i] + total
        wrapped = places[i] % total
        if wrapped < arc[edge]:  # around the start
            edge = 0
        while edge < edges - 1 and arc[edge + 1] <= wrapped:
            edge += 1
        length = arc[edge + 1] - arc[edge]
        share = (wrapped - arc[edge]) / length
        y = cosine * points[i, 0] + sine * points[i, 1]
        x = cosine * points[i, 1] - sine * points[i, 0]
        by_motion[i, 0, 0], by_motion[i, 1, 0] = -x, y
        for k in range(2):
            side = corners[edge + 1 if edge < edges - 1 else 0, k] - corners[edge, k]
            tangent[i, k] = side / length
            d[i, k] = corners[edge, k] + share * side - (y if k == 0 else x) - motion[1 + k]


@njit(cache=True)
def _newton_step(
    band: _Band, weight: float, stiffness: float, rigid: bool, doubt: float, motion: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Change of places and of the rigid motion; places are eliminated first, three unknowns are left."""
    d, gaps, tangent, by_motion = band
    n = d.shape[0]
    spring = _SPRING * stiffness
    diagonal, coupling, right = np.empty(n), np.empty(n), np.zeros((n, 4))
    diagonal[:] = weight + 2.0 * (stiffness + spring)
    square, pull = np.zeros((3, 3)), np.zeros(3)
    square[0, 0], pull[0] = doubt, doubt * motion[0]
    for i in range(n):
        after, before = i + 1 if i < n - 1 else 0, i - 1
        alike = tangent[i, 0] * tangent[after, 0] + tangent[i, 1] * tangent[after, 1]
        coupling[i] = -stiffness * alike - spring
        right[i, 3] = spring * (gaps[i] - gaps[before])
        for k in range(2):
            ahead, behind = d[after, k] - d[i, k], d[i, k] - d[before, k]
            right[i, 3] -= tangent[i, k] * (weight * d[i, k] + stiffness * (behind - ahead))
            if not rigid:
                continue
            for a in range(3):
                step = by_motion[after, k, a] - by_motion[i, k, a]
                back = by_motion[i, k, a] - by_motion[before, k, a]
                right[i, a] += tangent[i, k] * (weight * by_motion[i, k, a] + stiffness * (back - step))
                pull[a] += weight * by_motion[i, k, a] * d[i, k] + stiffness * step * ahead
                for b in range(3):
                    square[a, b] += weight * by_motion[i, k, a] * by_motion[i, k, b]
                    square[a, b] += stiffness * step * (by_motion[after, k, b] - by_motion[i, k, b])
    solved = solve_cyclic(diagonal, coupling, right)
    change, moved = solved[:, 3].copy(), np.zeros(3)
    if rigid:
        across, response = np.ascontiguousarray(right[:, :3].T), np.ascontiguousarray(solved[:, :3])
        moved[:] = np.linalg.solve(square - across @ response, -pull - across @ change)
        for a in range(3):
            change -= response[:, a] * moved[a]
    return change, moved
