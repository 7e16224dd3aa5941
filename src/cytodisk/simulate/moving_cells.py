"""Movies of one moving cell whose every material point is known, for tests of boundary trackers."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.checks import one_of, whole_number
from cytodisk.scale import Scale
from cytodisk.simulate.coupling import coupled_stretch, partly_followed
from cytodisk.simulate.drawing import half_covered
from cytodisk.simulate.growing_edges import swept_velocity
from cytodisk.simulate.jittered_masks import jittered
from cytodisk.simulate.movie_kinds import EDGE_KINDS, MOVIE_KINDS, MovieKind
from cytodisk.simulate.movie_plans import plan_movie
from cytodisk.simulate.movie_signals import Scene, camera, expected_counts, rasterised
from cytodisk.simulate.moving_cell_parameters import MovingCellParameters
from cytodisk.simulate.paths import normal_displacement, paths
from cytodisk.taking import takes


@dataclass(frozen=True, eq=False)
class SimulatedMovie:
    """A movie of one cell and where each of its points is in each frame.

    Positions are (row, column) in pixels, pixel centres at integers.

    Attributes
    ----------
    masks : ndarray of shape (T, H, W) and dtype bool
        Pixels whose centre lies inside the outline that is drawn: the true one, or one displaced by jitter.
        For the kinds of `EDGE_KINDS` pixels of which it covers half or more.
    boundary_yx : ndarray of shape (T, N, 2) and dtype float
        Material points of the true edge, from +x towards +y; evenly spaced in frame 0, for "filopodium" in
        frame 15.
    interior_yx : ndarray of shape (T, P, 2) and dtype float
        Material points inside, one in two square pixels in frame 0.
    normal_displacement_px : ndarray of shape (T, N) and dtype float
        How far each boundary point moves until the next frame, along the outward normal it has in this one;
        NaN in the last frame.
    coupled : ndarray of shape (N,) and dtype float
        Whether channel "edge" follows the edge's velocity at each boundary point: 1 where it does, 0 where
        it follows that of another cell, and between them a smooth transition.
    present : ndarray of shape (T,) and dtype bool
        False where the mask is empty because the frame was dropped.
    signal : DataArray with dims (time, channel, y, x) and dtype uint16, or None
        What a camera would count, with Poisson noise; attrs `pixel_size_um` and `frame_interval_s`.
    truth : DataArray with dims (time, channel, y, x) and dtype float, or None
        The expected counts: the signal without noise.
    kind : str
    seed : int
    lag_frames : int
        By how many frames channel "edge" follows the edge's velocity, where it does.
    pixel_size_um, frame_interval_s : float

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=3, radius_px=12.0)
    >>> truth.kind, truth.masks.shape[0], truth.boundary_yx.shape[2]
    ('growing', 3, 2)
    >>> truth.velocity_px[0].round(3)[:2]
    array([1., 1.])
    """

    masks: BoolArray
    boundary_yx: FloatArray
    interior_yx: FloatArray
    normal_displacement_px: FloatArray
    coupled: FloatArray
    present: BoolArray
    signal: xr.DataArray | None
    truth: xr.DataArray | None
    kind: MovieKind
    seed: int
    lag_frames: int
    pixel_size_um: float
    frame_interval_s: float

    @property
    def scale(self) -> Scale:
        """Both sizes, as maps and arrays carry them."""
        return Scale(self.pixel_size_um, self.frame_interval_s)

    @cached_property
    def velocity_px(self) -> FloatArray:
        """True velocity of each piece of the edge, from a boundary point to the next; shape (T, N).

        The signed area that the piece sweeps until the next frame over the mean of its two lengths, in pixels
        per frame, outward positive; NaN in the last frame. It has no bias where points slide along a curved
        edge: velocities times mean lengths sum to the change of the cell's area.
        """
        return swept_velocity(self.boundary_yx)


@takes(MovingCellParameters)
def movie(kind: MovieKind = "migrating", seed: int = 0, **settings: Any) -> SimulatedMovie:
    """A movie of one moving cell with exact answers.

    A smooth flow of the plane carries the cell's edge and its inside.

    Parameters
    ----------
    kind : str
        One of `MOVIE_KINDS`: "bulging" and "dropping" (five protrusions come and go; "dropping" loses
        frames), "migrating", "neutrophil" (crawl; the second changes its whole shape), "translating",
        "turning" (rigid), "necking" (a waist closes to 5 px and opens), "spiky" (filopodia), "ruffling"
        (waves travel around the edge), "growing" (a disk), "still" (nothing moves, but masks jitter),
        "fluctuating" (the edge moves by smooth noise that has no period, so that a lag can be told),
        "filopodium" (a protrusion 5 px wide grows out of a disk), "waving" (a round cell with waves that
        travel around it, 5° a frame), "lobes" (2, 4 or 5 lobes that stand, sink, and rise where the hollows
        were), "lamellipodium" (one side of a disk grows while all inside stands still).
    seed : int
        Places, phases, widths and directions; the same arguments give the same movie.
    **settings
        See `MovingCellParameters`.

    Returns
    -------
    SimulatedMovie

    Raises
    ------
    ParameterError
        An unknown kind, a number out of its range, or protrusion or waves for a kind that has none.

    See Also
    --------
    cell_with_signal : One frame.
    movie_with_nuclei : With a nucleus.
    predicting_movie : A cell whose channels predict its edge.
    wave_movie : A cell along whose edge a wave runs.
    coupled_series : Series of windows, without a cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("migrating", frames=3, radius_px=15.0)
    >>> len(truth.masks), truth.signal.dims
    (3, ('time', 'channel', 'y', 'x'))
    """
    kind, seed = one_of("kind", kind, MOVIE_KINDS), whole_number("seed", seed, 0)
    how = MovingCellParameters.of(**settings)
    frames, lag, scale = how.frames, how.lag_frames, Scale(how.pixel_size_um, how.frame_interval_s)
    habits = how.habits(kind)
    plan = plan_movie(kind, np.random.default_rng([seed, 0]), how.radius_px, habits)
    around = abs(lag) if how.signals else 0
    path = paths(plan, -around, frames + around + 1)
    shown = slice(around, around + frames)
    drawn = jittered(
        path.boundary_yx[shown], habits.jitter_px, habits.jitter_length_px, np.random.default_rng([seed, 1])
    )
    shape, shift = image_frame(drawn, how.margin)
    present = present_frames(frames, habits.dropped, np.random.default_rng([seed, 2]))
    displacement = normal_displacement(path.boundary_yx)
    boundary = path.boundary_yx[shown] + shift
    stretch = coupled_stretch(how.coupled, np.random.default_rng([seed, 5]))
    signal, truth = None, None
    if how.signals:
        other = plan_movie(kind, np.random.default_rng([seed, 6]), how.radius_px, habits)
        followed = partly_followed(displacement, stretch, other, -around)
        followed = followed[around - lag : around - lag + frames]
        scene = Scene(plan, path.places_yx[shown], boundary, followed, shape, shift, present)
        truth = expected_counts(scene, np.random.default_rng([seed, 3])).assign_attrs(scale.attrs)
        signal = camera(truth, np.random.default_rng([seed, 4]))
    draw = half_covered if kind in EDGE_KINDS else rasterised
    displacement = displacement[shown].copy()
    displacement[-1] = np.nan
    return SimulatedMovie(
        masks=np.stack([draw(outline + shift, shape) for outline in drawn]) & present[:, None, None],
        boundary_yx=boundary,
        interior_yx=path.interior_yx[shown] + shift,
        normal_displacement_px=displacement,
        coupled=stretch,
        present=present,
        signal=signal,
        truth=truth,
        kind=kind,
        seed=seed,
        lag_frames=lag,
        pixel_size_um=how.pixel_size_um,
        frame_interval_s=how.frame_interval_s,
    )


def image_frame(drawn_yx: FloatArray, margin: int) -> tuple[tuple[int, int], FloatArray]:
    """Shape of an image that holds all outlines, and the shift of positions into it."""
    low = np.floor(drawn_yx.min(axis=(0, 1))) - margin
    high = np.ceil(drawn_yx.max(axis=(0, 1))) + margin
    height, width = (high - low + 1.0).astype(int)
    return (int(height), int(width)), -low


def present_frames(frames: int, dropped: float, random: np.random.Generator) -> BoolArray:
    """False in a share of the frames, never in the first or the last; shape (T,)."""
    present = np.ones(frames, dtype=bool)
    count = min(round(dropped * frames), frames - 2)
    present[1 + random.permutation(frames - 2)[:count]] = False
    return present
