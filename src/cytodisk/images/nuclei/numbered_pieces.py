"""The pieces of a mask as labels, kept as runs of pixels in rows, so that memory goes by the pieces."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components

from cytodisk.arrays import IntArray
from cytodisk.images.evidence.frame_labels import single_label
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.label_boxes import cell_box, value_runs


def numbered_pieces(frame: FramePixels) -> FramePixels:
    """Number the pieces (8-connected) of what is not 0 in a frame, by their first pixel, from 1.

    Parameters
    ----------
    frame : FramePixels
        Its first channel counts.

    Returns
    -------
    FramePixels
        Labels of dtype int32.

    Raises
    ------
    ReadError
        The frame is damaged.
    """
    runs = np.concatenate([np.empty((0, 3), dtype=np.int64), *_runs(frame)])
    rows, first, after = runs.T
    starts = np.searchsorted(rows, np.arange(frame.image_shape[0] + 1))
    pieces = _RunPieces(first, after, starts, _numbers(runs, starts))
    return FramePixels((1, *frame.image_shape), np.dtype(np.int32), pieces.cut)


def mask_labels(frame: FramePixels) -> FramePixels:
    """Labels of a frame with one value beside 0: the numbers of its pieces; a single one keeps its value.

    Parameters
    ----------
    frame : FramePixels

    Returns
    -------
    FramePixels

    Raises
    ------
    ReadError
        The frame is damaged.
    """
    numbered = numbered_pieces(frame)
    box, greatest = cell_box(frame.strips())
    own = single_label(frame.dtype, greatest, box is not None)
    if own < 2 or box is None or numbered.cut(*box).max() > 1:
        return numbered
    return frame


@dataclass(frozen=True, eq=False)
class _RunPieces:
    """Runs of pixels, row after row: first column, column after the last, and number of the piece."""

    first: IntArray
    after: IntArray
    starts: IntArray  # number of the first run of each row, and the number of all
    piece: IntArray

    def cut(self, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        """Labels of some rows and columns, shape (1, h, w)."""
        left, width = columns.start, columns.stop - columns.start
        labels = np.zeros((1, rows.stop - rows.start, width), dtype=np.int32)
        for row in range(rows.start, rows.stop):
            line = labels[0, row - rows.start]
            for run in range(self.starts[row], self.starts[row + 1]):
                line[max(self.first[run] - left, 0) : max(self.after[run] - left, 0)] = self.piece[run]
        return labels


def _runs(frame: FramePixels) -> Iterator[IntArray]:
    """Row, first column and column after the last of each run, shape (N, 3)."""
    for top, strip in frame.strips():
        if not strip.any():
            continue
        held = strip != 0
        runs = value_runs(held)
        row, first = np.divmod(runs.starts[runs.values], strip.shape[1])
        length = runs.ends[runs.values] - runs.starts[runs.values]
        yield np.column_stack([row + top, first, first + length])


def _numbers(runs: IntArray, starts: IntArray) -> IntArray:
    """Number of the piece of each run: those that touch in neighbouring rows, also at a corner, are one."""
    rows, first, after = runs.T
    # Runs of the next row that touch are those from the first that ends at this one's start or later.
    width = int(after.max(initial=0)) + 2
    begin = np.searchsorted(rows * width + after, (rows + 1) * width + first, side="left")
    end = np.searchsorted(rows * width + first, (rows + 1) * width + after, side="right")
    count = np.maximum(end - begin, 0)
    one = np.repeat(np.arange(len(runs)), count)
    other = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count) + np.repeat(begin, count)
    touching = sparse.coo_array((np.ones(len(one), dtype=bool), (one, other)), shape=(len(runs), len(runs)))
    _, piece = connected_components(touching, directed=False)
    _, firsts, place = np.unique(piece, return_index=True, return_inverse=True)
    order = np.empty(len(firsts), dtype=np.int64)
    order[np.argsort(firsts)] = np.arange(1, len(firsts) + 1)
    numbers: IntArray = order[place.ravel()]
    return numbers
