"""Boxes of the cells of a frame, in one pass over its strips."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple, TypeAlias

import numpy as np

from cytodisk.arrays import AnyArray, IntArray

Strips: TypeAlias = Iterable[tuple[int, np.ndarray[Any, Any]]]
"""Number of the first row and pixels, strip after strip of a frame."""


Box: TypeAlias = tuple[slice, slice]
"""Rows and columns."""


class Runs(NamedTuple):
    """Pixels of one value side by side in a row."""

    values: AnyArray
    starts: IntArray
    ends: IntArray


@dataclass(frozen=True, eq=False)
class LabelBoxes:
    """The labels of a frame and their boxes.

    Attributes
    ----------
    least, greatest : int
        Of all values, 0 among them.
    labels : ndarray of shape (N,)
        Sorted, without 0.
    boxes : ndarray of shape (N, 4) and dtype int
        First row, row after the last, first column, column after the last.
    """

    least: int
    greatest: int
    labels: AnyArray
    boxes: IntArray

    def __iter__(self) -> Iterator[tuple[int, Box]]:
        """Label and box, by label."""
        for label, (top, bottom, left, right) in zip(self.labels.tolist(), self.boxes.tolist(), strict=True):
            yield label, (slice(top, bottom), slice(left, right))


def label_boxes(strips: Strips) -> LabelBoxes:
    """Find all labels of a frame and their boxes.

    Parameters
    ----------
    strips : iterable of (int, ndarray of shape (h, W))

    Returns
    -------
    LabelBoxes
    """
    labels, boxes, extremes = [], [], []
    for first, strip in strips:
        if not strip.any():  # most of a large image, and quickly seen
            extremes += [0, 0]
            continue
        runs = value_runs(strip)
        extremes += [int(runs.values.min()), int(runs.values.max())]
        kept = np.flatnonzero(runs.values != 0)
        if not kept.size:
            continue
        row, left = np.divmod(runs.starts[kept], strip.shape[1])
        right = left + runs.ends[kept] - runs.starts[kept]
        found, box = _extents(runs.values[kept], np.column_stack([row, row + 1, left, right]))
        labels.append(found)
        boxes.append(box + np.array([first, first, 0, 0]))
    if not labels:
        return LabelBoxes(min(extremes), max(extremes), np.empty(0, np.int64), np.empty((0, 4), np.int64))
    return LabelBoxes(min(extremes), max(extremes), *_extents(np.concatenate(labels), np.concatenate(boxes)))


def cell_box(strips: Strips) -> tuple[Box | None, Any]:
    """Box of all pixels of a frame that are not 0, None without any; and the greatest value, 0 at least."""
    greatest: Any = 0
    rows: list[int] = []
    columns: list[int] = []
    for first, strip in strips:
        held = strip != 0
        if held.any():
            there = np.flatnonzero(held.any(axis=1)) + first
            across = np.flatnonzero(held.any(axis=0))
            rows += [int(there[0]), int(there[-1])]
            columns += [int(across[0]), int(across[-1])]
        greatest = max(greatest, strip.max(initial=0).item())
    if not rows:
        return None, greatest
    return (slice(min(rows), max(rows) + 1), slice(min(columns), max(columns) + 1)), greatest


def with_margin(box: Box, shape: tuple[int, int]) -> Box:
    """A box with one more pixel on every side where the image goes on."""
    rows, columns = (
        slice(max(side.start - 1, 0), min(side.stop + 1, size)) for side, size in zip(box, shape, strict=True)
    )
    return rows, columns


def value_runs(strip: np.ndarray[Any, Any]) -> Runs:
    """Runs of one value in each row of a strip, row after row."""
    begins = np.ones(strip.shape, dtype=bool)
    np.not_equal(strip[:, 1:], strip[:, :-1], out=begins[:, 1:])
    starts = np.flatnonzero(begins)
    return Runs(strip[begins], starts, np.append(starts[1:], strip.size))


def _extents(labels: AnyArray, boxes: IntArray) -> tuple[AnyArray, IntArray]:
    """Each label once, with the box around all of its boxes."""
    order = np.argsort(labels, kind="stable")
    labels, boxes = labels[order], boxes[order]
    first = np.flatnonzero(np.append(True, labels[1:] != labels[:-1]))
    low, high = np.minimum.reduceat(boxes, first), np.maximum.reduceat(boxes, first)
    return labels[first], np.column_stack([low[:, 0], high[:, 1], low[:, 2], high[:, 3]])
