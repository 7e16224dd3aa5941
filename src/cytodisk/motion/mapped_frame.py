"""One frame of a movie, mapped: its boundary tracked, its interior started from the last frame."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from cytodisk.disk.cell_mesh import CellMesh, mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_mesh
from cytodisk.disk.mapping_parameters import NEWTON_METHODS
from cytodisk.motion.contour import Contour
from cytodisk.motion.still_interior import fade_in_px, still_map
from cytodisk.motion.temporal import carried_inside, tracked_angles
from cytodisk.motion.tracked_nucleus import TrackedNucleus
from cytodisk.motion.tracking import (
    TrackedBoundary,
    first_boundary,
    follow,
    point_angles,
)
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.scale import UNKNOWN, Scale


@dataclass(frozen=True, eq=False)
class MappedFrame:
    """Disk map and tracked boundary of one frame.

    Attributes
    ----------
    disk : DiskMap
    boundary : TrackedBoundary
    reference : TrackedBoundary
        What this frame was registered to; itself in a first frame and where tracking started anew.
    interior_restarted : str
        With interior "still", why the inside could not go on from the last map; empty if it did.
    nucleus : TrackedNucleus or None
        Where nuclei are given.
    """

    disk: DiskMap
    boundary: TrackedBoundary
    reference: TrackedBoundary
    interior_restarted: str = ""
    nucleus: TrackedNucleus | None = None

    @property
    def frame(self) -> int:
        """Number of the frame."""
        return self.boundary.frame


def map_frame(
    frame: int, mask: Any, last: MappedFrame | None, settings: MovieSettings, scale: Scale = UNKNOWN
) -> MappedFrame:
    """Map a frame of a movie so that it corresponds to the frame before.

    Parameters
    ----------
    frame : int
        Number of the frame.
    mask : array_like of shape (H, W)
        One cell.
    last : MappedFrame or None
        The last frame that could be mapped; None for the first.
    settings : MovieSettings
    scale : Scale

    Returns
    -------
    MappedFrame

    Raises
    ------
    MaskError
        The mask is not the mask of one cell.
    MapError
        No valid map was found.
    """
    cell = mesh_cell(mask, settings, scale)
    contour = Contour.of_outline(cell.outline + cell.corner)
    if last is None:
        angles = boundary_angles(contour.outline_yx, settings.align)
        disk = _map(cell, angles, settings)
        boundary = first_boundary(frame, contour, angles)
        return MappedFrame(disk, boundary, boundary)
    reference = reference_of(frame, last, settings)
    still = settings.interior == "still"
    boundary = follow(frame, contour, last.boundary, reference, settings, in_lab=still)
    angles = tracked_angles(contour, boundary.s, point_angles(len(boundary.s)))
    reference = boundary if boundary.restarted else reference
    if still and not boundary.restarted:
        found = still_map(cell, angles, last.disk, settings, fade_in_px(settings, scale))
        return MappedFrame(found.disk, boundary, reference, found.restarted)
    anchor = None
    if not boundary.restarted and settings.method in NEWTON_METHODS:
        anchor = carried_inside(cell, contour, boundary.s, last.disk, last.boundary.contour, last.boundary.s)
    disk = _map(cell, angles, settings, anchor)
    return MappedFrame(disk, boundary, reference, boundary.restarted if still else "")


def reference_of(frame: int, last: MappedFrame, settings: MovieSettings) -> TrackedBoundary:
    """Boundary that a frame is registered to: the last one's reference, or every few frames the last one."""
    renewed = frame // settings.renew_every > last.frame // settings.renew_every
    return last.boundary if renewed else last.reference


def _map(cell: CellMesh, angles: Any, settings: MovieSettings, anchor_uv: Any = None) -> DiskMap:
    return map_mesh(
        cell,
        angles,
        settings,
        anchor_uv=anchor_uv,
        inertia=settings.inertia,
    )
