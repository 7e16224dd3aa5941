"""Movies of one moving cell and its nucleus, with known outlines of both."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import shapely

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import one_of, whole_number
from cytodisk.geometry.polygon import centroid
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.jittered_masks import jittered
from cytodisk.simulate.movie_kinds import MOVIE_KINDS, MovieKind
from cytodisk.simulate.movie_plans import plan_movie
from cytodisk.simulate.moving_cell_parameters import MovingCellParameters
from cytodisk.simulate.moving_cells import SimulatedMovie, movie, present_frames
from cytodisk.simulate.nuclei.nucleus_movie_parameters import NucleusMovieParameters
from cytodisk.simulate.nuclei.nucleus_shapes import oval, turned
from cytodisk.simulate.paths import carried_from_start, paths
from cytodisk.taking import takes

_SQUEEZED: tuple[MovieKind, ...] = ("necking",)  # an oval of its area would not stay inside
_LARGEST = 0.75  # half the length of a nucleus, of the depth of the cell where it lies


@dataclass(frozen=True, eq=False)
class MovieWithNuclei:
    """A movie of one cell with its nucleus, and where each point of both outlines is.

    Attributes
    ----------
    cell : SimulatedMovie
        The same as `movie` makes of the cell's parameters.
    nuclei : ndarray of shape (T, H, W) and dtype bool
        Pixels of which the nucleus covers half or more; empty in a frame without cell or without nucleus.
    nucleus_yx : ndarray of shape (T, 720, 2) and dtype float
        Material points of the true nuclear outline, (row, column) in pixels; there in every frame.
    nucleus_present : ndarray of shape (T,) and dtype bool
        False where `nuclei` is empty.
    turn_deg : float
        By how much the nucleus turns within the cell, in degrees per frame.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie_with_nuclei("growing", frames=3, radius_px=20.0)
    >>> truth.masks.shape == truth.nuclei.shape
    True
    """

    cell: SimulatedMovie
    nuclei: BoolArray
    nucleus_yx: FloatArray
    nucleus_present: BoolArray
    turn_deg: float

    @property
    def masks(self) -> BoolArray:
        """Masks of the cell, shape (T, H, W)."""
        return self.cell.masks


@takes(NucleusMovieParameters)
def movie_with_nuclei(kind: MovieKind = "migrating", seed: int = 0, **settings: Any) -> MovieWithNuclei:
    """A movie of one moving cell and its nucleus with exact answers.

    The nucleus is an oval where the cell is deepest in frame 0. The flow that carries the cell's inside
    carries it along; it is stretched and turned as a whole, and stays an oval of its area. For "necking",
    where the waist closes beside it, it is squeezed as what is around it. It may turn within the cell.

    Parameters
    ----------
    kind : str
        One of `MOVIE_KINDS`; see `movie`.
    seed : int
        Places, phases, widths and directions; the same arguments give the same movie.
    **settings
        See `NucleusMovieParameters`.

    Returns
    -------
    MovieWithNuclei

    Raises
    ------
    ParameterError
        An unknown kind, a number out of its range, or protrusion or waves for a kind that has none.

    See Also
    --------
    movie : The cell alone.
    cell_with_nucleus : One frame.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie_with_nuclei("migrating", frames=5, radius_px=15.0, nucleus_missing=0.2)
    >>> int(truth.nucleus_present.sum()), truth.nucleus_yx.shape
    (4, (5, 720, 2))
    """
    kind, seed = one_of("kind", kind, MOVIE_KINDS), whole_number("seed", seed, 0)
    how = NucleusMovieParameters.of(**settings)
    cell = movie(kind, seed, **{name: getattr(how, name) for name in MovingCellParameters.model_fields})
    habits = how.habits(kind)
    plan = plan_movie(kind, np.random.default_rng([seed, 0]), how.radius_px, habits)
    shift = cell.boundary_yx[0, 0] - paths(plan, 0, 1, interior=False).boundary_yx[0, 0]
    random = np.random.default_rng([seed, 7])
    outline, centre = _outline_at_start(cell.boundary_yx[0], how, random)
    turns = np.radians(how.nucleus_turn_deg) * np.arange(how.frames)
    starts = np.stack([turned(outline, turn) for turn in turns])
    outlines = carried_from_start(plan, starts + centre - shift) + shift
    if kind not in _SQUEEZED:
        outlines = _kept_oval(starts, outlines)
    drawn = jittered(outlines, habits.jitter_px, habits.jitter_length_px, np.random.default_rng([seed, 8]))
    present = cell.present & present_frames(how.frames, how.nucleus_missing, np.random.default_rng([seed, 9]))
    shape = (cell.masks.shape[1], cell.masks.shape[2])
    return MovieWithNuclei(
        cell=cell,
        nuclei=np.stack([half_covered(one, shape) for one in drawn]) & present[:, None, None],
        nucleus_yx=outlines,
        nucleus_present=present,
        turn_deg=how.nucleus_turn_deg,
    )


def _kept_oval(starts_yx: FloatArray, carried_yx: FloatArray) -> FloatArray:
    """What a stiff nucleus makes of a flow: stretched and turned as a whole, in least squares, of one area.

    Parameters
    ----------
    starts_yx : ndarray of shape (T, N, 2) and dtype float
        Outlines about their centre in frame 0, one for each frame.
    carried_yx : ndarray of shape (T, N, 2) and dtype float
        Where the flow takes them by that frame.

    Returns
    -------
    ndarray of shape (T, N, 2) and dtype float
    """
    found = []
    for start, carried in zip(starts_yx, carried_yx, strict=True):
        middle = centroid(carried)
        stretch = np.linalg.lstsq(start, carried - middle, rcond=None)[0]
        found.append(middle + start @ stretch / np.sqrt(np.linalg.det(stretch)))
    return np.stack(found)


def _outline_at_start(
    cell_yx: FloatArray, how: NucleusMovieParameters, random: np.random.Generator
) -> tuple[FloatArray, FloatArray]:
    """Outline of the nucleus about its centre, and the centre."""
    cell = shapely.Polygon(cell_yx)
    deepest = shapely.get_coordinates(shapely.maximum_inscribed_circle(cell, tolerance=0.1))
    centre, room = deepest[0], _LARGEST * float(np.hypot(*(deepest[1] - deepest[0])))
    area = min(how.nucleus_share * cell.area, np.pi * room**2 / how.nucleus_elongation)
    return oval(area, how.nucleus_elongation, random.uniform(0.0, np.pi)), centre
