"""Mask → outline: the closed polygon around a cell."""

import numpy as np
from skimage.measure import find_contours

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import MaskError
from cytodisk.geometry.polygon import signed_area

_BORDER_PX = 0.25  # outlines lie half a pixel outside the first row if they are cut off, inside if not


def trace_outline(mask: BoolArray) -> FloatArray:
    """Outline of a cleaned mask: its iso-line at 0.5, half-way between inner and outer pixels.

    Pixels that touch at a corner only are joined, so every pixel centre lies strictly inside, and no two
    points of the outline coincide: the polygon is simple.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool
        One 8-connected piece without holes, as `clean_mask` returns it.

    Returns
    -------
    ndarray of shape (N, 2) and dtype float
        (row, column) in pixels, pixel centres at integers, from +x towards +y, last point not repeated.

    Raises
    ------
    MaskError
        The mask is empty, in several pieces or has holes.
    """
    contours = find_contours(  # type: ignore[no-untyped-call,unused-ignore]
        np.pad(mask, 1).astype(np.float64), 0.5, fully_connected="high"
    )
    if len(contours) != 1:
        raise MaskError(f"mask has {len(contours)} outlines, not one: pass it through clean_mask first")
    outline: FloatArray = contours[0][:-1] - 1.0
    return outline if signed_area(outline) > 0 else outline[::-1].copy()


def on_border(points_yx: FloatArray, image_shape: tuple[int, int]) -> BoolArray:
    """Whether points of an outline lie where the image's border cuts a cell off, shape (N,); NaN does not.

    Parameters
    ----------
    points_yx : ndarray of shape (N, 2) and dtype float
        (row, column) in pixels.
    image_shape : (int, int)
        (H, W).
    """
    last = np.array(image_shape) - 1.0
    return np.asarray(((points_yx < _BORDER_PX) | (points_yx > last - _BORDER_PX)).any(axis=-1))
