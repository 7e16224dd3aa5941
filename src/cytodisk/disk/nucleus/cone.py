"""The nucleus' polygon in its own unit disk ↔ the round disk, ray by ray: Numba kernels.

The polygon has its corners on the circle at given angles. A point at a share s of the way from the centre to
the point at fraction t of the side from corner i to corner i + 1 goes to radius s and to the angle
θ_i + t (θ_{i+1} - θ_i). So along the outline the angle is linear from vertex to vertex, as it is in the
cytoplasm.
"""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray

TURN = 2.0 * math.pi
STEPS_A_TURN = 2.0**50
"""Turns are whole numbers of such steps, so that adding up to `MOST_LIFT` whole turns is exact."""
MOST_LIFT = 7


@njit(cache=True)
def _side_at(angle: float, angles: FloatArray) -> tuple[int, float, float]:
    """Number of the side that holds a direction, and the angles of its ends."""
    angle = angles[0] + (angle - angles[0]) % TURN
    found = int(np.searchsorted(angles, angle, side="right")) - 1
    side = min(max(found, 0), len(angles) - 1)
    end = angles[side + 1] if side < len(angles) - 1 else angles[0] + TURN
    return side, angles[side], end


@njit(cache=True, error_model="numpy")
def rounded(points_uv: FloatArray, angles: FloatArray) -> FloatArray:
    """Points of the polygon on the round disk, (u, v), shape (N, 2); NaN stays NaN.

    Parameters
    ----------
    points_uv : ndarray of shape (N, 2) and dtype float
        In the polygon.
    angles : ndarray of shape (B,) and dtype float
        Of its corners in radians, strictly increasing within one turn, each gap less than half a turn.
    """
    out = np.empty((len(points_uv), 2))
    for n in range(len(points_uv)):
        u, v = points_uv[n, 0], points_uv[n, 1]
        if math.isnan(u) or math.isnan(v):
            out[n, 0] = out[n, 1] = math.nan
            continue
        _, start, end = _side_at(math.atan2(v, u), angles)
        from_start = math.cos(start) * v - math.sin(start) * u
        to_end = math.sin(end) * u - math.cos(end) * v
        total = from_start + to_end
        fraction = min(max(from_start / total, 0.0), 1.0) if total > 0.0 else 0.0
        share = min(total / math.sin(end - start), 1.0)
        angle = start + fraction * (end - start)
        out[n, 0], out[n, 1] = share * math.cos(angle), share * math.sin(angle)
    return out


@njit(cache=True)
def to_polygon(radii: FloatArray, turns: FloatArray, angles: FloatArray) -> FloatArray:
    """The inverse of `rounded` for points at radii, 0 to 1, and angles `turns` in radians, shape (N, 2)."""
    out = np.empty((len(radii), 2))
    for n in range(len(radii)):
        _, start, end = _side_at(turns[n], angles)
        fraction = min(max((turns[n] - start) % TURN / (end - start), 0.0), 1.0)
        if (turns[n] - start) % TURN > TURN - 1e-9:  # rounding puts it just before the side
            fraction = 0.0
        out[n, 0] = radii[n] * ((1.0 - fraction) * math.cos(start) + fraction * math.cos(end))
        out[n, 1] = radii[n] * ((1.0 - fraction) * math.sin(start) + fraction * math.sin(end))
    return out
