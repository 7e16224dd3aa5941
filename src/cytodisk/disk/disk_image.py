"""A signal of a cell as an image of the disk."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy import ndimage

from cytodisk.arrays import FloatArray
from cytodisk.checks import whole_number
from cytodisk.errors import SignalError
from cytodisk.geometry.placed_mask import PlacedMask


def image_on_disk(
    signal: Any,
    image_shape: tuple[int, ...],
    to_cell: Callable[[FloatArray], FloatArray],
    size: int,
    left_out: PlacedMask | None = None,
) -> FloatArray:
    """Read a signal at the place in the cell of each pixel of the disk, linear between pixels.

    Parameters
    ----------
    signal : array_like of shape (H, W)
    image_shape : (int, int)
        The shape that the signal must have.
    to_cell : callable
        From (u, v) to (row, column), both of shape (N, 2).
    size : int
        Pixels across the disk.
    left_out : PlacedMask, optional
        Pixels of the cell where the disk has no signal.

    Returns
    -------
    ndarray of shape (size, size) and dtype float
        See `DiskMap.image`.

    Raises
    ------
    SignalError
        The signal has another shape, or is not numeric.
    ParameterError
        `size` is below 1.
    """
    array = np.asarray(signal)
    if array.dtype.kind not in "biuf":
        raise SignalError(f"signal must be numeric, got dtype {array.dtype}")
    values = array.astype(np.float64, copy=False)
    if values.shape != image_shape:
        raise SignalError(
            f"signal has shape {values.shape}, the mask {image_shape}: pass one channel of one frame"
        )
    size = whole_number("size", size, 1, 100_000)
    axis = (np.arange(size) + 0.5) / size * 2.0 - 1.0
    v, u = np.meshgrid(axis, axis, indexing="ij")
    points = to_cell(np.column_stack([u.ravel(), v.ravel()]))
    inside = np.isfinite(points[:, 0])
    out = np.full(size * size, np.nan)
    if left_out is None:
        out[inside] = _between_pixels(values, points[inside])
    else:
        out[inside] = _beside(left_out, values, points[inside])
    return out.reshape(size, size)


def _between_pixels(values: FloatArray, points_yx: FloatArray) -> FloatArray:
    return np.asarray(ndimage.map_coordinates(values, points_yx.T, order=1, mode="nearest"))


def _beside(left_out: PlacedMask, values: FloatArray, points_yx: FloatArray) -> FloatArray:
    """Values from the pixels that count alone; NaN at the others."""
    gone, here = left_out.whole, left_out.holds(points_yx)
    known = _between_pixels(np.where(gone, 0.0, 1.0), points_yx)
    total = _between_pixels(np.where(gone, 0.0, values), points_yx)
    return np.where(here, np.nan, total / np.where(here, 1.0, known))
