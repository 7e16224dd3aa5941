"""The nuclei of the cells of a frame, with boxes to cut them out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray
from cytodisk.geometry.nucleus_mask import MOST_OUTSIDE
from cytodisk.geometry.nucleus_pieces import without_holes
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.label_boxes import Box, label_boxes
from cytodisk.images.nuclei.label_overlaps import LabelOverlaps
from cytodisk.images.nuclei.nucleus_match import NucleusMatch, check_nuclei, matches_of

_EIGHT = np.ones((3, 3), dtype=bool)


@dataclass(frozen=True, eq=False)
class FrameMatches:
    """The nuclei of the cells of a frame.

    Attributes
    ----------
    by_cell : dict of int to NucleusMatch
        By label.
    without_cell : tuple of NucleusMatch
        A nucleus each.
    nuclei : FramePixels
        Their labels.
    boxes : dict of int to Box
        By label of the nucleus.
    """

    by_cell: dict[int, NucleusMatch]
    without_cell: tuple[NucleusMatch, ...]
    nuclei: FramePixels
    boxes: dict[int, Box]


def match_frame(cells: FramePixels, nuclei: FramePixels) -> FrameMatches:
    """Match the nuclei of a frame with its cells.

    Holes of a cell count as part of it, as they do in its map: a nucleus often lies in one.

    Parameters
    ----------
    cells, nuclei : FramePixels
        Labels, of one height and width.

    Returns
    -------
    FrameMatches

    Raises
    ------
    NucleusError
        The nuclei are the cells' own masks, or the two are swapped.
    """
    boxes = dict(label_boxes(nuclei.strips()))
    overlaps = LabelOverlaps.of(_both(cells, nuclei))
    check_nuclei(overlaps)
    overlaps = _with_holes(overlaps, cells, nuclei, boxes)
    found = list(matches_of(overlaps))
    by_cell = {match.cell: match for match in found if match.cell is not None}
    strays = tuple(match for match in found if match.cell is None)
    return FrameMatches(by_cell, strays, nuclei, boxes)


def _both(
    cells: FramePixels, nuclei: FramePixels
) -> Iterator[tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]]:
    width = cells.image_shape[1]
    for first, strip in cells.strips():
        yield strip, nuclei.cut(slice(first, first + len(strip)), slice(0, width))[0]


def _with_holes(
    overlaps: LabelOverlaps, cells: FramePixels, nuclei: FramePixels, boxes: dict[int, Box]
) -> LabelOverlaps:
    """The same, where pixels of nuclei in a hole of a cell count as shared with it."""
    inside = np.zeros(len(overlaps.nuclei), dtype=np.int64)
    np.add.at(inside, overlaps.pairs[:, 1], overlaps.shared_px)
    open_nuclei = [
        boxes[int(label)] for label in overlaps.nuclei[inside < (1 - MOST_OUTSIDE) * overlaps.nucleus_px]
    ]
    if not open_nuclei:
        return overlaps
    sides = np.array([[rows.start, rows.stop, columns.start, columns.stop] for rows, columns in open_nuclei])
    added = []
    for label, (rows, columns) in label_boxes(cells.strips()):
        within = (sides[:, 0] > rows.start) & (sides[:, 1] < rows.stop)
        if (within & (sides[:, 2] > columns.start) & (sides[:, 3] < columns.stop)).any():
            cut = cells.cut(rows, columns)[0]
            hole = _holes(cut == label) & (cut == 0)
            found, counts = np.unique(nuclei.cut(rows, columns)[0][hole], return_counts=True)
            added += [[label, int(n), int(px)] for n, px in zip(found, counts, strict=True) if n]
    return overlaps.adding(np.array(added)) if added else overlaps


def _holes(cell: BoolArray) -> BoolArray:
    """Holes of the largest piece of a mask, which are part of its map."""
    pieces, count = ndimage.label(cell, structure=_EIGHT)
    if count > 1:
        cell = pieces == 1 + int(np.bincount(pieces.ravel())[1:].argmax())
    return without_holes(cell) & ~cell
