"""Movies of one moving cell whose every material point is known, for tests of boundary trackers."""

from dataclasses import dataclass

import numpy as np
import xarray as xr

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError
from cytodisk.simulate.coupling import coupled_stretch, partly_followed
from cytodisk.simulate.drawing import check_at_least, check_whole
from cytodisk.simulate.jittered_masks import jittered
from cytodisk.simulate.movie_kinds import HABITS, MOVIE_KINDS, Habits, MovieKind, plan_movie
from cytodisk.simulate.movie_signals import Scene, camera, expected_counts, rasterised
from cytodisk.simulate.paths import normal_displacement, paths


@dataclass(frozen=True, eq=False)
class SimulatedMovie:
    """A movie of one cell and where each of its points is in each frame.

    Positions are (row, column) in pixels, pixel centres at integers.

    Attributes
    ----------
    masks : ndarray of shape (T, H, W) and dtype bool
        Pixels whose centre lies inside the outline that is drawn: the true one, or one displaced by jitter.
    boundary_yx : ndarray of shape (T, N, 2) and dtype float
        Material points of the true edge, from +x towards +y; evenly spaced in frame 0.
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


def movie(
    kind: MovieKind = "migrating",
    seed: int = 0,
    *,
    frames: int = 40,
    radius_px: float = 45.0,
    speed_px: float | None = None,
    turn_deg: float | None = None,
    protrusion_px: float | None = None,
    jitter_px: float | None = None,
    dropped: float | None = None,
    lag_frames: int = 4,
    coupled: float = 1.0,
    pixel_size_um: float = 0.16,
    frame_interval_s: float = 5.0,
    margin: int = 10,
    signals: bool = True,
) -> SimulatedMovie:
    """A movie of one moving cell with exact answers.

    A smooth flow of the plane carries the cell's edge and its inside. None stands for the kind's own value.

    Parameters
    ----------
    kind : str
        One of `MOVIE_KINDS`: "bulging" and "dropping" (five protrusions come and go; "dropping" loses
        frames), "migrating", "neutrophil" (crawl; the second changes its whole shape), "translating",
        "turning" (rigid), "necking" (a waist closes to 5 px and opens), "spiky" (filopodia), "ruffling"
        (waves travel around the edge), "growing" (a disk), "still" (nothing moves, but masks jitter),
        "fluctuating" (the edge moves by smooth noise that has no period, so that a lag can be told).
    seed : int
        Places, phases, widths and directions; the same arguments give the same movie.
    frames : int
        At least 2.
    radius_px : float
        Radius of the disk of the same area as the cell at rest, at least 10.
    speed_px : float, optional
        Speed of the whole cell in pixels per frame, at least 0; for "growing" of its edge.
    turn_deg : float, optional
        Turn of the whole cell and its direction in degrees per frame, positive from +x towards +y.
    protrusion_px : float, optional
        Height of the largest protrusion in pixels, at least 0; only for kinds that have protrusions. For
        "fluctuating" three standard deviations of the edge about its mean place.
    jitter_px : float, optional
        Standard deviation of the drawn outline about the true one in pixels, at least 0. Smooth along the
        edge, independent between frames.
    dropped : float, optional
        Share of frames with an empty mask and no signal, from 0 to below 1; never the first or last.
    lag_frames : int
        By how many frames the "edge" channel follows the edge's velocity; negative: leads it.
    coupled : float
        Share of the edge, from 0 to 1, along which the "edge" channel follows the edge's velocity: one
        stretch from a random place on. Elsewhere it follows, at the same boundary points, the velocity of
        another cell of the kind, drawn independently; within 30 of the 3000 boundary points the one goes
        over into the other. Whatever all movies of a kind share, like the steady advance of a front, both
        cells have: "fluctuating" shares nothing, "growing" everything.
    pixel_size_um, frame_interval_s : float
        Above 0; stored with the signal.
    margin : int
        Pixels of background around all that is drawn, at least 0.
    signals : bool
        Whether to make the two channels, which takes most of the time.

    Returns
    -------
    SimulatedMovie

    Raises
    ------
    ParameterError
        An unknown kind, a number out of its range, or a protrusion for a kind that has none.

    See Also
    --------
    cell_with_signal : One frame.
    coupled_series : Series of windows, without a cell.

    Examples
    --------
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("migrating", frames=3, radius_px=15.0)
    >>> len(truth.masks), truth.signal.dims
    (3, ('time', 'channel', 'y', 'x'))
    """
    _check(seed, frames, radius_px, lag_frames, coupled, pixel_size_um, frame_interval_s, margin)
    habits = _habits(kind, speed_px, turn_deg, protrusion_px, jitter_px, dropped)
    plan = plan_movie(kind, np.random.default_rng([seed, 0]), radius_px, habits)
    around = abs(lag_frames) if signals else 0
    path = paths(plan, -around, frames + around + 1)
    shown = slice(around, around + frames)
    drawn = jittered(path.boundary_yx[shown], habits.jitter_px, np.random.default_rng([seed, 1]))
    shape, shift = _image_frame(drawn, margin)
    present = _present(frames, habits.dropped, np.random.default_rng([seed, 2]))
    displacement = normal_displacement(path.boundary_yx)
    boundary = path.boundary_yx[shown] + shift
    stretch = coupled_stretch(coupled, np.random.default_rng([seed, 5]))
    signal, truth = None, None
    if signals:
        other = plan_movie(kind, np.random.default_rng([seed, 6]), radius_px, habits)
        followed = partly_followed(displacement, stretch, other, -around)
        followed = followed[around - lag_frames : around - lag_frames + frames]
        scene = Scene(plan, path.places_yx[shown], boundary, followed, shape, shift, present)
        truth = expected_counts(scene, np.random.default_rng([seed, 3]), pixel_size_um, frame_interval_s)
        signal = camera(truth, np.random.default_rng([seed, 4]))
    displacement = displacement[shown].copy()
    displacement[-1] = np.nan
    return SimulatedMovie(
        masks=np.stack([rasterised(outline + shift, shape) for outline in drawn]) & present[:, None, None],
        boundary_yx=boundary,
        interior_yx=path.interior_yx[shown] + shift,
        normal_displacement_px=displacement,
        coupled=stretch,
        present=present,
        signal=signal,
        truth=truth,
        kind=kind,
        seed=seed,
        lag_frames=lag_frames,
        pixel_size_um=pixel_size_um,
        frame_interval_s=frame_interval_s,
    )


def _habits(
    kind: MovieKind,
    speed_px: float | None,
    turn_deg: float | None,
    protrusion_px: float | None,
    jitter_px: float | None,
    dropped: float | None,
) -> Habits:
    """The kind's habits with what the caller replaced."""
    if kind not in MOVIE_KINDS:
        raise ParameterError(f"kind must be one of {', '.join(MOVIE_KINDS)}, got {kind!r}")
    if protrusion_px is not None and HABITS[kind].protrusion_px is None:
        raise ParameterError(
            f"kind {kind!r} has no protrusions, got protrusion_px={protrusion_px!r}: leave it out"
        )
    own = HABITS[kind]
    habits = Habits(
        speed_px=own.speed_px if speed_px is None else speed_px,
        turn_deg=own.turn_deg if turn_deg is None else turn_deg,
        protrusion_px=own.protrusion_px if protrusion_px is None else protrusion_px,
        jitter_px=own.jitter_px if jitter_px is None else jitter_px,
        dropped=own.dropped if dropped is None else dropped,
    )
    for name in ("speed_px", "jitter_px", "dropped"):
        check_at_least(name, getattr(habits, name), 0.0)
    check_at_least("turn_deg", habits.turn_deg, -180.0)
    check_at_least("protrusion_px", habits.protrusion_px or 0.0, 0.0)
    if habits.dropped >= 1.0:
        raise ParameterError(f"dropped must be a share below 1, got {dropped!r}: pass 0.15 for 15 %")
    return habits


def _check(
    seed: int,
    frames: int,
    radius_px: float,
    lag_frames: int,
    coupled: float,
    pixel_size_um: float,
    frame_interval_s: float,
    margin: int,
) -> None:
    for name, value, least in (("seed", seed, 0), ("frames", frames, 2), ("margin", margin, 0)):
        check_whole(name, value, least)
    check_whole("lag_frames", lag_frames, -frames)
    check_at_least("radius_px", radius_px, 10.0)
    check_at_least("coupled", coupled, 0.0)
    if coupled > 1.0:
        raise ParameterError(
            f"coupled must be a share from 0 to 1, got {coupled!r}: pass 0.5 for half the edge"
        )
    check_at_least("pixel_size_um", pixel_size_um, 1e-9)
    check_at_least("frame_interval_s", frame_interval_s, 1e-9)


def _image_frame(drawn_yx: FloatArray, margin: int) -> tuple[tuple[int, int], FloatArray]:
    """Shape of an image that holds all outlines, and the shift of positions into it."""
    low = np.floor(drawn_yx.min(axis=(0, 1))) - margin
    high = np.ceil(drawn_yx.max(axis=(0, 1))) + margin
    height, width = (high - low + 1.0).astype(int)
    return (int(height), int(width)), -low


def _present(frames: int, dropped: float, random: np.random.Generator) -> BoolArray:
    present = np.ones(frames, dtype=bool)
    count = min(round(dropped * frames), frames - 2)
    present[1 + random.permutation(frames - 2)[:count]] = False
    return present
