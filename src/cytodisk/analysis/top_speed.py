"""The speed that an edge reaches: ends of colours, and the unit to show velocities in."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray

_VELOCITY_PERCENTILES, _MOST_OVER_USUAL = (75.0, 99.0), 3.0


def top_speed(velocity: FloatArray) -> float:
    """Speed at the ends of the colours of a velocity map.

    Parameters
    ----------
    velocity : ndarray of dtype float

    Returns
    -------
    float
        Percentile 99 of the speeds, at most three times percentile 75; 1 if nothing moves.
    """
    speed = np.abs(velocity[np.isfinite(velocity)])
    if not speed.size:
        return 1.0
    usual, fast = np.percentile(speed, _VELOCITY_PERCENTILES).tolist()
    return min(fast, _MOST_OVER_USUAL * usual) or fast or float(speed.max()) or 1.0
