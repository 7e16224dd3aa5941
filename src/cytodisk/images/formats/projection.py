"""Slices of a z-stack as one image."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np


def projected(slices: Iterable[np.ndarray[Any, Any]], z: int | str) -> np.ndarray[Any, Any]:
    """Slices of a z-stack made one image, with one or two of them in memory.

    Parameters
    ----------
    slices : iterable of ndarray
    z : int, "max" or "mean"
        A mean is float32; a number stands for a single slice.
    """
    image: np.ndarray[Any, Any] | None = None
    count = 0
    for piece in slices:
        count += 1
        if image is None:
            image = piece.astype(np.float64) if z == "mean" else piece
        elif z == "mean":
            image += piece
        else:
            np.maximum(image, piece, out=image)
    assert image is not None  # a slice is always taken
    return (image / count).astype(np.float32) if z == "mean" else image
