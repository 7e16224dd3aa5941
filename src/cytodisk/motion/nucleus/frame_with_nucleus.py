"""One frame of a movie of a cell with its nucleus, mapped so that it corresponds to the frame before."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cytodisk.disk.cell_mesh import CellMesh, mesh_cell
from cytodisk.disk.circle import boundary_angles
from cytodisk.disk.mapping import align_of, map_with_nucleus
from cytodisk.errors import CytodiskError, NucleusError, ReadError
from cytodisk.geometry.mask import FilledMask
from cytodisk.geometry.outline import trace_outline
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.motion.contour import Contour
from cytodisk.motion.mapped_frame import MappedFrame, reference_of
from cytodisk.motion.nucleus.cell_and_nucleus import CellAndNucleus, drawn
from cytodisk.motion.temporal import tracked_angles
from cytodisk.motion.tracked_nucleus import (
    TrackedNucleus,
    first_nucleus,
    follow_nucleus,
    guide_from,
)
from cytodisk.motion.tracking import TrackedBoundary, first_boundary, follow, point_angles
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.scale import UNKNOWN, Scale

_HOLD = "--missing hold (missing='hold') takes the nucleus of the frame before"


def map_frame_with_nucleus(
    frame: int,
    found: CellAndNucleus,
    last: MappedFrame | None,
    settings: MovieSettings,
    scale: Scale = UNKNOWN,
) -> MappedFrame:
    """Map a cell and its nucleus so that both correspond to the frame before.

    Parameters
    ----------
    frame : int
        Number of the frame.
    found : CellAndNucleus
    last : MappedFrame or None
        The last frame that could be mapped; None for the first.
    settings : MovieSettings
    scale : Scale

    Returns
    -------
    MappedFrame

    Raises
    ------
    MaskError, ReadError
        The mask is not the mask of one cell, or its nucleus cannot be used.
    MapError
        No valid map was found.
    """
    cell, held = _mesh(frame, found, last, settings, scale)
    contour = Contour.of_outline(cell.outline + cell.corner)
    if last is None:
        align = align_of(cell, "nucleus") if settings.align == "nucleus" else settings.align
        angles = boundary_angles(contour.outline_yx, align)
        first = first_boundary(frame, contour, angles)
        disk = map_with_nucleus(cell, angles, settings, settings.nucleus_radius).disk
        return MappedFrame(disk, first, first, nucleus=first_nucleus(frame, disk))
    reference = reference_of(frame, last, settings)
    boundary = follow(frame, contour, last.boundary, reference, settings)
    angles = tracked_angles(contour, boundary.s, point_angles(len(boundary.s)))
    reference = boundary if boundary.restarted else reference
    nucleus, why = None, boundary.restarted
    if not why:
        nucleus = _followed(frame, cell, boundary, last, settings)
        why = nucleus.boundary.restarted
    if nucleus is None or why:
        disk = map_with_nucleus(cell, angles, settings, settings.nucleus_radius).disk
        nucleus = first_nucleus(frame, disk, boundary.alignment, why)
        return MappedFrame(disk, boundary, reference, nucleus=replace(nucleus, held=held))
    assert last.nucleus is not None
    before = last.boundary, last.nucleus
    guide = guide_from(cell, (contour, boundary), nucleus, last.disk, before, settings.inertia)
    made = map_with_nucleus(cell, angles, settings, settings.nucleus_radius, guide)
    nucleus = replace(nucleus, twist=made.twist, unwound=made.unwound, held=held)
    return MappedFrame(made.disk, boundary, reference, nucleus=nucleus)


def _followed(
    frame: int, cell: CellMesh, boundary: TrackedBoundary, last: MappedFrame, settings: MovieSettings
) -> TrackedNucleus:
    assert cell.nucleus_outline is not None
    assert last.nucleus is not None
    outline = Contour.of_outline(cell.nucleus_outline + cell.corner)
    return follow_nucleus(frame, outline, boundary, last.nucleus, settings)


def _mesh(
    frame: int, found: CellAndNucleus, last: MappedFrame | None, settings: MovieSettings, scale: Scale
) -> tuple[CellMesh, str]:
    """Mesh of the cell with its own nucleus, or with the last one's and why."""
    try:
        return mesh_cell(found.mask, settings, scale, _usable(found.nucleus), settings.several), ""
    except (NucleusError, ReadError) as fault:
        if settings.missing != "hold":
            if isinstance(fault, NucleusError) and last is not None:
                raise NucleusError(f"{fault}; {_HOLD}") from fault
            raise
        why = without_remedy(fault)
    if last is None:
        raise NucleusError(
            f"{why}, and no frame before has a nucleus that could be held: complete the nuclei, or leave the "
            "frame out"
        )
    try:
        held = found.with_nucleus(_held(frame, found.mask, last, settings))
        return mesh_cell(held.mask, settings, scale, held.nucleus, settings.several), why
    except NucleusError as fault:
        raise NucleusError(f"{why}; that of frame {last.frame} cannot be held: {fault}") from fault


def without_remedy(fault: CytodiskError) -> str:
    """What is wrong with a nucleus, without what to do about it; of files all that is said.

    Examples
    --------
    >>> without_remedy(NucleusError("the cell has 2 nuclei: take the largest with several='largest'"))
    'the cell has 2 nuclei'
    """
    return str(fault).partition(": ")[0] if isinstance(fault, NucleusError) else str(fault)


def _usable(nucleus: Any) -> Any:
    if isinstance(nucleus, CytodiskError):
        raise nucleus
    if nucleus is None or not np.any(nucleus):
        raise NucleusError("the cell has no nucleus in this frame")
    return nucleus


def _held(frame: int, mask: Any, last: MappedFrame, settings: MovieSettings) -> PlacedMask:
    """The last frame's nucleus, moved as the cell moved since."""
    corner, image_shape = (0, 0), np.shape(mask)
    if isinstance(mask, PlacedMask):
        mask, corner, image_shape = mask.box, mask.corner, mask.image_shape
    cell = PlacedMask.of(FilledMask.of(mask).filled, corner, image_shape)
    contour = Contour.of_outline(trace_outline(cell.box) + np.array(cell.corner, dtype=np.float64))
    here = follow(frame, contour, last.boundary, reference_of(frame, last, settings), settings)
    if here.restarted:
        raise NucleusError(f"the cell moved too far: {here.restarted}")
    assert last.disk.nucleus_outline_yx is not None
    assert last.disk.nucleus is not None
    outline = here.alignment.inverse(last.boundary.alignment(last.disk.nucleus_outline_yx))
    area = last.disk.nucleus.report.area_px
    moved = drawn(outline, area, (image_shape[0], image_shape[1]))
    if not moved.box.any():
        raise NucleusError("it lies outside the image")
    return moved
