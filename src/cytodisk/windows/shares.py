"""How much of each pixel belongs to each window, and where in it, from subpixels."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy import sparse

from cytodisk.arrays import FloatArray, Int32Array, IntArray

PER_SIDE = 4  # subpixels along the side of a pixel
PIXELS_AT_ONCE = 4096  # whose subpixels stay in the cache


@dataclass(frozen=True, eq=False)
class WindowShares:
    """Shares of a cell's pixels in its windows, and the first and second moments of windows.

    Attributes
    ----------
    weights : csr_array of shape (windows, pixels)
        Pixels of the mask in row-major order. Columns sum to 1 at most, rows to the window's area in square
        pixels.
    moments : ndarray of shape (windows, 5) and dtype float
        Integrals of y, x, y², x², x y over each window, each subpixel a square of its own side.
        Places are relative to `origin_yx`.
    origin_yx : ndarray of shape (2,) and dtype int
        First row and column of the mask's box, so that moments do not depend on where in an image a cell is.
    subpixels : sequence of Subpixels
        What the shares were gathered from; empty where it is not kept.
    """

    weights: sparse.csr_array
    moments: FloatArray
    origin_yx: IntArray
    subpixels: Sequence[Subpixels] = ()


@dataclass(frozen=True, eq=False)
class Subpixels:
    """Window of each subpixel of some pixels.

    Attributes
    ----------
    pixel : ndarray of shape (P,) and dtype int
        Numbers of the pixels.
    window : ndarray of shape (P, subpixels) and dtype int
        The subpixels are squares, row by row; -1 for a subpixel in no window.
    share : ndarray of shape (P,) and dtype float
        Area of each subpixel, in square pixels.
    """

    pixel: IntArray
    window: IntArray | Int32Array
    share: FloatArray

    @property
    def blocks(self) -> Iterator[Subpixels]:
        """The same, a few pixels at a time."""
        for first in range(0, len(self.pixel), PIXELS_AT_ONCE):
            block = slice(first, first + PIXELS_AT_ONCE)
            yield Subpixels(self.pixel[block], self.window[block], self.share[block])


def strips(pixels_yx: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Numbers and places of a few neighbouring pixels at a time: their subpixels need little memory."""
    for first in range(0, len(pixels_yx), PIXELS_AT_ONCE):
        block = pixels_yx[first : first + PIXELS_AT_ONCE]
        yield np.arange(first, first + len(block)), block


def shares_by_strips(
    pixels_yx: IntArray, n_windows: int, windows_of_subpixels: Callable[[IntArray], IntArray]
) -> WindowShares:
    """Shares where all pixels are divided into 4×4 subpixels, which are not kept.

    Parameters
    ----------
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column) of the mask's pixels in row-major order.
    n_windows : int
    windows_of_subpixels : callable
        From places of pixels, (p, 2), to the windows of their subpixels, (p, 16); -1 for none.

    Returns
    -------
    WindowShares
    """
    size = PER_SIDE**2
    subpixels = (
        Subpixels(number, windows_of_subpixels(block), np.full(len(number), 1.0 / size))
        for number, block in strips(pixels_yx)
    )
    return gather_shares(pixels_yx, n_windows, subpixels)


def gather_shares(pixels_yx: IntArray, n_windows: int, subpixels: Iterable[Subpixels]) -> WindowShares:
    """Shares and moments from the windows of subpixels.

    Parameters
    ----------
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column) of the mask's pixels in row-major order.
    n_windows : int
    subpixels : iterable of Subpixels
        A sequence is kept.

    Returns
    -------
    WindowShares
    """
    origin = pixels_yx.min(axis=0)
    moments = np.zeros((n_windows, 5))
    entries = [
        _gather(some.pixel, pixels_yx[some.pixel] - origin, some.window, some.share, moments)
        for all_of_them in subpixels
        for some in all_of_them.blocks
    ]
    window, pixel, share = (np.concatenate(column) for column in zip(*entries, strict=True))
    shape = (n_windows, len(pixels_yx))
    weights = sparse.csr_array(sparse.coo_array((share, (window, pixel)), shape=shape))
    kept = subpixels if isinstance(subpixels, Sequence) else ()
    return WindowShares(weights, moments, origin, kept)


@njit(cache=True)
def _gather(
    pixel: IntArray,
    places_yx: IntArray,
    window: IntArray | Int32Array,
    share: FloatArray,
    moments: FloatArray,
) -> tuple[IntArray, IntArray, FloatArray]:
    """Window, pixel and weight, one entry for each pair of them; the moments are added to."""
    count, subpixels = window.shape
    per_side = int(np.round(np.sqrt(subpixels)))
    side = 1.0 / per_side
    own = side**2 / 12.0  # second moment of a square around its middle, over its area
    windows, pixels = np.empty(window.size, dtype=np.int64), np.empty(window.size, dtype=np.int64)
    weights = np.empty(window.size)
    entries = 0
    for row in range(count):
        first = entries
        whole, others = window[row, 0], 0
        for subpixel in range(subpixels):
            others |= window[row, subpixel] ^ whole
        if others == 0 and whole >= 0:
            y, x = float(places_yx[row, 0]), float(places_yx[row, 1])
            area = subpixels * share[row]
            moments[whole, 0] += area * y
            moments[whole, 1] += area * x
            moments[whole, 2] += area * (y * y + 1.0 / 12.0)
            moments[whole, 3] += area * (x * x + 1.0 / 12.0)
            moments[whole, 4] += area * y * x
            windows[entries], pixels[entries], weights[entries] = whole, pixel[row], area
            entries += 1
            continue
        for subpixel in range(subpixels):
            here = window[row, subpixel]
            if here < 0:
                continue
            y = places_yx[row, 0] + (subpixel // per_side + 0.5) * side - 0.5
            x = places_yx[row, 1] + (subpixel % per_side + 0.5) * side - 0.5
            moments[here, 0] += share[row] * y
            moments[here, 1] += share[row] * x
            moments[here, 2] += share[row] * (y * y + own)
            moments[here, 3] += share[row] * (x * x + own)
            moments[here, 4] += share[row] * y * x
            entry = first
            while entry < entries and windows[entry] != here:
                entry += 1
            if entry == entries:
                windows[entry], pixels[entry], weights[entry] = here, pixel[row], 0.0
                entries += 1
            weights[entry] += share[row]
    return windows[:entries].copy(), pixels[:entries].copy(), weights[:entries].copy()
