"""Movies of one moving cell whose every material point is known, for tests of boundary trackers."""

from dataclasses import dataclass, replace

import numpy as np
import xarray as xr
from matplotlib.path import Path
from scipy.ndimage import gaussian_filter1d
from skimage.draw import polygon2mask

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import ParameterError
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.simulate.drawing import check_at_least
from cytodisk.simulate.flow import Flow
from cytodisk.simulate.movie_kinds import HABITS, MOVIE_KINDS, Habits, MovieKind, Plan, plan_movie

_BOUNDARY_POINTS = 3000
_INTERIOR_SPACING = np.sqrt(2.0)  # pixels: one point in two square pixels
_JITTER_LENGTH = 8.0  # pixels along the edge over which the jitter's correlation falls to exp(-1/2)


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
    present : ndarray of shape (T,) and dtype bool
        False where the mask is empty because the frame was dropped.
    signal : DataArray with dims (time, channel, y, x) and dtype uint16, or None
        What a camera would count, with Poisson noise; attrs `pixel_size_um` and `frame_interval_s`.
    truth : DataArray with dims (time, channel, y, x) and dtype float, or None
        The expected counts: the signal without noise.
    kind : str
    seed : int
    lag_frames : int
        By how many frames channel "edge" follows the edge's velocity.
    pixel_size_um, frame_interval_s : float
    """

    masks: BoolArray
    boundary_yx: FloatArray
    interior_yx: FloatArray
    normal_displacement_px: FloatArray
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
        (waves travel around the edge), "growing" (a disk), "still" (nothing moves, but masks jitter).
    seed : int
        Places, phases, widths and directions; the same arguments give the same movie.
    frames : int
        At least 2.
    radius_px : float
        Of the disk of the same area as the cell at rest, at least 10.
    speed_px : float, optional
        Of the whole cell in pixels per frame, at least 0; for "growing" of its edge.
    turn_deg : float, optional
        Of the whole cell and its direction in degrees per frame, positive from +x towards +y.
    protrusion_px : float, optional
        Height of the largest protrusion in pixels, at least 0; only for kinds that have protrusions.
    jitter_px : float, optional
        Standard deviation of the drawn outline about the true one in pixels, at least 0. Smooth along the
        edge, independent between frames.
    dropped : float, optional
        Share of frames with an empty mask and no signal, from 0 to below 1; never the first or last.
    lag_frames : int
        By how many frames the "edge" channel follows the edge's velocity; negative: leads it.
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
    """
    habits = _habits(kind, speed_px, turn_deg, protrusion_px, jitter_px, dropped)
    plan = plan_movie(kind, np.random.default_rng([seed, 0]), radius_px, habits)
    path = _carried(plan.flow, _at_start(plan), 0, frames)
    anchors = 1 + len(plan.places_yx)
    boundary, interior = path[:, anchors : anchors + _BOUNDARY_POINTS], path[:, anchors + _BOUNDARY_POINTS :]
    drawn = _jittered(boundary, habits.jitter_px, np.random.default_rng([seed, 1]))
    shape, shift = _frame(drawn, margin)
    present = _present(frames, habits.dropped, np.random.default_rng([seed, 2]))
    masks = np.stack([polygon2mask(shape, outline + shift) for outline in drawn]) & present[:, None, None]
    displacement = normal_displacement(boundary)
    return SimulatedMovie(
        masks,
        boundary + shift,
        interior + shift,
        displacement,
        present,
        None,
        None,
        kind,
        seed,
        lag_frames,
        pixel_size_um,
        frame_interval_s,
    )


def normal_displacement(boundary_yx: FloatArray) -> FloatArray:
    """How far points of an edge move until the next frame along their outward normal; NaN in the last."""
    along = np.roll(boundary_yx, -1, axis=1) - np.roll(boundary_yx, 1, axis=1)
    step = np.diff(boundary_yx, axis=0, append=np.nan * boundary_yx[:1])
    outward = step[..., 0] * -along[..., 1] + step[..., 1] * along[..., 0]
    return np.asarray(outward / np.hypot(along[..., 0], along[..., 1]))


def _habits(
    kind: MovieKind,
    speed_px: float | None,
    turn_deg: float | None,
    protrusion_px: float | None,
    jitter_px: float | None,
    dropped: float | None,
) -> Habits:
    """The kind's habits with what the caller replaced."""
    given = {
        "speed_px": speed_px,
        "turn_deg": turn_deg,
        "protrusion_px": protrusion_px,
        "jitter_px": jitter_px,
        "dropped": dropped,
    }
    return replace(HABITS[kind], **{name: value for name, value in given.items() if value is not None})


def _at_start(plan: Plan) -> FloatArray:
    """Anchors, evenly spaced boundary points and interior points in frame 0."""
    anchors = np.concatenate([np.zeros((1, 2)), plan.places_yx])
    deformed = plan.flow.shape_at_start(np.concatenate([anchors, plan.outline_yx]))
    anchors, outline = deformed[: len(anchors)], deformed[len(anchors) :]
    boundary = _evenly(outline, _BOUNDARY_POINTS)
    return np.concatenate([anchors, boundary, _inside(boundary)])


def _evenly(outline_yx: FloatArray, count: int) -> FloatArray:
    """Points at equal distances along a closed outline."""
    arc = np.concatenate([[0.0], np.cumsum(edge_lengths(outline_yx))])
    closed = np.concatenate([outline_yx, outline_yx[:1]])
    at = np.linspace(0.0, arc[-1], count, endpoint=False)
    return np.column_stack([np.interp(at, arc, closed[:, 0]), np.interp(at, arc, closed[:, 1])])


def _inside(outline_yx: FloatArray) -> FloatArray:
    """Square lattice of points inside an outline."""
    low, high = outline_yx.min(axis=0), outline_yx.max(axis=0)
    rows, columns = (np.arange(a, b, _INTERIOR_SPACING) for a, b in zip(low, high, strict=True))
    lattice = np.stack(np.meshgrid(rows, columns, indexing="ij"), axis=-1).reshape(-1, 2)
    return lattice[Path(outline_yx).contains_points(lattice)]


def _carried(flow: Flow, points_yx: FloatArray, first: int, stop: int) -> FloatArray:
    """Points of frame 0 in the frames from `first` (0 or before) up to `stop`, shape (frames, N, 2)."""
    later, earlier = [points_yx], [points_yx]
    for frame in range(stop - 1):
        later.append(flow.carry(later[-1], frame, frame + 1))
    for frame in range(0, first, -1):
        earlier.append(flow.carry(earlier[-1], frame, frame - 1))
    return np.stack(earlier[:0:-1] + later)


def _jittered(boundary_yx: FloatArray, jitter_px: float, random: np.random.Generator) -> FloatArray:
    """Outlines displaced along their normals by noise that is smooth along the edge."""
    if not jitter_px:
        return boundary_yx
    return np.stack([_jittered_outline(outline, jitter_px, random) for outline in boundary_yx])


def _jittered_outline(outline_yx: FloatArray, jitter_px: float, random: np.random.Generator) -> FloatArray:
    even = _evenly(outline_yx, len(outline_yx))
    width = _JITTER_LENGTH / np.sqrt(2.0) / edge_lengths(even).mean()
    noise = gaussian_filter1d(random.normal(size=len(even)), width, mode="wrap")
    noise *= jitter_px * np.sqrt(2.0 * width * np.sqrt(np.pi))  # the filter's loss of standard deviation
    along = np.roll(even, -1, axis=0) - np.roll(even, 1, axis=0)
    normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(along[:, 0], along[:, 1])[:, None]
    return np.asarray(even + noise[:, None] * normal)


def _frame(drawn_yx: FloatArray, margin: int) -> tuple[tuple[int, int], FloatArray]:
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
