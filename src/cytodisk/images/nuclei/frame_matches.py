"""The nuclei of the cells of a frame, with boxes to cut them out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, IntArray
from cytodisk.geometry.nucleus_mask import MOST_OUTSIDE
from cytodisk.geometry.nucleus_pieces import without_holes
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.label_boxes import Box, label_boxes
from cytodisk.images.nuclei.label_overlaps import LabelOverlaps
from cytodisk.images.nuclei.nucleus_match import NucleusMatch, check_nuclei, matches_of

_EIGHT = np.ones((3, 3), dtype=bool)
_NEAR_PX = 2  # between a nucleus and the mask of a cytoplasm that is open there


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
    beside = {label: boxes[label] for stray in strays for label in stray.nuclei}
    by_cell = _told_of_neighbours(cells, nuclei, beside, by_cell)
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
    in_holes = []
    for label, (rows, columns) in label_boxes(cells.strips()):
        within = (sides[:, 0] > rows.start) & (sides[:, 1] < rows.stop)
        if (within & (sides[:, 2] > columns.start) & (sides[:, 3] < columns.stop)).any():
            cut = cells.cut(rows, columns)[0]
            filled, hole = _filled_and_holes(cut == label)
            found = nuclei.cut(rows, columns)[0]
            y, x = np.nonzero(hole & (cut == 0) & (found != 0))
            pixels = (y + rows.start) * cells.image_shape[1] + x + columns.start
            in_holes.append((int(filled.sum()), label, pixels, found[y, x]))
    added = _of_innermost(in_holes)
    return overlaps.adding(added) if len(added) else overlaps


def _of_innermost(in_holes: list[tuple[int, int, IntArray, IntArray]]) -> IntArray:
    """Label of the cell, of the nucleus, and pixels in its holes, shape (P, 3).

    A pixel in holes of several cells, one in another, is the innermost cell's.

    Parameters
    ----------
    in_holes : list of (int, int, ndarray of shape (n,), ndarray of shape (n,))
        Of each cell its area with holes, its label, and the pixels of nuclei in its holes with their labels.
    """
    in_holes = sorted(in_holes, key=lambda of_cell: of_cell[0])
    if not in_holes:
        return np.empty((0, 3), dtype=np.int64)
    cells = np.concatenate([np.full(len(pixels), label) for _, label, pixels, _ in in_holes])
    labels = np.concatenate([labels for *_, labels in in_holes])
    _, first = np.unique(np.concatenate([pixels for _, _, pixels, _ in in_holes]), return_index=True)
    pairs = np.column_stack([cells[first], labels[first]]).astype(np.int64)
    found, counts = np.unique(pairs, axis=0, return_counts=True)
    return np.column_stack([found, counts])


def _filled_and_holes(cell: BoolArray) -> tuple[BoolArray, BoolArray]:
    """The largest piece of a mask without holes, and its holes, which are part of its map."""
    pieces, count = ndimage.label(cell, structure=_EIGHT)
    if count > 1:
        cell = pieces == 1 + int(np.bincount(pieces.ravel())[1:].argmax())
    filled = without_holes(cell)
    return filled, filled & ~cell


def _told_of_neighbours(
    cells: FramePixels, nuclei: FramePixels, boxes: dict[int, Box], by_cell: dict[int, NucleusMatch]
) -> dict[int, NucleusMatch]:
    """Reasons of cells without a nucleus that lie around one, as masks of an open cytoplasm do."""
    told = dict(by_cell)
    for nucleus, (rows, columns) in boxes.items():
        around = tuple(
            slice(max(side.start - _NEAR_PX, 0), min(side.stop + _NEAR_PX, length))
            for side, length in zip((rows, columns), cells.image_shape, strict=True)
        )
        own, cut = nuclei.cut(*around)[0] == nucleus, cells.cut(*around)[0]
        edge = own & ~ndimage.binary_erosion(own, _EIGHT)
        for cell in np.unique(cut[cut != 0]).tolist():
            near = ndimage.binary_dilation(cut == cell, _EIGHT, iterations=_NEAR_PX)
            if 2 * (edge & near).sum() > edge.sum() and told[cell].status == "none":
                reason = (
                    f"no nucleus lies in the cell, but nucleus {nucleus} beside it: a mask of the cytoplasm "
                    "that is open there needs the nucleus added (cells | nuclei)"
                )
                told[cell] = replace(told[cell], reason=reason)
    return told
