"""What is seen of a frame of a mask file in one pass over its pixels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from cytodisk.arrays import AnyArray
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.label_boxes import value_runs

BACKGROUND_SHARE = 0.75
"""Share of the image's border that has one value, from which on this value is that of the background."""


@dataclass(frozen=True, eq=False)
class FrameSight:
    """What is seen of a frame.

    Attributes
    ----------
    number : int
    dtype : numpy.dtype
    values : ndarray of shape (N,)
        All values, sorted.
    held : (bool, bool, bool, bool)
        Whether anything but 0 lies in the first row, the last row, the first column and the last column.
    around : (value, float)
        The value that most of the image's border has, and its share of the border.
    """

    number: int
    dtype: np.dtype[Any]
    values: AnyArray
    held: tuple[bool, bool, bool, bool]
    around: tuple[Any, float]

    @property
    def cells(self) -> AnyArray:
        """Values beside 0."""
        return np.asarray(self.values[self.values != 0])

    @property
    def is_whole(self) -> bool:
        """Whether all values are whole numbers, however they are stored."""
        if self.values.dtype.kind != "f":
            return True
        return bool(np.isfinite(self.values).all() and (self.values == np.rint(self.values)).all())


def see_frame(frame: FramePixels, number: int) -> FrameSight:
    """Look at all pixels of a frame, strip after strip.

    Parameters
    ----------
    frame : FramePixels
    number : int
        Of the frame.
    """
    values, left, right = [], [], []
    first: AnyArray | None = None
    last: AnyArray | None = None
    for _, strip in frame.strips():
        values.append(np.unique(value_runs(strip).values))
        left.append(strip[:, 0].copy())
        right.append(strip[:, -1].copy())
        first = strip[0].copy() if first is None else first
        last = strip[-1]
    assert first is not None  # a frame has a row at least
    assert last is not None
    sides = (first, last.copy(), np.concatenate(left), np.concatenate(right))
    top, bottom, *others = (bool((side != 0).any()) for side in sides)
    found, counts = np.unique(np.concatenate(sides), return_counts=True)
    most = int(counts.argmax())
    around = found[most].item(), float(counts[most] / counts.sum())
    return FrameSight(
        number, frame.dtype, np.unique(np.concatenate(values)), (top, bottom, others[0], others[1]), around
    )
