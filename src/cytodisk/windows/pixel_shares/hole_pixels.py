"""Pixels of a cell that its windows leave out: those of holes in its mask."""

from __future__ import annotations

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.windows.pixel_shares.shares import NOWHERE, Subpixels

_EIGHT = np.ones((3, 3), dtype=bool)


def hole_pixels(placed: PlacedMask, holes: PlacedMask | None) -> BoolArray | None:
    """Which pixels of a mask are excluded holes, in row-major order; None if there are none.

    Parameters
    ----------
    placed : PlacedMask
        The filled mask.
    holes : PlacedMask or None
        In the same box.
    """
    return None if holes is None else holes.box[placed.box]


def without_pixels(subpixels: Subpixels, left_out: BoolArray, n_windows: int) -> tuple[Subpixels, FloatArray]:
    """Windows of subpixels without those of some pixels.

    Parameters
    ----------
    subpixels : Subpixels
    left_out : ndarray of shape (pixels,) and dtype bool
    n_windows : int

    Returns
    -------
    subpixels : Subpixels
        The pixels that are left out are in no window.
    area : ndarray of shape (windows,) and dtype float
        What each window loses, in square pixels.
    """
    _, window, share = _parts(subpixels, left_out)
    area: FloatArray = np.bincount(window, weights=share, minlength=n_windows).astype(np.float64)
    whole = np.where(left_out, NOWHERE, subpixels.whole).astype(np.int32)
    lengths, kept = np.diff(subpixels.start), ~left_out[subpixels.divided]
    start = np.concatenate([[0], np.cumsum(lengths[kept])])
    return Subpixels(whole, start, subpixels.window[np.repeat(kept, lengths)]), area


def pixels_beside(
    subpixels: Subpixels, placed: PlacedMask, left_out: BoolArray, windows: IntArray, more: IntArray
) -> IntArray:
    """Pixels of the cell beside those of holes that some windows lie in.

    Parameters
    ----------
    subpixels : Subpixels
        Of the filled mask.
    placed : PlacedMask
    left_out : ndarray of shape (pixels,) and dtype bool
        Pixels of holes.
    windows : ndarray of shape (N,) and dtype int
        Numbers of windows.
    more : ndarray of shape (M,) and dtype int
        Numbers of more pixels of holes that count.

    Returns
    -------
    ndarray of shape (P,) and dtype int
        Their numbers, ascending.
    """
    number, window, _ = _parts(subpixels, left_out)
    touched = np.zeros(len(left_out), dtype=bool)
    touched[number[np.isin(window, windows)]] = True
    touched[more] = True
    box = np.zeros(placed.box.shape, dtype=bool)
    box[placed.box] = touched
    around = ndimage.binary_dilation(box, _EIGHT)[placed.box]
    return np.flatnonzero(around & ~left_out)


def _parts(subpixels: Subpixels, of: BoolArray) -> tuple[IntArray, Int32Array, FloatArray]:
    """Parts of some pixels that lie in windows: number of the pixel, window, area."""
    whole = np.flatnonzero(of & (subpixels.whole >= 0))
    lengths, divided = np.diff(subpixels.start), subpixels.divided
    wanted = np.repeat(of[divided], lengths) & (subpixels.window >= 0)
    number, share = np.repeat(divided, lengths)[wanted], np.repeat(1.0 / lengths, lengths)[wanted]
    return (
        np.concatenate([whole, number]),
        np.concatenate([subpixels.whole[whole], subpixels.window[wanted]]),
        np.concatenate([np.ones(len(whole)), share]),
    )
