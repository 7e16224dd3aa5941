"""One frame of a movie, mapped: its boundary tracked, its interior started from the last frame."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from cytodisk.disk.circle import Align, boundary_angles, parse_align
from cytodisk.disk.disk_map import DiskMap, Method
from cytodisk.disk.mapping import CellMesh, check_map_parameters, map_mesh, mesh_cell
from cytodisk.errors import ParameterError
from cytodisk.motion.contour import Contour
from cytodisk.motion.temporal import carried_inside, tracked_angles
from cytodisk.motion.tracking import (
    TrackedBoundary,
    TrackingSettings,
    first_boundary,
    follow,
    is_number,
    point_angles,
)


@dataclass(frozen=True)
class MovieSettings:
    """How the frames of a movie are mapped.

    Attributes
    ----------
    tracking : TrackingSettings
    method, shape_weight, edge_length
        As for `map_to_disk`.
    align : {"upright"}, (float, float) or float
        Rotation of the first frame's disk, as for `map_to_disk`.
    inertia : float
        How much the inside of a frame stays where the frame before put it, against equal areas.
    """

    tracking: TrackingSettings = field(default_factory=TrackingSettings)
    method: Method = "newton"
    shape_weight: float = 0.005
    edge_length: float = 0.9
    align: Align = "upright"
    inertia: float = 1.0

    def __post_init__(self) -> None:
        check_map_parameters(self.method, self.shape_weight, self.edge_length)
        parse_align(self.align)
        if not (is_number(self.inertia) and 0 <= self.inertia < math.inf):
            raise ParameterError(
                f"inertia must be a number of at least 0, got {self.inertia!r}: 1 is the default"
            )


@dataclass(frozen=True, eq=False)
class MappedFrame:
    """Disk map and tracked boundary of one frame.

    Attributes
    ----------
    disk : DiskMap
    boundary : TrackedBoundary
    reference : TrackedBoundary
        What this frame was registered to; itself in a first frame and where tracking started anew.
    """

    disk: DiskMap
    boundary: TrackedBoundary
    reference: TrackedBoundary

    @property
    def time(self) -> int:
        """Number of the frame."""
        return self.boundary.time


def map_frame(time: int, mask: Any, last: MappedFrame | None, settings: MovieSettings) -> MappedFrame:
    """Map a frame of a movie so that it corresponds to the frame before.

    Parameters
    ----------
    time : int
        Number of the frame.
    mask : array_like of shape (H, W)
        One cell.
    last : MappedFrame or None
        The last frame that could be mapped; None for the first.
    settings : MovieSettings

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
    cell = mesh_cell(mask, settings.edge_length, settings.method)
    contour = Contour.of_outline(cell.outline + cell.corner)
    if last is None:
        angles = boundary_angles(contour.outline_yx, settings.align)
        disk = _map(cell, angles, settings)
        boundary = first_boundary(time, contour, angles)
        return MappedFrame(disk, boundary, boundary)
    renewed = time // settings.tracking.renew_every > last.time // settings.tracking.renew_every
    reference = last.boundary if renewed else last.reference
    boundary = follow(time, contour, last.boundary, reference, settings.tracking)
    angles = tracked_angles(contour, boundary.s, point_angles(len(boundary.s)))
    anchor = None
    if not boundary.restarted and settings.method == "newton":
        anchor = carried_inside(cell, contour, boundary.s, last.disk, last.boundary.contour, last.boundary.s)
    disk = _map(cell, angles, settings, anchor)
    return MappedFrame(disk, boundary, boundary if boundary.restarted else reference)


def _map(cell: CellMesh, angles: Any, settings: MovieSettings, anchor_uv: Any = None) -> DiskMap:
    return map_mesh(
        cell,
        angles,
        method=settings.method,
        shape_weight=settings.shape_weight,
        anchor_uv=anchor_uv,
        inertia=settings.inertia,
    )
