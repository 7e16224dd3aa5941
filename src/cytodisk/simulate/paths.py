"""Paths of a simulated cell's material points through the image."""

from dataclasses import dataclass

import numpy as np
import shapely

from cytodisk.arrays import FloatArray
from cytodisk.simulate.flow import Flow
from cytodisk.simulate.jittered_masks import evenly_spaced
from cytodisk.simulate.movie_plans import Plan

BOUNDARY_POINTS = 3000
_INTERIOR_SPACING = np.sqrt(2.0)  # pixels: one point in two square pixels


@dataclass(frozen=True, eq=False)
class Paths:
    """Where points are in a run of T frames.

    Attributes
    ----------
    places_yx : ndarray of shape (T, K, 2) and dtype float
        Positions of the pushes, in the cell's frame.
    boundary_yx : ndarray of shape (T, N, 2) and dtype float
        In pixels of the image, from where the cell's centre is in frame 0.
    interior_yx : ndarray of shape (T, P, 2) and dtype float
        As `boundary_yx`.
    """

    places_yx: FloatArray
    boundary_yx: FloatArray
    interior_yx: FloatArray


def paths(plan: Plan, first: int, stop: int, *, interior: bool = True) -> Paths:
    """Carry a cell's points from frame 0 back to a first frame and on to a last.

    Parameters
    ----------
    plan : Plan
    first : int
        0 or below.
    stop : int
        One after the last frame.
    interior : bool
        Whether there are points inside; the edge alone is faster.

    Returns
    -------
    Paths
        The boundary is evenly spaced in the image in frame 0, that of a filopodium in frame 15; the interior
        in frame 0.
    """
    points_yx = _at_start(plan, interior)
    later, earlier = [points_yx], [points_yx]
    for frame in range(stop - 1):
        later.append(_carried(plan, later[-1], frame, frame + 1))
    for frame in range(0, first, -1):
        earlier.append(_carried(plan, earlier[-1], frame, frame - 1))
    path = np.stack(earlier[:0:-1] + later)
    places = len(plan.places_yx)
    image = np.stack([plan.pose.to_image(path[k, places:], first + k) for k in range(len(path))])
    return Paths(path[:, :places], image[:, :BOUNDARY_POINTS], image[:, BOUNDARY_POINTS:])


def carried_from_start(plan: Plan, starts_yx: FloatArray) -> FloatArray:
    """Carry points inside a cell from frame 0, those of each frame on to that frame.

    Parameters
    ----------
    plan : Plan
    starts_yx : ndarray of shape (T, N, 2) and dtype float
        For each frame the points that are asked for in it, where they are in frame 0; in pixels of the image,
        from where the cell's centre is in frame 0.

    Returns
    -------
    ndarray of shape (T, N, 2) and dtype float
        Where they are in that frame.
    """
    frames, count = starts_yx.shape[:2]
    moving = plan.flow.shape_at_start(plan.places_yx) if isinstance(plan.flow, Flow) else plan.places_yx
    places = len(moving)
    moving = np.concatenate([moving, plan.pose.to_cell(starts_yx.reshape(-1, 2), 0.0)])
    arrived = np.empty_like(starts_yx)
    for frame in range(frames):
        arrived[frame] = plan.pose.to_image(moving[places : places + count], frame)
        moving = np.delete(moving, np.s_[places : places + count], axis=0)
        if frame + 1 < frames:
            moving = plan.flow.carry(moving, frame, frame + 1)
    return arrived


def normal_displacement(boundary_yx: FloatArray) -> FloatArray:
    """How far points of an edge move until the next frame along their outward normal.

    Parameters
    ----------
    boundary_yx : ndarray of shape (T, N, 2) and dtype float
        In pixels.

    Returns
    -------
    ndarray of shape (T, N) and dtype float
        In pixels, outward positive; NaN in the last frame.
    """
    along = np.roll(boundary_yx, -1, axis=1) - np.roll(boundary_yx, 1, axis=1)
    step = np.diff(boundary_yx, axis=0, append=np.nan * boundary_yx[:1])
    outward = step[..., 0] * -along[..., 1] + step[..., 1] * along[..., 0]
    return np.asarray(outward / np.hypot(along[..., 0], along[..., 1]))


def _carried(plan: Plan, points_yx: FloatArray, start: int, stop: int) -> FloatArray:
    """Places, boundary points and interior points a frame later or earlier."""
    if isinstance(plan.flow, Flow):
        return plan.flow.carry(points_yx, start, stop)
    edge, interior = points_yx[:BOUNDARY_POINTS], points_yx[BOUNDARY_POINTS:]
    return np.concatenate([plan.flow.carry_edge(edge, start, stop), plan.flow.carry(interior, start, stop)])


def _at_start(plan: Plan, interior: bool) -> FloatArray:
    """Places, boundary points and interior points in frame 0, the latter two evenly spaced in the image."""
    if isinstance(plan.flow, Flow):
        pushed = plan.flow.shape_at_start(np.concatenate([plan.places_yx, plan.outline_yx]))
        places, outline = pushed[: len(plan.places_yx)], pushed[len(plan.places_yx) :]
        boundary = evenly_spaced(plan.pose.to_image(outline, 0.0), BOUNDARY_POINTS)
    else:
        even, places = plan.flow.even_frame, plan.places_yx
        outline = plan.flow.carry_edge(plan.outline_yx, 0, even)
        boundary = plan.flow.carry_edge(evenly_spaced(outline, BOUNDARY_POINTS), even, 0)
        boundary = plan.pose.to_image(boundary, 0.0)
    points = np.concatenate([boundary, _inside(boundary)]) if interior else boundary
    return np.concatenate([places, plan.pose.to_cell(points, 0.0)])


def _inside(outline_yx: FloatArray) -> FloatArray:
    """Square lattice of points inside an outline."""
    low, high = outline_yx.min(axis=0), outline_yx.max(axis=0)
    rows, columns = (np.arange(a, b, _INTERIOR_SPACING) for a, b in zip(low, high, strict=True))
    lattice = np.stack(np.meshgrid(rows, columns, indexing="ij"), axis=-1).reshape(-1, 2)
    return lattice[shapely.contains_xy(shapely.Polygon(outline_yx), lattice)]
