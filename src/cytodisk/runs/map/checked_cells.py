"""A look at every mask of a run, and at its nucleus, without mapping it: `cytodisk check`."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray
from cytodisk.errors import CytodiskError
from cytodisk.geometry.mask import FilledMask, MaskReport
from cytodisk.geometry.nucleus_mask import fit_nucleus
from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.images.mask_files import SourceCell, read_source_cells
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_nuclei import CellNucleus, with_nucleus
from cytodisk.runs.cells.cell_parameters import CheckParameters
from cytodisk.runs.frame_rows import cell_status

Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True)
class CheckedCell:
    """What a look at a mask says.

    Attributes
    ----------
    found : SourceCell
    status : str
        "ok", or as `cell_status` calls the fault.
    reason : str
        Why it cannot be used; empty if it can.
    report : MaskReport or None
        What cleaning would change, and what speaks against this being the mask of one cell.
    nucleus : CellNucleus or None
        Which nuclei it has; None without a file of nuclei.
    nucleus_report : NucleusReport or None
        What fitting the nucleus into the cell would change.
    centre_yx : (float, float) or None
        Middle of its pixels, in the image; of the image where it has none.
    pieces_yx : (float, float) or None
        The same of the largest piece that is dropped.
    """

    found: SourceCell
    status: str
    reason: str
    report: MaskReport | None
    nucleus: CellNucleus | None = None
    nucleus_report: NucleusReport | None = None
    centre_yx: Point | None = None
    pieces_yx: Point | None = None


def check_cells(inputs: CellInputs) -> Iterator[CheckedCell]:
    """Look at every mask without mapping it.

    Parameters
    ----------
    inputs : CellInputs
        Its parameters say what becomes of holes, of several nuclei, and of none (`CheckParameters`).

    Yields
    ------
    CheckedCell
    """
    how = inputs.parameters.part(CheckParameters)
    for found, nucleus in _with_nuclei(inputs):
        fault = found.fault or inputs.signals[found.source].fault
        bare = replace(found, mask=None)
        report = of_nucleus = pieces = None
        if fault is None:
            try:
                cell = FilledMask.of(found.mask)
                report = cell.report
                pieces = _largest_dropped(found, cell)
                fitted, of_nucleus = _fitted(cell.filled, nucleus, how)
                report = cell.under(how.holes, fitted).report
            except CytodiskError as error:
                fault = error
        status, reason = ("ok", "") if fault is None else (cell_status(fault), str(fault))
        yield CheckedCell(bare, status, reason, report, nucleus, of_nucleus, _centre(found), pieces)


def _centre(found: SourceCell) -> Point:
    """Middle of the pixels of a cell; of the image where there are none."""
    mask = found.refused if found.mask is None else found.mask
    points = np.argwhere(mask) if mask is not None else np.empty((0, 2))
    if not len(points):
        return (found.image_shape[0] - 1) / 2, (found.image_shape[1] - 1) / 2
    y, x = points.mean(axis=0) + found.corner
    return float(y), float(x)


def _largest_dropped(found: SourceCell, cell: FilledMask) -> Point | None:
    """Middle of the largest of the pieces that are no part of the cell."""
    if cell.report.components < 2:
        return None
    pieces, _ = ndimage.label((np.asarray(found.mask) != 0) & ~cell.filled, np.ones((3, 3)))
    largest = int(np.bincount(pieces.ravel())[1:].argmax()) + 1
    y, x = np.argwhere(pieces == largest).mean(axis=0) + found.corner
    return float(y), float(x)


def _with_nuclei(inputs: CellInputs) -> Iterator[tuple[SourceCell, CellNucleus | None]]:
    """The cells, each with its nucleus; the nuclei of an image are matched once."""
    sources = {source.name: source for source in inputs.sources}
    of_image: tuple[str, int] | None = None
    for found in read_source_cells(inputs.sources):
        nuclei = inputs.nuclei.get(found.source)
        if nuclei is None:
            yield found, None
            continue
        is_first = of_image != (found.source, found.frame)
        if is_first:
            of_image = found.source, found.frame
            matches = nuclei.matches(sources[found.source], found.frame)
        yield with_nucleus(found, matches, is_first)


def _fitted(
    mask: BoolArray, nucleus: CellNucleus | None, how: CheckParameters
) -> tuple[BoolArray | None, NucleusReport | None]:
    """The nucleus in its cell, and what fitting changes; raises NucleusError where it does not fit."""
    if nucleus is None:
        return None, None
    if (fault := nucleus.refusal(how.missing)) is not None:
        raise fault
    if nucleus.labels is None:
        return None, None
    return fit_nucleus(mask, nucleus.labels, several=how.several)
