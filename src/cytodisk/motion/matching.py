"""Order-preserving matching of two outlines: the default boundary tracker.

It minimises, over maps of one closed curve onto the other that keep order, the integral along the curve of
|d|² + smoothness · (|d'|² + s'²): displacements d are to be short and to change little along the edge, and
the stretch s' is to be even, like those of an elastic band. A global search over coarse pairs comes first,
then Gauss-Newton steps on the continuous positions, which give fractions of a pixel. Registration uses the
same energy with a free rigid motion.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.geometry.polygon import signed_area
from cytodisk.motion.contour import Contour
from cytodisk.motion.cyclic_path import cyclic_path
from cytodisk.motion.elastic_band import Target, energy_and_slope, relax_band

_COARSE_SAMPLES = 128
_FINE_PX = 1.0
_LEAST_SAMPLES = 16
_PINNED = 1e12  # weight that holds a rotation at nothing
# What a rotation leaves of the boundary's motion is noise that reaches this far along the boundary; turns of
# a degree a frame are nothing unusual.
_NOISE_REACH_PX = 20.0
_USUAL_TURN = math.radians(1.0)
_FORESEEN = (0.25, 0.4)  # share of a turn's gain that the slope at no turn foresees: not believed, believed
_ROUND_GAIN_PX2 = 0.02  # squared displacement that a turn takes away if a round mask is drawn anew
_PIXEL_NOISE_PX2 = 0.04  # squared displacement that the pixels of a mask make of nothing


def first_guess(here: Contour, there: Contour, s: FloatArray, smoothness: float) -> FloatArray:
    """Where points of one outline come to lie on another, to a few pixels.

    Parameters
    ----------
    here, there : Contour
        In one frame; rigid motion is taken out as far as it is known.
    s : ndarray of shape (N,) and dtype float
        Distance along `here`, in pixels.
    smoothness : float
        In square pixels.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        Distance along `there`, in pixels; increasing where s is.
    """
    n = _COARSE_SAMPLES
    m = min(max(round(n * there.length / here.length), n // 4), 4 * n)
    step_here, step_there = here.length / n, there.length / m
    at_here: FloatArray = step_here * np.arange(n, dtype=np.float64)
    at_there: FloatArray = step_there * np.arange(m, dtype=np.float64)
    i, j = cyclic_path(
        here.at(at_here),
        there.at(at_there),
        0.5 * (step_here + step_there),
        smoothness,
    )
    return carry(s, np.asarray(i * step_here), np.asarray(j * step_there), here.length, there.length)


def match(here: Contour, there: Contour, s: FloatArray, guess: FloatArray, smoothness: float) -> FloatArray:
    """Refine a guess of where points of one outline lie on another.

    Parameters
    ----------
    here, there : Contour
        In one frame, rigid motion taken out.
    s, guess : ndarray of shape (N,) and dtype float
        Points along `here`, strictly increasing through one turn, and the guess along `there`.
    smoothness : float
        How far displacements are alike along the boundary, in square pixels.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        Distance along `there`, in pixels; strictly increasing through one turn.
    """
    grid = even_grid(here)
    start = carry(grid, s, guess, here.length, there.length)
    places, _, _ = relax_band(
        here.at(grid),
        _target(there),
        start,
        here.length / len(grid),
        smoothness,
        np.zeros(3),
        False,
        0.0,
    )
    return carry(s, grid, places, here.length, there.length)


def mean_square_displacement(
    here: Contour, there: Contour, s: FloatArray, guess: FloatArray, smoothness: float
) -> float:
    """Mean squared displacement of the matched boundary, in square pixels; arguments as for `match`."""
    grid = even_grid(here)
    start = carry(grid, s, guess, here.length, there.length)
    spacing = here.length / len(grid)
    return float(
        relax_band(here.at(grid), _target(there), start, spacing, smoothness, np.zeros(3), False, 0.0)[2]
    )


class RigidFit(NamedTuple):
    """A rigid motion of one outline onto another, and where points come to lie.

    Attributes
    ----------
    angle : float
        In radians, from +x towards +y.
    pivot, place : ndarray of shape (2,) and dtype float
        The motion takes x to R (x - pivot) + place.
    s : ndarray of shape (N,) and dtype float
        Points along the first outline, in pixels.
    slid, turned : ndarray of shape (N,) and dtype float
        Where they lie along the second one, if the first does not turn and if it may turn freely.
    """

    angle: float
    pivot: FloatArray
    place: FloatArray
    s: FloatArray
    slid: FloatArray
    turned: FloatArray


def rigid_motion(
    here: Contour, there: Contour, s: FloatArray, guess: FloatArray, smoothness: float, stiff: bool = False
) -> RigidFit:
    """Rigid motion that leaves the least of the matching energy.

    Growth of the whole shape is taken out first. Then three fits: without a rotation, with one, and with one
    that what the second leaves unexplained speaks against; each starts where the one before ended. The result
    goes from the first towards the third as far as the second explains what the first leaves: neither the
    stair steps of a round mask nor a protrusion turn a cell.

    Parameters
    ----------
    here, there : Contour
        In one frame, in which no rotation is the first guess.
    s, guess : ndarray of shape (N,) and dtype float
        Points along `here`, strictly increasing through one turn, and a guess along `there`.
    smoothness : float
        In square pixels.
    stiff : bool
        Of a body that hardly changes its shape, such as a nucleus: a turn is believed that explains more than
        pixels make of nothing.

    Returns
    -------
    RigidFit
    """
    grid, target = even_grid(here), _target(there)
    places = carry(grid, s, guess, here.length, there.length)
    points = here.at(grid)
    pivot = points.mean(axis=0)
    growth = math.sqrt(signed_area(there.points_yx) / signed_area(here.points_yx))
    grown, spacing = growth * (points - pivot), growth * here.length / len(grid)

    def fit(places: FloatArray, motion: FloatArray, doubt: float) -> tuple[FloatArray, FloatArray, float]:
        return relax_band(grown, target, places, spacing, smoothness, motion, True, doubt)

    slid, shifted, by_shift = fit(places, np.array([0.0, *pivot]), _PINNED)
    turned, free, by_both = fit(slid, shifted, 0.0)
    if stiff:
        way = _credible(by_shift - by_both, by_both)
        return RigidFit(
            float(way * free[0]), pivot, (shifted + way * (free - shifted))[1:], grid, slid, turned
        )
    explained = max(0.0, by_shift - by_both) / max(by_shift, _PIXEL_NOISE_PX2)
    before, slope = energy_and_slope(grown, target, slid, spacing, smoothness, shifted)
    after, _ = energy_and_slope(grown, target, turned, spacing, smoothness, free)
    way = explained * _downhill(before - after, -slope * float(free[0]))
    motion = shifted
    if way > 0.0:
        _, doubted, _ = fit(turned, free, _NOISE_REACH_PX * by_both / _USUAL_TURN**2)
        motion = shifted + way * (doubted - shifted)
    return RigidFit(float(motion[0]), pivot, motion[1:], grid, slid, turned)


def _downhill(gain: float, foreseen: float) -> float:
    """How far a turn is one that the outlines themselves lead to, from 0 to 1.

    A shape that did turn leads there: the energy falls from no turn at all, nearly as a parabola, whose slope
    foresees twice its gain. A shape with lobes that grow where others shrink looks as if it had turned by
    half a lobe to one side or to the other, and the energy has no slope to either.
    """
    far, near = _FORESEEN
    share = foreseen / (2.0 * gain) if gain > 0.0 else 1.0
    return min(max((share - far) / (near - far), 0.0), 1.0)


def _credible(gain: float, left: float) -> float:
    """How far the turn of a stiff body is believed, from 0 to 1.

    By the share of the displacement that it explains, less what the pixels of a round one make of nothing.

    Parameters
    ----------
    gain, left : float
        Mean squared displacement that the turn takes away and leaves, in square pixels.
    """
    return max(0.0, gain - _ROUND_GAIN_PX2) / (gain + left) if gain > 0.0 else 0.0


def _target(there: Contour) -> Target:
    return Target(there.points_yx, there.arc)


def carry(at: FloatArray, x: FloatArray, y: FloatArray, period_x: float, period_y: float) -> FloatArray:
    """Value of an increasing piecewise linear map of one turn onto another, over any number of turns.

    Parameters
    ----------
    at : ndarray of shape (M,) and dtype float
    x, y : ndarray of shape (N,) and dtype float
        Increasing through one turn.
    period_x, period_y : float
        Length of a turn.

    Returns
    -------
    ndarray of shape (M,) and dtype float
    """
    turn = np.floor((at - x[0]) / period_x)
    inner = np.interp(at - turn * period_x, np.append(x, x[0] + period_x), np.append(y, y[0] + period_y))
    return np.asarray(inner + turn * period_y)


def even_grid(contour: Contour) -> FloatArray:
    """Distances along a contour at which the energy is sampled: even, about one a pixel."""
    n = max(_LEAST_SAMPLES, round(contour.length / _FINE_PX))
    return np.asarray(contour.length * np.arange(n) / n)
