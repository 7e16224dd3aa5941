"""The labels of a frame: which numbers can be labels, and where each lies."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.errors import EmptyMaskError, MaskError
from cytodisk.images.frame_pixels import FramePixels
from cytodisk.images.label_boxes import LabelBoxes, label_boxes

_LARGEST = int(np.iinfo(np.int64).max)  # tables hold labels as 64-bit integers with a sign


def check_labels(dtype: Any, values: Any, number: int) -> None:
    """Raise MaskError unless a frame has labels; `values` are some of it that hold the least and greatest."""
    if values is None or not np.issubdtype(dtype, np.integer):
        raise MaskError(f"labels must be whole numbers, got the type {dtype}: save the labels as uint16")
    if values.min() < 0:
        raise MaskError(
            f"frame {number} has negative labels (down to {values.min()}): set what is no cell to 0"
        )
    if int(values.max()) > _LARGEST:
        raise MaskError(f"frame {number} has labels up to {values.max()}: number the cells from 1")


def found_labels(frame: FramePixels, number: int) -> LabelBoxes:
    """The labels of a frame and their boxes; raises MaskError where it has none that can be used."""
    if not np.issubdtype(frame.dtype, np.integer):
        check_labels(frame.dtype, None, number)
    found = label_boxes(frame.strips())
    check_labels(frame.dtype, np.array([found.least, found.greatest], dtype=frame.dtype), number)
    if not (found.least or found.greatest):
        raise EmptyMaskError(f"frame {number} is empty: it holds no label")
    return found


def single_label(dtype: np.dtype[Any], greatest: Any, holds_cell: bool) -> int:
    """The label of a frame that holds just one; 1 for plain masks such as 0/1 and 0/255, 0 without a cell."""
    if not np.issubdtype(dtype, np.integer):
        return int(holds_cell)
    label = int(greatest)
    return 1 if label == np.iinfo(dtype).max else max(label, 0)
