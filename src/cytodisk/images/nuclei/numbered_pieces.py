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
    return _RunPieces.of(frame).labels(frame)


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
    pieces = _RunPieces.of(frame)
    box, greatest = cell_box(frame.strips())
    own = single_label(frame.dtype, greatest, box is not None)
    return frame if own > 1 and pieces.piece.max(initial=0) == 1 else pieces.labels(frame)


@dataclass(frozen=True, eq=False)
class _RunPieces:
    """Runs of pixels, row after row: first column, column after the last, and number of the piece."""

    first: IntArray
    after: IntArray
    starts: IntArray  # number of the first run of each row, and the number of all
    piece: IntArray

    @classmethod
    def of(cls, frame: FramePixels) -> _RunPieces:
        """The pieces of what is not 0 in a frame, numbered by their first pixel."""
        runs = np.concatenate([np.empty((0, 3), dtype=np.int64), *_runs(frame)])
        rows, first, after = runs.T
        starts = np.searchsorted(rows, np.arange(frame.image_shape[0] + 1))
        return cls(first, after, starts, _numbers(runs))

    def labels(self, frame: FramePixels) -> FramePixels:
        """The numbers as a frame of the same size."""
        return FramePixels((1, *frame.image_shape), np.dtype(np.int32), self.cut)

    def cut(self, rows: slice, columns: slice) -> np.ndarray[Any, Any]:
        """Labels of some rows and columns, shape (1, h, w)."""
        height, width = rows.stop - rows.start, columns.stop - columns.start
        some = slice(self.starts[rows.start], self.starts[rows.stop])
        in_row = np.diff(self.starts[rows.start : rows.stop + 1])
        row_start = np.repeat(np.arange(height) * width, in_row)
        first = row_start + np.clip(self.first[some] - columns.start, 0, width)
        length = np.minimum(self.after[some], columns.stop) - np.maximum(self.first[some], columns.start)
        inside = length > 0
        first, length = first[inside], length[inside]
        ends = np.cumsum(length)
        pixels = np.repeat(first - ends + length, length) + np.arange(length.sum())
        labels = np.zeros(height * width, dtype=np.int32)
        labels[pixels] = np.repeat(self.piece[some][inside], length)
        return labels.reshape(1, height, width)


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


def _numbers(runs: IntArray) -> IntArray:
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
