"""Closed curves and masks of known shape, for the tests of this folder."""

from collections.abc import Sequence

import numpy as np
from hypothesis import strategies as st

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.motion.contour import Contour
from cytodisk.motion.registration import RigidTransform
from cytodisk.simulate.movie_signals import rasterised

CENTRE = np.array([60.3, 60.3])


def exact(points_yx: FloatArray) -> Contour:
    """Contour through points as they are, without smoothing."""
    return Contour(points_yx, points_yx)


def polar(radius: FloatArray, centre: FloatArray = CENTRE) -> FloatArray:
    """Points at even angles with the given distances from a centre."""
    angle = 2.0 * np.pi * np.arange(len(radius)) / len(radius)
    return centre + np.column_stack([radius * np.sin(angle), radius * np.cos(angle)])


def circle(radius: float = 45.0, n: int = 400, centre: FloatArray = CENTRE) -> FloatArray:
    return polar(np.full(n, radius), centre)


def wavy(heights: Sequence[float], phases: Sequence[float], radius: float = 45.0, n: int = 600) -> FloatArray:
    """Circle with waves of mode 2, 3, … whose heights are shares of the radius."""
    angle = 2.0 * np.pi * np.arange(n) / n
    modes = np.arange(2, 2 + len(heights))
    waves = np.array(heights) @ np.cos(np.outer(modes, angle) + np.array(phases)[:, None])
    return polar(radius * (1.0 + waves))


def lobed(radius: float = 45.0, n: int = 1200) -> FloatArray:
    """No symmetry at all, so that every rigid motion shows."""
    return wavy([0.12, 0.1, 0.05, 0.06], [0.3, 1.1, 2.0, -0.7], radius, n)


def moved(points_yx: FloatArray, degrees: float, shift: Sequence[float]) -> FloatArray:
    """Points turned about `CENTRE`, from +x towards +y, then shifted."""
    return RigidTransform(np.radians(degrees))(points_yx - CENTRE) + CENTRE + np.array(shift)


def masks_of(outlines_yx: Sequence[FloatArray], shape: tuple[int, int]) -> BoolArray:
    """One mask for each outline."""
    return np.stack([rasterised(outline, shape) for outline in outlines_yx])


def evenly(contour: Contour, n: int = 200) -> FloatArray:
    """Places of n points, evenly along a contour."""
    return contour.length * np.arange(n) / n


def runs_once(s: FloatArray, length: float) -> bool:
    """Whether places increase strictly through one turn."""
    return bool((np.diff(s, append=s[0] + length) > 0.0).all())


def smooth_curves(roughness: float = 0.08) -> st.SearchStrategy[FloatArray]:
    """Star-shaped curves with waves of mode 2 to 5."""
    heights = st.lists(st.floats(-roughness, roughness), min_size=4, max_size=4)
    phases = st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4)
    return st.builds(wavy, heights, phases, st.floats(30.0, 50.0))
