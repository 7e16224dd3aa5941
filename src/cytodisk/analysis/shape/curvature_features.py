"""Curvature of the outline: how it bends, how much of it is concave, how many tips stick out."""

import numpy as np

from cytodisk.analysis.shape.cell_shape import LEAST_SMOOTHING_PX, CellShape
from cytodisk.analysis.shape.feature import Feature, FeatureGroup, plain
from cytodisk.arrays import BoolArray, FloatArray, IntArray
from cytodisk.geometry.polygon import edge_lengths

_SHARE = 0.04  # of the equivalent diameter: smoothing of the outline
RESOLVED_PX = LEAST_SMOOTHING_PX / _SHARE
"""Least equivalent diameter of a cell whose curvature does not depend on the resolution, in pixels."""
_STRONG, _CONCAVE = 1.5, -0.5  # curvature of a tip and of a bay, a disk of the same area having 1
_TIP_TURN, _BAY_TURN = (
    np.deg2rad(100.0),
    np.deg2rad(30.0),
)  # least change of direction in a tip, more than a right angle, and in a bay


def measure_curvature(shape: CellShape) -> dict[str, float]:
    """Statistics of κ R along the smoothed outline, R the radius of the disk of the same area.

    Parameters
    ----------
    shape : CellShape

    Returns
    -------
    dict of str to float
        By name, see `CURVATURE`.
    """
    curve = shape.smoothed_curve(_SHARE)
    turn = turning(curve)
    bend = turn * (len(curve) / edge_lengths(curve).sum()) * shape.radius
    low, median, high = np.percentile(bend, (5, 50, 95)).tolist()
    return {
        "curvature_size": float(np.abs(bend).mean()),
        "curvature_sd": float(bend.std()),
        "curvature_min": float(bend.min()),
        "curvature_p05": low,
        "curvature_p50": median,
        "curvature_p95": high,
        "curvature_max": float(bend.max()),
        "concave_share": float((bend < _CONCAVE).mean()),
        "concave_turn": float(np.abs(turn[turn < 0]).sum() / (2.0 * np.pi)),
        "tips": float((turn_of_runs(turn, bend > _STRONG) > _TIP_TURN).sum()),
        "bays": float((turn_of_runs(turn, bend < _CONCAVE) < -_BAY_TURN).sum()),
    }


def turning(curve_yx: FloatArray) -> FloatArray:
    """Change of direction at each point of a closed polygon, in radians, positive where it is convex.

    Parameters
    ----------
    curve_yx : ndarray of shape (N, 2) and dtype float
        From +x towards +y, (row, column) in pixels.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        Sums up to 2π for a simple polygon.
    """
    steps = np.diff(curve_yx, axis=0, append=curve_yx[:1])
    direction = steps[:, 1] + 1j * steps[:, 0]
    return np.asarray(np.angle(direction * np.roll(direction, 1).conj()))


def turn_of_runs(turn: FloatArray, inside: BoolArray) -> FloatArray:
    """Change of direction over each run of points on a closed curve.

    Parameters
    ----------
    turn : ndarray of shape (N,) and dtype float
        In radians.
    inside : ndarray of shape (N,) and dtype bool
        Which points belong to a run.

    Returns
    -------
    ndarray of shape (runs,) and dtype float
        In radians.
    """
    if inside.all():
        return np.array([turn.sum()])
    first = int(np.argmin(inside))  # begin outside of all runs, so that none is cut in two
    turn, inside = np.roll(turn, -first), np.roll(inside, -first)
    starts: IntArray = np.flatnonzero(inside & ~np.roll(inside, 1))
    runs = np.cumsum(np.isin(np.arange(len(turn)), starts))
    return np.asarray(np.bincount(runs[inside], turn[inside], minlength=len(starts) + 1)[1:], np.float64)


def _bend(name: str, description: str) -> Feature:
    smoothing = (
        f"outline smoothed over {_SHARE:.0%} of the equivalent diameter, {LEAST_SMOOTHING_PX:g} px at least"
    )
    return plain(
        name, f"{description}; {smoothing}, so it depends on the resolution below {RESOLVED_PX:.0f} px"
    )


CURVATURE = FeatureGroup(
    "curvature",
    (
        _bend("curvature_size", "Mean |κ| of the outline × equivalent radius; 1 for a disk"),
        _bend("curvature_sd", "sd of κ × equivalent radius; 0 for a disk"),
        _bend("curvature_min", "Smallest κ × equivalent radius; negative where concave"),
        _bend("curvature_p05", "Percentile 5 of κ × equivalent radius"),
        _bend("curvature_p50", "Median of κ × equivalent radius"),
        _bend("curvature_p95", "Percentile 95 of κ × equivalent radius"),
        _bend("curvature_max", "Largest κ × equivalent radius"),
        _bend("concave_share", "Share of the outline that is concave (κ × equivalent radius below -0.5)"),
        _bend("concave_turn", "Turns that the outline makes in its concave parts"),
        _bend("tips", "Tips that stick out: strongly curved stretches that turn by more than 100°"),
        _bend("bays", "Bays: concave stretches that turn by more than 30°"),
    ),
    measure_curvature,
)
