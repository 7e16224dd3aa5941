"""Boundary → circle: each outline point gets its share of arc length as an angle (paper A.2.1 i)."""

import math
from typing import Any

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray
from cytodisk.disk.mapping_parameters import Align
from cytodisk.errors import ParameterError
from cytodisk.geometry.polygon import arc_lengths, centroid
from cytodisk.parameter_words import short_words

_FURTHEST = 1_000_000  # px or degrees


def boundary_angles(outline_yx: FloatArray, align: Align = "upright") -> FloatArray:
    """Angle on the circle of each outline point, in proportion to arc length (`arc_lengths`).

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon from +x towards +y, (row, column) in pixels.
    align : {"upright"}, (float, float) or float
        Where the free rotation ends: "upright" brings the circle closest, in least squares along the
        outline, to the outline's own directions from its centroid; a point (row, column) puts the nearest
        outline point at angle 0; a number turns the upright disk by that many degrees, from +u towards +v.

    Returns
    -------
    ndarray of shape (B,) and dtype float
        In radians, strictly increasing, all within one turn.

    Raises
    ------
    ParameterError
        `align` is none of these.

    References
    ----------
    u-Unwrap, appendix A.2.1 (i).
    """
    return angles_of_lengths(outline_yx, arc_lengths(outline_yx), align)


def angles_of_lengths(outline_yx: FloatArray, lengths: FloatArray, align: Align = "upright") -> FloatArray:
    """Angle on the circle of each outline point, in proportion to given lengths of the outline's edges.

    Parameters
    ----------
    outline_yx : ndarray of shape (B, 2) and dtype float
        As in `boundary_angles`.
    lengths : ndarray of shape (B,) and dtype float
        Of each edge, in any unit, all positive.
    align : {"upright"}, (float, float) or float
        As in `boundary_angles`.

    Returns
    -------
    ndarray of shape (B,) and dtype float
        In radians, strictly increasing, all within one turn.

    Raises
    ------
    ParameterError
        `align` is none of these.
    """
    turn = 2.0 * np.pi * np.cumsum(lengths) / lengths.sum()
    angles = np.concatenate([[0.0], turn[:-1]])
    return angles + _rotation(outline_yx, angles, lengths, align)


def parse_align(align: Any) -> Align:
    """Check where the rotation of the disk is to end.

    Parameters
    ----------
    align : {"upright", "nucleus"}, point or number
        As in `boundary_angles`, or by the nucleus, which `map_to_disk` knows.

    Returns
    -------
    {"upright", "nucleus"}, (float, float) or float

    Raises
    ------
    ParameterError
        `align` is none of these.
    """
    if isinstance(align, str) and align == "upright":
        return "upright"
    if isinstance(align, str) and align == "nucleus":
        return "nucleus"
    try:
        numbers = np.asarray(align, dtype=np.float64)
    except (TypeError, ValueError):
        numbers = np.full(3, np.nan)
    in_reach = numbers.shape in ((), (2,)) and bool((np.abs(numbers) <= _FURTHEST).all())
    if in_reach and not isinstance(align, bool | str):
        return float(numbers) if numbers.shape == () else (float(numbers[0]), float(numbers[1]))
    raise ParameterError(
        "align must be 'upright', 'nucleus', a point (row, column) or an angle in degrees, at most "
        f"{_FURTHEST}, got {short_words(align)}"
    )


@njit(cache=True)
def polygon_radius_at(u: float, v: float, angles: FloatArray) -> float:
    """`polygon_radius` of one point."""
    turn, last = 2.0 * math.pi, len(angles) - 1
    angle = angles[0] + (math.atan2(v, u) - angles[0]) % turn
    edge = min(max(np.searchsorted(angles, angle, side="right") - 1, 0), last)
    end = angles[edge + 1] if edge < last else angles[0] + turn
    half, middle = 0.5 * (end - angles[edge]), 0.5 * (end + angles[edge])
    return math.cos(half) / math.cos(angle - middle)


@njit(cache=True)
def polygon_radius(points_uv: FloatArray, angles: FloatArray) -> FloatArray:
    """Distance from the centre to the polygon of points on the circle, in the direction of each point.

    Parameters
    ----------
    points_uv : ndarray of shape (N, 2) and dtype float
        (u, v).
    angles : ndarray of shape (B,) and dtype float
        Angles of the polygon's corners in radians, strictly increasing within one turn.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        cos π/B to 1 where the corners are even; NaN where the point is.
    """
    out = np.empty(len(points_uv))
    for n in range(len(points_uv)):
        u, v = points_uv[n, 0], points_uv[n, 1]
        out[n] = math.nan if math.isnan(u) else polygon_radius_at(u, v, angles)
    return out


def _rotation(outline_yx: FloatArray, angles: FloatArray, lengths: FloatArray, align: Align) -> float:
    align = parse_align(align)
    if isinstance(align, tuple):
        nearest = np.square(outline_yx - np.array(align)).sum(axis=1).argmin()
        return -float(angles[nearest])
    upright = _upright(outline_yx, angles, lengths)
    return upright if isinstance(align, str) else upright + float(np.radians(align))


def _upright(outline_yx: FloatArray, angles: FloatArray, lengths: FloatArray) -> float:
    away = outline_yx - centroid(outline_yx)
    weight = lengths + np.roll(lengths, 1)
    # argmin over φ of Σ weight |r exp(i (angle + φ)) - away|² is the phase of this sum, whatever r.
    return float(np.angle(np.sum(weight * (away[:, 1] + 1j * away[:, 0]) * np.exp(-1j * angles))))
