"""The nuclear outline from frame to frame, followed as the membrane is."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.disk.cell_mesh import CellMesh
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.nucleus.nucleus_guide import NucleusGuide, between_outlines
from cytodisk.geometry.nucleus_mesh import NucleusMesh
from cytodisk.motion.contour import Contour
from cytodisk.motion.registration import IDENTITY, RigidTransform
from cytodisk.motion.temporal import displacement_back, tracked_angles
from cytodisk.motion.tracking import TrackedBoundary, first_boundary, follow, point_angles
from cytodisk.motion.tracking_parameters import TrackingSettings


@dataclass(frozen=True, eq=False)
class TrackedNucleus:
    """Tracked points on the nuclear outline of one frame.

    Attributes
    ----------
    boundary : TrackedBoundary
        In the movie's common frame: the motion of the cell is taken out. Its transform is what the nucleus
        does beside that.
    reference : TrackedBoundary
        What this frame was registered to; itself where tracking starts.
    contour : Contour
        The outline in the image.
    twist : float
        How far the nucleus has turned against the membrane on the disk, in radians, less whole turns that
        were taken back.
    unwound : bool
        Whether one was taken back here.
    held : str
        Why this is the nucleus of the frame before, moved with the cell; empty if it is the frame's own.
    """

    boundary: TrackedBoundary
    reference: TrackedBoundary
    contour: Contour
    twist: float = 0.0
    unwound: bool = False
    held: str = ""

    @property
    def points_yx(self) -> FloatArray:
        """Tracked points in the image, shape (M, 2), (row, column) in pixels."""
        return self.contour.at(self.boundary.s)


def nucleus_contour(disk: DiskMap) -> Contour:
    """Nuclear outline of a map, in the image."""
    assert disk.nucleus_outline_yx is not None
    return Contour.of_outline(disk.nucleus_outline_yx)


def first_nucleus(
    frame: int, disk: DiskMap, transform: RigidTransform = IDENTITY, restarted: str = ""
) -> TrackedNucleus:
    """Points to be tracked, at even angles of the first map of a nucleus.

    Parameters
    ----------
    frame : int
    disk : DiskMap
        With a nucleus whose outline was free to slide.
    transform : RigidTransform
        The alignment of the cell, from the image to the movie's common frame.
    restarted : str
        Why this is not the movie's first.

    Returns
    -------
    TrackedNucleus
    """
    assert disk.nucleus is not None
    contour = nucleus_contour(disk)
    found = first_boundary(frame, transform.of(contour), disk.nucleus.boundary_angles)
    found = replace(found, restarted=restarted)
    return TrackedNucleus(found, found, contour)


def follow_nucleus(
    frame: int,
    contour: Contour,
    cell: TrackedBoundary,
    last: TrackedNucleus,
    settings: TrackingSettings,
) -> TrackedNucleus:
    """Carry the tracked points of a nucleus to the next frame.

    The nucleus first goes with its cell, whatever its own outline looks like, so that a round one turns with
    the cell; what its outline did beside that is registered and matched as a cell's is.

    Parameters
    ----------
    frame : int
    contour : Contour
        Nuclear outline of this frame in the image.
    cell : TrackedBoundary
        The membrane of this frame.
    last : TrackedNucleus
    settings : TrackingSettings

    Returns
    -------
    TrackedNucleus
        Its boundary says where tracking has to start anew.
    """
    before = last.boundary
    renewed = frame // settings.renew_every > before.frame // settings.renew_every
    reference = before if renewed else last.reference
    found = follow(frame, cell.alignment.of(contour), before, reference, settings, stiff=True)
    return TrackedNucleus(found, found if found.restarted else reference, contour)


def guide_from(
    cell: CellMesh,
    membrane: tuple[Contour, TrackedBoundary],
    nucleus: TrackedNucleus,
    previous: DiskMap,
    last: tuple[TrackedBoundary, TrackedNucleus],
    inertia: float,
) -> NucleusGuide:
    """Where a nucleus and the inside of its cell lie in the disk if they moved with both outlines.

    The displacement of membrane and nuclear outline since the last frame is continued between and inside
    them by a harmonic function, and the last map is read at the place that each vertex came from.

    Parameters
    ----------
    cell : CellMesh
        This frame.
    membrane : (Contour, TrackedBoundary)
        This frame's.
    nucleus : TrackedNucleus
        This frame's.
    previous : DiskMap
        The last frame's.
    last : (TrackedBoundary, TrackedNucleus)
        The last frame's.
    inertia : float

    Returns
    -------
    NucleusGuide
    """
    assert isinstance(cell.mesh, NucleusMesh)
    assert previous.nucleus is not None
    own = nucleus.boundary
    angles = tracked_angles(nucleus.contour, own.s, point_angles(len(own.s)))
    moved = np.concatenate(
        [
            displacement_back(membrane[0], membrane[1].s, last[0].contour, last[0].s),
            displacement_back(nucleus.contour, own.s, last[1].contour, last[1].boundary.s),
        ]
    )
    origin = cell.mesh.vertices_yx + cell.corner + between_outlines(cell.mesh, moved, cell.system)
    uv = previous.to_disk(origin, outside="nearest")
    radius = np.hypot(*uv.T)
    depths = previous.nucleus.share_at(radius)
    inner = cell.mesh.vertex_inside
    depths[inner] = np.minimum(radius[inner] / previous.nucleus.radius, 1.0)
    return NucleusGuide(angles, last[1].twist, depths, np.arctan2(uv[:, 1], uv[:, 0]), inertia)
