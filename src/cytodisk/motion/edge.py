"""How the boundary moves from one frame to the next: displacement, and areas won and lost."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import shapely

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.swept_edge import Frame, swept_edge, transforms
from cytodisk.motion.tracking import TrackedBoundary

STRETCHES = 240  # of the edge, of equal angle on the disk, from which the error of velocity is told


@dataclass(frozen=True, eq=False)
class EdgeMotion:
    """Motion of the boundary from one frame to the next, by sector.

    Attributes
    ----------
    displacement_px : ndarray of shape (S,) and dtype float
        Area that the sector's edge sweeps over its length; NaN where the sector has no boundary off the
        image's border.
    fastest_px : ndarray of shape (S,) and dtype float
        The same of the sector's fastest half pixel of edge.
    protruded_px2, retracted_px2 : ndarray of shape (S,) and dtype float
        Area that the cell won and lost, in square pixels; both at least 0.
    length_px : ndarray of shape (S,) and dtype float
        Mean of the boundary's lengths in both frames, off the border, in pixels.
    swept_px2 : float
        Sum over short pieces of the edge of the area that each sweeps, without signs.
    stretches_px : ndarray of shape (2, 240) and dtype float
        Swept area and length of short stretches of the edge, off the border, whatever the sectors.
    """

    displacement_px: FloatArray
    fastest_px: FloatArray
    protruded_px2: FloatArray
    retracted_px2: FloatArray
    length_px: FloatArray
    swept_px2: float
    stretches_px: FloatArray


def sector_of(angles: FloatArray, sectors: int) -> IntArray:
    """Sector that holds each angle of the disk; angles in radians."""
    number = np.floor(np.mod(angles / (2.0 * np.pi), 1.0) * sectors).astype(np.int64)
    return np.asarray(np.minimum(number, sectors - 1))


def normal_displacement(here: TrackedBoundary, there: TrackedBoundary, frame: Frame = "lab") -> FloatArray:
    """Outward displacement of the edge around each tracked point, in pixels, shape (N,).

    Parameters
    ----------
    here, there : TrackedBoundary
        Of two consecutive frames.
    frame : {"lab", "cell"}
        Motion in the image, or after rigid registration.

    Returns
    -------
    ndarray of shape (N,) and dtype float
        Positive outwards (protrusion): mean over the edge that is nearer to the point than to its
        neighbours.

    References
    ----------
    u-Unwrap, section 3 and Fig. S5.
    """
    return displacement_by_sector(here, there, None, len(here.s), frame)


def displacement_by_sector(
    here: TrackedBoundary,
    there: TrackedBoundary,
    image_shape: tuple[int, ...] | None,
    sectors: int,
    frame: Frame = "lab",
) -> FloatArray:
    """Mean outward displacement of each sector's edge, without what lies on the image's border.

    Parameters
    ----------
    here, there : TrackedBoundary
        Edge on the border in either frame does not count.
    image_shape : (int, int), or None
        None if there is no border.
    sectors : int
    frame : {"lab", "cell"}

    Returns
    -------
    ndarray of shape (S,) and dtype float
        In pixels; NaN where no edge is left.
    """
    area, length, _ = swept_edge(here, there, frame, image_shape).by_sector(sectors)
    return _over(area, length)


def edge_motion(
    here: TrackedBoundary,
    there: TrackedBoundary,
    disk_here: DiskMap,
    disk_there: DiskMap,
    sectors: int,
    *,
    frame: Frame = "lab",
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

    Returns
    -------
    EdgeMotion
    """
    pieces = swept_edge(here, there, frame, disk_here.placed_mask.image_shape)
    area, length, fastest = pieces.by_sector(sectors)
    start, stop = transforms(here, there, frame)
    won = _area_outside(disk_there, stop, disk_here, start, sectors)
    lost = _area_outside(disk_here, start, disk_there, stop, sectors)
    stretches = np.stack(pieces.by_sector(STRETCHES)[:2])
    return EdgeMotion(_over(area, length), fastest, won, lost, length, pieces.absolute_px2, stretches)


def _over(area: FloatArray, length: FloatArray) -> FloatArray:
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(area / length)


def _area_outside(
    disk: DiskMap, transform: RigidTransform, other: DiskMap, other_transform: RigidTransform, sectors: int
) -> FloatArray:
    """Pixels of one cell that lie outside the other, counted by the sector of their place in the disk."""
    if transform == other_transform:
        pixels = disk.placed_mask.outside(other.placed_mask).astype(np.float64)
    else:  # pixel centres fall between the other's pixels, where its outline decides
        everything = disk.placed_mask.pixels_yx.astype(np.float64)
        outline = shapely.Polygon(other.outline_yx)
        shapely.prepare(outline)
        seen = other_transform.inverse(transform(everything))
        pixels = everything[~shapely.contains_xy(outline, seen[:, 0], seen[:, 1])]
    uv = disk.to_disk(pixels, outside="nearest")
    sector = sector_of(np.arctan2(uv[:, 1], uv[:, 0]), sectors)
    return np.bincount(sector, minlength=sectors).astype(np.float64)
