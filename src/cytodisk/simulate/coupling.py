"""Edges that follow their own velocity along a part of the cell only."""

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.simulate.movie_plans import Plan
from cytodisk.simulate.paths import BOUNDARY_POINTS, normal_displacement, paths

TRANSITION_POINTS = 30  # 1 % of the edge


def coupled_stretch(share: float, random: np.random.Generator) -> FloatArray:
    """How much each boundary point is coupled, if one stretch of the edge is.

    Parameters
    ----------
    share : float
        Share of the edge, from 0 to 1.
    random : Generator
        Draws where the stretch starts.

    Returns
    -------
    ndarray of shape (3000,) and dtype float
        1 where coupled, 0 where not, with a smooth transition of 30 points centred on either end (fewer
        where the stretch, or what is left of the edge, is shorter); its mean is `share`.
    """
    start = random.uniform(0.0, BOUNDARY_POINTS)
    if share in (0.0, 1.0):
        return np.full(BOUNDARY_POINTS, float(share))
    half = 0.5 * share * BOUNDARY_POINTS
    turn = (np.arange(BOUNDARY_POINTS) - start - half) % BOUNDARY_POINTS
    from_middle = np.minimum(turn, BOUNDARY_POINTS - turn)
    width = min(TRANSITION_POINTS, 2.0 * half, BOUNDARY_POINTS - 2.0 * half)
    inwards = np.clip((half - from_middle) / width, -0.5, 0.5)
    return np.asarray(0.5 + 0.5 * np.sin(np.pi * inwards))


def partly_followed(displacement_px: FloatArray, coupled: FloatArray, other: Plan, first: int) -> FloatArray:
    """Velocity of an edge where it is coupled; elsewhere that of another cell at the same boundary points.

    Parameters
    ----------
    displacement_px : ndarray of shape (T, N) and dtype float
        Normal velocity of the edge, in pixels per frame; NaN in the last frame.
    coupled : ndarray of shape (N,) and dtype float
        Share of the own velocity in the sum of both.
    other : Plan
        Plan of the other cell.
    first : int
        Frame of the first row, 0 or below.

    Returns
    -------
    ndarray of shape (T, N) and dtype float
    """
    if np.all(coupled == 1.0):
        return displacement_px
    boundary = paths(other, first, first + len(displacement_px), interior=False).boundary_yx
    return coupled * displacement_px + (1.0 - coupled) * normal_displacement(boundary)
