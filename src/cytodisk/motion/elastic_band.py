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
_STILL_PX2 = 1e-5  # mean over the points; 4000 times less than what the pixels of a mask make of nothing
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
    by_angle : ndarray of shape (N, 2) and dtype float
        Derivative of d by the angle of the rigid motion; that by its shift is -1.
    """

    d: FloatArray
    gaps: FloatArray
    tangent: FloatArray
    by_angle: FloatArray


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
    reach = math.sqrt(_sum_of_squares(points) / n)
    band = _new_band(n)
    d, gaps = band.d, band.gaps
    _displace(points, target, places, motion, band)
    value = _energy(d, gaps, spacing, stiffness, doubt, motion)
    for _ in range(_ROUNDS):
        change, moved = _newton_step(band, spacing, stiffness, rigid, doubt, motion)
        longest = max(reach * abs(moved[0]), abs(moved[1]), abs(moved[2]))
        for i in range(n):
            longest = max(longest, abs(change[i]))
        scale = min(1.0, _LONGEST_STEP_PX / max(longest, 1e-12))
        for i in range(n):
            shrinking = change[i] - change[(i + 1) % n]
            if shrinking > _MOST_SHRINKING * gaps[i]:
                scale = min(scale, _MOST_SHRINKING * gaps[i] / shrinking)
        for _ in range(_HALVINGS):
            new_places, new_motion = _moved_on(places, scale, change), _moved_on(motion, scale, moved)
            _displace(points, target, new_places, new_motion, band)
            new_value = _energy(d, gaps, spacing, stiffness, doubt, new_motion)
            if new_value <= value:
                break
            scale *= 0.5
        if not new_value <= value:  # the polygon's corners leave no descent: this is as far as it goes
            _displace(points, target, places, motion, band)
            break
        gained = (value - new_value) / (spacing * n)
        places, motion, value = new_places, new_motion, new_value
        if scale * longest < _STILL_PX or gained < _STILL_PX2:
            break
    return places, motion, _sum_of_squares(d) / n


# Loops where NumPy has a word: array expressions and its linear algebra take seconds to compile.
@njit(cache=True)
def _new_band(n: int) -> _Band:
    return _Band(np.empty((n, 2)), np.empty(n), np.empty((n, 2)), np.empty((n, 2)))


@njit(cache=True)
def _sum_of_squares(points: FloatArray) -> float:
    total = 0.0
    for i in range(points.shape[0]):
        total += points[i, 0] ** 2 + points[i, 1] ** 2
    return total


@njit(cache=True)
def _moved_on(start: FloatArray, scale: float, step: FloatArray) -> FloatArray:
    end = np.empty(start.shape[0])
    for i in range(start.shape[0]):
        end[i] = start[i] + scale * step[i]
    return end


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
    band = _new_band(n)
    _displace(points, target, places, motion, band)
    d, by_angle = band.d, band.by_angle
    slope = 0.0
    for i in range(n):
        after = i + 1 if i < n - 1 else 0
        for k in range(2):
            step = by_angle[after, k] - by_angle[i, k]
            slope += 2.0 * spacing * by_angle[i, k] * d[i, k]
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
    d, gaps, tangent, by_angle = band
    cosine, sine = math.cos(motion[0]), math.sin(motion[0])
    total, edges = arc[-1], corners.shape[0]
    n = points.shape[0]
    turn = math.floor(places[0] / total) * total  # where the turn starts that the point is in
    edge = 0
    for i in range(n):
        gaps[i] = places[i + 1] - places[i] if i < n - 1 else places[0] - places[i] + total
        wrapped = places[i] - turn
        if wrapped >= total:
            turn += total
            wrapped -= total
        if wrapped < arc[edge]:  # around the start
            edge = 0
        while edge < edges - 1 and arc[edge + 1] <= wrapped:
            edge += 1
        into, after = wrapped - arc[edge], edge + 1 if edge < edges - 1 else 0
        part = 1.0 / (arc[edge + 1] - arc[edge])
        tangent[i, 0] = part * (corners[after, 0] - corners[edge, 0])
        tangent[i, 1] = part * (corners[after, 1] - corners[edge, 1])
        y = cosine * points[i, 0] + sine * points[i, 1]
        x = cosine * points[i, 1] - sine * points[i, 0]
        by_angle[i, 0], by_angle[i, 1] = -x, y
        d[i, 0] = corners[edge, 0] + into * tangent[i, 0] - y - motion[1]
        d[i, 1] = corners[edge, 1] + into * tangent[i, 1] - x - motion[2]


@njit(cache=True)
def _newton_step(
    band: _Band, weight: float, stiffness: float, rigid: bool, doubt: float, motion: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Change of places and of the rigid motion; places are eliminated first, three unknowns are left."""
    d, gaps, tangent, by_angle = band
    n = d.shape[0]
    spring = _SPRING * stiffness
    diagonal, coupling, right = np.empty(n), np.empty(n), np.empty((n, 4 if rigid else 1))
    for i in range(n):
        after, before = i + 1 if i < n - 1 else 0, i - 1
        diagonal[i] = weight + 2.0 * (stiffness + spring)
        t0, t1 = tangent[i, 0], tangent[i, 1]
        coupling[i] = -stiffness * (t0 * tangent[after, 0] + t1 * tangent[after, 1]) - spring
        bend0, bend1 = 2.0 * d[i, 0] - d[before, 0] - d[after, 0], 2.0 * d[i, 1] - d[before, 1] - d[after, 1]
        uphill = t0 * (weight * d[i, 0] + stiffness * bend0) + t1 * (weight * d[i, 1] + stiffness * bend1)
        right[i, 0] = spring * (gaps[i] - gaps[before]) - uphill
        if rigid:
            bend0 = 2.0 * by_angle[i, 0] - by_angle[before, 0] - by_angle[after, 0]
            bend1 = 2.0 * by_angle[i, 1] - by_angle[before, 1] - by_angle[after, 1]
            right[i, 1] = t0 * (weight * by_angle[i, 0] + stiffness * bend0)
            right[i, 1] += t1 * (weight * by_angle[i, 1] + stiffness * bend1)
            right[i, 2], right[i, 3] = -weight * t0, -weight * t1
    solved = solve_cyclic(diagonal, coupling, right)
    change, moved = np.empty(n), np.zeros(3)
    if rigid:
        square, pull = _motion_terms(band, weight, stiffness, doubt, motion)
        for i in range(n):
            for a in range(3):
                pull[a] += right[i, 1 + a] * solved[i, 0]
                for b in range(3):
                    square[a, b] -= right[i, 1 + a] * solved[i, 1 + b]
        _solve_three(square, pull, moved)
    for i in range(n):
        change[i] = solved[i, 0]
        if rigid:
            change[i] -= solved[i, 1] * moved[0] + solved[i, 2] * moved[1] + solved[i, 3] * moved[2]
    return change, moved


@njit(cache=True)
def _solve_three(square: FloatArray, pull: FloatArray, moved: FloatArray) -> None:
    """Solve square · moved = −pull; the matrix is symmetric positive definite and is lost."""
    for a in range(3):
        moved[a] = -pull[a]
        for b in range(a):
            factor = square[a, b] / square[b, b]
            for c in range(b + 1, 3):
                square[a, c] -= factor * square[b, c]
            moved[a] -= factor * moved[b]
    for a in range(2, -1, -1):
        for b in range(a + 1, 3):
            moved[a] -= square[a, b] * moved[b]
        moved[a] /= square[a, a]


@njit(cache=True)
def _motion_terms(
    band: _Band, weight: float, stiffness: float, doubt: float, motion: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """What the rigid motion alone adds to the normal equations: their matrix, and the energy's slope."""
    d, _, _, by_angle = band
    n = d.shape[0]
    square, pull = np.zeros((3, 3)), np.zeros(3)
    square[0, 0], pull[0] = doubt, doubt * motion[0]
    square[1, 1] = square[2, 2] = weight * n
    for i in range(n):
        after = i + 1 if i < n - 1 else 0
        for k in range(2):
            step, ahead = by_angle[after, k] - by_angle[i, k], d[after, k] - d[i, k]
            square[0, 0] += weight * by_angle[i, k] ** 2 + stiffness * step**2
            square[0, 1 + k] -= weight * by_angle[i, k]
            pull[0] += weight * by_angle[i, k] * d[i, k] + stiffness * step * ahead
            pull[1 + k] -= weight * d[i, k]
    square[1, 0], square[2, 0] = square[0, 1], square[0, 2]
    return square, pull
