"""What a map's file holds of a nucleus."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict
from typing import Annotated, Any

import numpy as np
from pydantic import ConfigDict, Field, with_config
from typing_extensions import TypedDict

from cytodisk.array_archive import ArrayArchive
from cytodisk.arrays import FloatArray, IntArray
from cytodisk.disk.nucleus.cone import MOST_LIFT
from cytodisk.disk.nucleus.nucleus import Nucleus
from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.geometry.placed_mask import PlacedMask

_Count = Annotated[int, Field(ge=0, lt=2**53)]
_STRICT = ConfigDict(strict=True, allow_inf_nan=False)


@with_config(_STRICT)
class _NucleusReport(TypedDict):
    area_px: _Count
    n_nuclei: _Count
    dropped_px: _Count
    holes: _Count
    filled_px: _Count
    outside_px: _Count
    clipped_px: _Count
    clipped_share: Annotated[float, Field(ge=0, le=1)]
    joined_px: _Count


@with_config(_STRICT)
class NucleusHeader(TypedDict):
    """The part of a map's header that tells of its nucleus."""

    radius: Annotated[float, Field(gt=0, lt=1)]
    corner: Annotated[list[_Count], Field(min_length=2, max_length=2)]
    report: _NucleusReport


def nucleus_header(nucleus: Nucleus) -> dict[str, Any]:
    """Numbers of a nucleus that can be written as JSON."""
    return {
        "radius": nucleus.radius,
        "corner": nucleus.placed_mask.corner,
        "report": asdict(nucleus.report),
    }


def nucleus_arrays(nucleus: Nucleus) -> dict[str, Any]:
    """Arrays of a nucleus that compression makes smaller; `nucleus_places` are not among them."""
    return {
        "nucleus_boundary": nucleus.boundary,
        "nucleus_inside": nucleus.inside,
        "nucleus_lifts": nucleus.lifts,
        "nucleus_mask": nucleus.placed_mask.box,
    }


def read_nucleus(
    archive: ArrayArchive, header: Mapping[str, Any], arrays: Mapping[str, Any], cell: PlacedMask
) -> Nucleus:
    """Nucleus of a map's file, checked so far that kernels can take it; the certificate says the rest.

    Parameters
    ----------
    archive : ArrayArchive
    header : dict
        A `NucleusHeader`.
    arrays : dict of str to ndarray
        Of the map.
    cell : PlacedMask
        Its mask.

    Returns
    -------
    Nucleus
    """
    n_vertices, triangles = len(arrays["vertices_yx"]), arrays["triangles"]
    places = archive.floats("nucleus_places", (n_vertices, 2), low=-2.0, high=2.0)
    boundary = archive.integers("nucleus_boundary", (None,), least=0, most=n_vertices - 1)
    lifts = archive.integers("nucleus_lifts", triangles.shape, least=-MOST_LIFT, most=MOST_LIFT)
    inside = archive.truths("nucleus_inside", (len(triangles),), most=(len(triangles),))
    if len(boundary) < 3 or not inside.any() or inside.all():
        raise archive.fault("nucleus_boundary", "does not divide the cell into cytoplasm and nucleus")
    if not _increase(places[boundary, 1]):
        raise archive.fault("nucleus_places", "of the nuclear outline do not run once around the disk")
    box = archive.truths("nucleus_mask", (None, None), most=cell.box.shape)
    placed = PlacedMask(box, tuple(header["corner"]), cell.image_shape)
    _check_place(archive, placed, cell)
    report = NucleusReport(**header["report"])
    return Nucleus(header["radius"], boundary, inside, places, lifts, placed, report)


def _increase(turns: FloatArray) -> bool:
    """Whether turns go around once, as far as floating point tells."""
    steps = np.mod(np.roll(turns, -1) - turns, 1.0)
    return bool((steps > 0.0).all() and abs(steps.sum() - 1.0) < 1e-9 and steps.max() < 0.5)


def _check_place(archive: ArrayArchive, nucleus: PlacedMask, cell: PlacedMask) -> None:
    low: IntArray = np.subtract(nucleus.corner, cell.corner)
    high = low + nucleus.box.shape
    if (low < 0).any() or (high > cell.box.shape).any():
        raise archive.fault("nucleus_mask", "does not lie in the cell's")
    within = cell.box[low[0] : high[0], low[1] : high[1]]
    if not nucleus.box.any() or (nucleus.box & ~within).any():
        raise archive.fault("nucleus_mask", "is not part of the cell's")
