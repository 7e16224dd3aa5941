"""How far a tracked movie is from the truth, where the truth is known."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cytodisk.arrays import FloatArray
from cytodisk.geometry.locate import nearest_on_outline
from cytodisk.geometry.polygon import edge_lengths
from cytodisk.motion.contour import Contour
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.edge import sector_of
from cytodisk.motion.matching import carry
from cytodisk.motion.tracking import TrackedBoundary, point_angles


def tracking_error(
    first: TrackedBoundary, last: TrackedBoundary, true_first_yx: FloatArray, true_last_yx: FloatArray
) -> FloatArray:
    """Distance along the outline between tracked and true places of material points.

    Parameters
    ----------
    first, last : TrackedBoundary
        Of two frames of one movie.
    true_first_yx, true_last_yx : ndarray of shape (M, 2) and dtype float
        The same material points of the edge in both frames, (row, column) in pixels.

    Returns
    -------
    ndarray of shape (M,) and dtype float
        In pixels, the shorter way around, at least 0.
    """
    start, stop = _place(true_first_yx, first.contour), _place(true_last_yx, last.contour)
    number = np.arange(len(first.s), dtype=np.float64)
    between = carry(start, first.s, number, first.contour.length, len(number))
    tracked = carry(between, number, last.s, len(number), last.contour.length)
    half = 0.5 * last.contour.length
    return np.asarray(np.abs(np.mod(tracked - stop + half, 2.0 * half) - half))


def true_edge_velocity(
    first: TrackedBoundary, boundary_yx: FloatArray, normal_displacement_px: FloatArray, sectors: int
) -> FloatArray:
    """Edge velocity that a perfect tracker would find, by frame and sector.

    Parameters
    ----------
    first : TrackedBoundary
        Boundary of the first frame, which says which material points belong to a sector.
    boundary_yx : ndarray of shape (T, M, 2) and dtype float
        Material points of the edge through time.
    normal_displacement_px : ndarray of shape (T, M) and dtype float
        Their displacement to the next frame along the outward normal.
    sectors : int

    Returns
    -------
    ndarray of shape (T, S) and dtype float
        Means by length of edge, in px/frame; NaN for a sector without points.
    """
    start = _place(boundary_yx[0], first.contour)
    angle = carry(start, first.s, point_angles(len(first.s)), first.contour.length, 2.0 * np.pi)
    sector = sector_of(angle, sectors)
    velocity = np.full((len(boundary_yx), sectors), np.nan)
    for number, displacement in enumerate(normal_displacement_px):
        after = edge_lengths(boundary_yx[number])
        weight = 0.5 * (after + np.roll(after, 1))
        total = np.bincount(sector, weight, sectors)
        held = total > 0.0
        velocity[number, held] = np.bincount(sector, weight * displacement, sectors)[held] / total[held]
    return velocity


def share_by_sector(
    movie: DiskMovie, boundary_yx: FloatArray, values: FloatArray, sectors: int
) -> FloatArray:
    """Mean of a property of the true edge over what each sector held of it, through the movie.

    Parameters
    ----------
    movie : DiskMovie
    boundary_yx : ndarray of shape (T, M, 2) and dtype float
        Material points of the edge through time.
    values : ndarray of shape (M,) and dtype float
        One a point, such as whether the signal is coupled to the edge there.
    sectors : int

    Returns
    -------
    ndarray of shape (S,) and dtype float
        Mean over frames with a map.
    """
    found = []
    for number in np.flatnonzero(movie.mapped):
        disk = movie[int(number)]
        _, nearest = cKDTree(boundary_yx[number]).query(disk.vertices_yx[disk.boundary])
        sector = sector_of(disk.boundary_angles, sectors)
        total = np.bincount(sector, values[nearest], sectors)
        found.append(total / np.maximum(np.bincount(sector, minlength=sectors), 1))
    return np.asarray(np.mean(found, axis=0))


def first_boundary_of(movie: DiskMovie) -> TrackedBoundary:
    """Tracked boundary of the first frame that has a map; a movie has one."""
    return next(record.boundary for record in movie.records if record.boundary is not None)


def _place(points_yx: FloatArray, contour: Contour) -> FloatArray:
    """Distance along a contour of the place nearest to each point, in pixels."""
    edge, share = nearest_on_outline(points_yx, contour.points_yx)
    return np.asarray(contour.arc[edge] + share * (contour.arc[edge + 1] - contour.arc[edge]))
