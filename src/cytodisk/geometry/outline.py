"""Mask → outline: the closed polygon around a cell."""

import numpy as np
from numba import njit
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray
from cytodisk.errors import MaskError

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
    padded = _with_border(mask)
    outline = _first_outline(padded, pixel_edges(padded))
    if outline is None:
        _, pieces = ndimage.label(mask, structure=np.ones((3, 3)))
        _, outside = ndimage.label(~padded)
        outlines = pieces + outside - 1
        raise MaskError(f"mask has {outlines} outlines, not one: pass it through clean_mask first")
    return outline


def has_one_outline(mask: BoolArray) -> bool:
    """Whether a mask is one 8-connected piece without holes."""
    padded = _with_border(mask)
    return _first_outline(padded, pixel_edges(padded)) is not None


def _with_border(mask: BoolArray) -> BoolArray:
    """A mask with one more pixel outside of it on every side; `numpy.pad` takes ten times as long."""
    height, width = mask.shape
    padded = np.zeros((height + 2, width + 2), dtype=bool)
    padded[1:-1, 1:-1] = mask
    return padded


def pixel_edges(padded: BoolArray) -> int:
    """Number of edges between a pixel of the mask and one outside, of a mask with a border of these."""
    along, across = padded[1:] != padded[:-1], padded[:, 1:] != padded[:, :-1]
    return int(np.count_nonzero(along)) + int(np.count_nonzero(across))


def _first_outline(padded: BoolArray, n_edges: int) -> FloatArray | None:
    """Outline that starts below the last pixel; None if edges of pixels are left that it does not pass."""
    pixels = np.flatnonzero(padded)
    if not pixels.size:
        return None
    row, column = divmod(int(pixels[-1]), padded.shape[1])
    outline, passed = _follow_edges(padded, row, column, n_edges)
    return outline - 1.0 if passed == n_edges else None


@njit(cache=True)
def _follow_edges(padded: BoolArray, row: int, column: int, n_edges: int) -> tuple[FloatArray, int]:
    """Middles of the edges of pixels, from the one below a pixel once around; and how many were passed."""
    middles = np.empty((n_edges, 2))
    y, x = row, column  # a pixel of the mask
    out_y, out_x = 1, 0  # the way out of it,
    on_y, on_x = 0, -1  # and along the edge, with the mask on the right
    passed = 0
    while passed < n_edges:
        middles[passed, 0], middles[passed, 1] = y + 0.5 * out_y, x + 0.5 * out_x
        passed += 1
        if padded[y + on_y + out_y, x + on_x + out_x]:  # corners that touch are joined
            y, x = y + on_y + out_y, x + on_x + out_x
            out_y, out_x, on_y, on_x = -on_y, -on_x, out_y, out_x
        elif padded[y + on_y, x + on_x]:
            y, x = y + on_y, x + on_x
        else:
            out_y, out_x, on_y, on_x = on_y, on_x, -out_y, -out_x
        if y == row and x == column and out_y == 1:
            break
    return middles, passed


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
