"""Energy of the steps between neighbours on the nuclear outline: Numba kernels.

It keeps their order, keeps each below half a turn, and draws the outline towards its own arc length where the
cytoplasm leaves a choice.
"""

import math

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.nucleus.cone import TURN


@njit(cache=True, error_model="numpy")
def loop_energy(angles: FloatArray, share: FloatArray, weight: float) -> float:
    """Energy of the steps of the nuclear outline; infinite if one is not below half a turn.

    Each counts its share of the outline times x + 1/x - 2, x the tangent of half its angle over that which
    goes with its share.
    """
    total = 0.0
    for n in range(len(angles)):
        step = (angles[(n + 1) % len(angles)] - angles[n]) % TURN
        if not 0.0 < step < 0.5 * TURN:
            return np.inf
        x = math.tan(0.5 * step) / math.tan(0.5 * TURN * share[n])
        total += share[n] * (x + 1.0 / x - 2.0)
    return weight * total


@njit(cache=True, error_model="numpy")
def add_loop(
    angles: FloatArray,
    share: FloatArray,
    weight: float,
    unknown: IntArray,
    pair: IntArray,
    diagonal: IntArray,
    blocks: FloatArray,
    right: FloatArray,
) -> None:
    """Add the steps to the system: `unknown` of the vertices, `pair` the block of the ends of each."""
    for n in range(len(angles)):
        m = (n + 1) % len(angles)
        step = (angles[m] - angles[n]) % TURN
        tangent, goal = math.tan(0.5 * step), math.tan(0.5 * TURN * share[n])
        x, by_angle = tangent / goal, 0.5 * (1.0 + tangent * tangent) / goal
        slope = weight * share[n] * (1.0 - 1.0 / (x * x)) * by_angle
        curvature = 0.5 * weight * share[n] * (x + 1.0) ** 2 / x**3 * by_angle**2
        i, j = unknown[n], unknown[m]
        right[i, 0] += slope
        right[j, 0] -= slope
        blocks[diagonal[i], 0, 0] += curvature
        blocks[diagonal[j], 0, 0] += curvature
        blocks[pair[n], 0, 0] -= curvature
