"""Angles of the nuclear outline: whole turns, gaps, and means along it."""

from __future__ import annotations

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.nucleus.cone import TURN
from cytodisk.geometry.nucleus_mesh import NucleusMesh

LARGEST_GAP = 0.4 * TURN
"""Largest angle between neighbours on the nuclear outline: from half a turn on, its polygon in the disk would
leave out the centre.
"""

_MOST_TWIST = 0.75 * TURN
SMALLEST_GAP = 1e-9
"""Smallest angle between them: in a narrow bay of the nucleus, free angles are one in double precision."""

_BLENDS = np.linspace(0.0, 1.0, 33)  # with angles by arc length


def wound_like(angle: float, before: float) -> float:
    """An angle with the whole turns that bring it near another; less than three quarters of a turn."""
    near = angle - TURN * round((angle - before) / TURN)
    return near - np.copysign(TURN, near) if abs(near) >= _MOST_TWIST else near


def well_spaced(mesh: NucleusMesh, angles: FloatArray) -> FloatArray:
    """Angles on the nuclear outline, towards those by arc length until no gap is too wide or too narrow."""
    even = _by_length(mesh, angles)
    blends = ((1.0 - blend) * angles + blend * even for blend in _BLENDS)
    return next((blend for blend in blends if is_well_spaced(blend)), even)


def is_well_spaced(angles: FloatArray) -> bool:
    """Whether neighbours on a loop are neither half a turn apart nor, in rounding, at one angle."""
    gaps = np.diff(angles, append=angles[0] + TURN)
    return bool(gaps.max() <= LARGEST_GAP and gaps.min() >= SMALLEST_GAP)


def _by_length(mesh: NucleusMesh, angles: FloatArray) -> FloatArray:
    """Angles on the nuclear outline by its arc length, turned to be near given ones."""
    outline = mesh.vertices_yx[mesh.nucleus_boundary]
    lengths = np.hypot(*(np.roll(outline, -1, axis=0) - outline).T)
    even = TURN * np.append(0.0, np.cumsum(lengths[:-1])) / lengths.sum()
    return np.asarray(even + mean_along(mesh, angles - even))


def mean_along(mesh: NucleusMesh, values: FloatArray) -> float:
    """Mean along the nuclear outline, by its arc length."""
    outline = mesh.vertices_yx[mesh.nucleus_boundary]
    lengths = np.hypot(*(np.roll(outline, -1, axis=0) - outline).T)
    return float(np.average(values, weights=lengths + np.roll(lengths, 1)))
