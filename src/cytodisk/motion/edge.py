"""How the boundary moves from one frame to the next: displacement, areas won and lost, and their error."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
import shapely
from scipy.ndimage import gaussian_filter1d

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.motion.contour import Contour
from cytodisk.motion.disk_movie import on_border
from cytodisk.motion.matching import match
from cytodisk.motion.registration import IDENTITY, RigidTransform
from cytodisk.motion.tracking import TrackedBoundary, point_angles
from cytodisk.motion.tracking_parameters import SMOOTHNESS_PX2, JitterParameters

Frame: TypeAlias = Literal["lab", "cell"]
FRAMES: tuple[Frame, ...] = ("lab", "cell")

_JITTER_REACH_PX = 4.0  # standard deviation of the smoothing of simulated segmentation errors along the edge


@dataclass(frozen=True)
class EdgeMotion:
    """Motion of the boundary from one frame to the next, by sector.

    Attributes
    ----------
    displacement_px : ndarray of shape (S,) and dtype float
        Mean displacement along the outward normal, weighted by length of boundary; NaN where the sector has
        no boundary off the image's border.
    error_px : ndarray of shape (S,) and dtype float
        Standard deviation of the displacement if the masks' edges are uncertain by the given jitter.
    protruded_px2, retracted_px2 : ndarray of shape (S,) and dtype float
        Area that the cell won and lost, in square pixels; both at least 0.
    length_px : ndarray of shape (S,) and dtype float
        Boundary length off the border, in pixels.
    """

    displacement_px: FloatArray
    error_px: FloatArray
    protruded_px2: FloatArray
    retracted_px2: FloatArray
    length_px: FloatArray


def sector_of(angles: FloatArray, sectors: int) -> IntArray:
    """Sector that holds each angle of the disk; angles in radians."""
    number = np.floor(np.mod(angles / (2.0 * np.pi), 1.0) * sectors).astype(np.int64)
    return np.asarray(np.minimum(number, sectors - 1))


def normal_displacement(here: TrackedBoundary, there: TrackedBoundary, frame: Frame = "lab") -> FloatArray:
    """Displacement of each tracked point along the outward normal, in pixels, shape (N,).

    Parameters
    ----------
    here, there : TrackedBoundary
        Of two consecutive frames.
    frame : {"lab", "cell"}
        Motion in the image, or after rigid registration.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        Positive outwards (protrusion), along the normal of the first frame.

    References
    ----------
    u-Unwrap, section 3 and Fig. S5.
    """
    start, stop = _common(here, there, frame)
    step = stop(there.points_yx) - start(here.points_yx)
    return np.asarray((step * (here.normals_yx @ start.rotation.T)).sum(axis=1))


def edge_motion(
    here: TrackedBoundary,
    there: TrackedBoundary,
    disk_here: DiskMap,
    disk_there: DiskMap,
    sectors: int,
    *,
    frame: Frame = "lab",
    jitter: JitterParameters,
) -> EdgeMotion:
    """Motion of the boundary by sector.

    Parameters
    ----------
    here, there : TrackedBoundary
        Of two consecutive frames.
    disk_here, disk_there : DiskMap
        Theirs.
    sectors : int
    frame : {"lab", "cell"}
    jitter : JitterParameters
        For the error.

    Returns
    -------
    EdgeMotion
    """
    weights = _sector_weights(here, there, disk_here.mask.shape, sectors)
    displacement = _mean_by_sector(weights, normal_displacement(here, there, frame))
    random = np.random.default_rng([jitter.seed, here.frame])
    draws = [
        _mean_by_sector(weights, _jittered(here, there, frame, jitter.jitter_px, random))
        for _ in range(jitter.repeats)
    ]
    error = np.std(draws, axis=0, ddof=1) if jitter.repeats > 1 else np.full(sectors, np.nan)
    start, stop = _common(here, there, frame)
    won = _area_outside(disk_there, stop, disk_here, start, sectors)
    lost = _area_outside(disk_here, start, disk_there, stop, sectors)
    return EdgeMotion(displacement, error, won, lost, np.asarray(weights.sum(axis=1)))


def mean_by_sector(
    values: FloatArray,
    here: TrackedBoundary,
    there: TrackedBoundary,
    image_shape: tuple[int, ...],
    sectors: int,
) -> FloatArray:
    """Mean of a number for each tracked point by sector, without points on the image's border.

    Parameters
    ----------
    values : ndarray of shape (N,) and dtype float
    here, there : TrackedBoundary
        A point on the border in either frame does not count; weights are lengths of boundary in the first.
    image_shape : (int, int)
    sectors : int

    Returns
    -------
    ndarray of shape (S,) and dtype float
        NaN where no point is left.
    """
    return _mean_by_sector(_sector_weights(here, there, image_shape, sectors), values)


def _sector_weights(
    here: TrackedBoundary, there: TrackedBoundary, image_shape: tuple[int, ...], sectors: int
) -> FloatArray:
    """Length of boundary of each point in each sector, shape (S, N); a stretch of points is shared out.

    Points stand for the angles half-way to their neighbours, so that sectors finer than the points have
    their share as well.
    """
    n = len(here.s)
    shape = (int(image_shape[0]), int(image_shape[1]))
    off = ~(on_border(here.outline_points_yx, shape) | on_border(there.outline_points_yx, shape))
    half = np.pi / n
    low, high = point_angles(n) - half, point_angles(n) + half
    edges = 2.0 * np.pi * np.arange(sectors + 1) / sectors
    overlap = np.minimum(high, edges[1:, None]) - np.maximum(low, edges[:-1, None])
    share = np.maximum(overlap, 0.0) / (2.0 * half)
    return np.asarray(share * (here.lengths_px * off))


def _mean_by_sector(weights: FloatArray, values: FloatArray) -> FloatArray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((weights @ values) / weights.sum(axis=1))


def _jittered(
    here: TrackedBoundary,
    there: TrackedBoundary,
    frame: Frame,
    jitter_px: float,
    random: np.random.Generator,
) -> FloatArray:
    """Normal displacement when both edges are drawn with a random error."""
    start, stop = here.transform, there.transform
    first, second = (_shaken(boundary.contour, jitter_px, random) for boundary in (here, there))
    # Arc length changes a little with the jitter: points keep their share between outline points.
    s_first, s_second = (
        np.interp(boundary.s % boundary.contour.length, boundary.contour.arc, shaken.arc)
        for boundary, shaken in ((here, first), (there, second))
    )
    s_first, s_second = _unwrapped(s_first, first.length), _unwrapped(s_second, second.length)
    s_second = match(here.alignment.of(first), there.alignment.of(second), s_first, s_second, SMOOTHNESS_PX2)
    again = (
        TrackedBoundary(here.frame, first, s_first, start),
        TrackedBoundary(there.frame, second, s_second, stop),
    )
    return normal_displacement(*again, frame)


def _unwrapped(s: FloatArray, length: float) -> FloatArray:
    return s + length * np.concatenate([[0.0], np.cumsum(np.diff(s) < 0.0)])


def _shaken(contour: Contour, jitter_px: float, random: np.random.Generator) -> Contour:
    spacing = contour.length / len(contour.points_yx)
    noise = gaussian_filter1d(
        random.standard_normal(len(contour.points_yx)), _JITTER_REACH_PX / spacing, mode="wrap"
    )
    normals = contour.normals(contour.arc[:-1])
    size = max(float(np.sqrt(np.mean(noise**2))), 1e-12)
    return Contour(contour.points_yx + normals * (jitter_px / size * noise)[:, None], contour.outline_yx)


def _common(
    here: TrackedBoundary, there: TrackedBoundary, frame: Frame
) -> tuple[RigidTransform, RigidTransform]:
    return (IDENTITY, IDENTITY) if frame == "lab" else (here.transform, there.transform)


def _area_outside(
    disk: DiskMap, transform: RigidTransform, other: DiskMap, other_transform: RigidTransform, sectors: int
) -> FloatArray:
    """Pixels of one cell that lie outside the other, counted by the sector of their place in the disk."""
    if transform == other_transform:
        pixels = np.argwhere(disk.mask & ~other.mask).astype(np.float64)
    else:  # pixel centres fall between the other's pixels, where its outline decides
        everything = np.argwhere(disk.mask).astype(np.float64)
        outline = shapely.Polygon(other.outline_yx)
        shapely.prepare(outline)
        seen = other_transform.inverse(transform(everything))
        pixels = everything[~shapely.contains_xy(outline, seen[:, 0], seen[:, 1])]
    uv = disk.to_disk(pixels, outside="nearest")
    sector = sector_of(np.arctan2(uv[:, 1], uv[:, 0]), sectors)
    return np.bincount(sector, minlength=sectors).astype(np.float64)
