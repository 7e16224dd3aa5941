"""How much of each pixel belongs to each window, and where in it, from subpixels."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numba import njit
from scipy import sparse

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.geometry.placed_mask import PlacedMask

PER_SIDE = 4  # subpixels along the side of a pixel
FINE = 16  # the same for pixels at windows that hold none of the larger ones
PIXELS_AT_ONCE = 4096  # whose subpixels stay in the cache
NOWHERE = -1  # for a window: in none
DIVIDED = -2  # for a window of a pixel: in more than one


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
    subpixels : Subpixels
        What the shares were gathered from.
    hole_areas : ndarray of shape (windows,) and dtype float
        Area of each window that lies in excluded holes, in square pixels; it is no part of the weights.
    """

    weights: sparse.csr_array
    moments: FloatArray
    origin_yx: IntArray
    subpixels: Subpixels
    hole_areas: FloatArray


@dataclass(frozen=True, eq=False)
class Subpixels:
    """Windows of the subpixels of a mask. Only pixels that are not in one window as a whole are divided.

    Attributes
    ----------
    whole : ndarray of shape (pixels,) and dtype int32
        Window that holds all of a pixel, in row-major order; -1 for none, -2 for a pixel that is divided.
    start : ndarray of shape (divided pixels + 1,) and dtype int
        First subpixel of each divided pixel in `window`.
    window : ndarray of shape (subpixels,) and dtype int32
        Window of each subpixel, or -1. A pixel has 4×4 of them, or 16×16, row by row. Each that follows
        these is one more square as large as the pixel. All of a pixel share its area alike.
    """

    whole: Int32Array
    start: IntArray
    window: Int32Array

    @property
    def divided(self) -> IntArray:
        """Numbers of the pixels that are divided."""
        return np.flatnonzero(self.whole == DIVIDED)

    def of_pixel(self, pixel: int) -> Int32Array:
        """Windows of the subpixels of a pixel, whether it is divided or not."""
        if self.whole[pixel] != DIVIDED:
            return np.full(PER_SIDE**2, self.whole[pixel])
        place = np.count_nonzero(self.whole[:pixel] == DIVIDED)
        return self.window[self.start[place] : self.start[place + 1]]

    def with_divided(self, windows: Mapping[int, Int32Array]) -> Subpixels:
        """The same with other subpixels of some pixels.

        Parameters
        ----------
        windows : mapping of int to ndarray of dtype int32
            By the number of the pixel, as in `window`.

        Returns
        -------
        Subpixels
        """
        whole, lengths = self.whole.copy(), np.zeros(len(self.whole), dtype=np.int64)
        lengths[self.divided] = np.diff(self.start)
        kept = np.repeat(~np.isin(self.divided, list(windows)), np.diff(self.start))
        for pixel, own in windows.items():
            whole[pixel] = own[0] if (own == own[0]).all() else DIVIDED
            lengths[pixel] = len(own)
        lengths[whole != DIVIDED] = 0
        first = np.cumsum(lengths) - lengths
        window = np.empty(lengths.sum(), dtype=np.int32)
        old = np.ones(len(window), dtype=bool)
        for pixel, own in windows.items():
            if lengths[pixel]:
                place = slice(first[pixel], first[pixel] + lengths[pixel])
                window[place], old[place] = own, False
        window[old] = self.window[kept]
        start = np.append(first[whole == DIVIDED], len(window))
        return Subpixels(whole, start, window)


def strips(pixels_yx: IntArray) -> Iterator[tuple[IntArray, IntArray]]:
    """Numbers and places of a few neighbouring pixels at a time: their subpixels need little memory."""
    for first in range(0, len(pixels_yx), PIXELS_AT_ONCE):
        block = pixels_yx[first : first + PIXELS_AT_ONCE]
        yield np.arange(first, first + len(block)), block


def subpixels_by_strips(
    placed: PlacedMask, windows_of_subpixels: Callable[[IntArray], IntArray]
) -> Subpixels:
    """Windows of subpixels where all pixels are divided into 4×4 of them.

    Parameters
    ----------
    placed : PlacedMask
    windows_of_subpixels : callable
        From places of pixels, (p, 2), to the windows of their subpixels, (p, 16); -1 for none.

    Returns
    -------
    Subpixels
    """
    blocks = [_undivided(windows_of_subpixels(block)) for _, block in strips(placed.pixels_yx)]
    whole, window = (np.concatenate(column) for column in zip(*blocks, strict=True))
    return with_starts(whole, window)


def with_starts(whole: Int32Array, window: Int32Array) -> Subpixels:
    """Subpixels of pixels, of which all that are divided have 4×4."""
    return Subpixels(whole, np.arange(0, len(window) + 1, PER_SIDE**2), window)


def _undivided(window: IntArray) -> tuple[Int32Array, Int32Array]:
    """Window of each pixel as a whole, and the windows of the subpixels of those that are divided."""
    alike = (window == window[:, :1]).all(axis=1)
    whole = np.where(alike, window[:, 0], DIVIDED).astype(np.int32)
    return whole, window[~alike].astype(np.int32).ravel()


def gather_shares(
    placed: PlacedMask, n_windows: int, subpixels: Subpixels, hole_areas: FloatArray | None = None
) -> WindowShares:
    """Shares and moments from the windows of subpixels.

    Parameters
    ----------
    placed : PlacedMask
    n_windows : int
    subpixels : Subpixels
        Of this mask.
    hole_areas : ndarray of shape (windows,) and dtype float, optional
        See `WindowShares`; by default there are no holes.

    Returns
    -------
    WindowShares
    """
    parts = subpixels.whole, subpixels.start, subpixels.window
    moments, entries = _gather(placed.box, *parts, n_windows)
    weights = sparse.csr_array(entries, shape=(n_windows, len(subpixels.whole)))
    in_holes = np.zeros(n_windows) if hole_areas is None else hole_areas
    return WindowShares(weights, moments, np.array(placed.corner), subpixels, in_holes)


@njit(cache=True)
def _gather(
    inside: BoolArray, whole: Int32Array, start: IntArray, window: Int32Array, n_windows: int
) -> tuple[FloatArray, tuple[FloatArray, Int32Array, Int32Array]]:
    """Moments of the windows, and the weights of the pixels in them by window: weights, pixels, starts."""
    moments = np.zeros((n_windows, 5))
    counts = np.zeros(n_windows + 1, dtype=np.int32)
    held, share = np.empty(len(window), dtype=np.int32), np.empty(len(window))  # of divided pixels
    last = np.empty(len(start), dtype=np.int64)  # of these in each of them
    pixel = divided = 0
    for row in range(inside.shape[0]):
        for column in range(inside.shape[1]):
            if not inside[row, column]:
                continue
            here = whole[pixel]
            if here >= 0:
                _add_square(moments, here, float(row), float(column), 1.0, 1.0)
                counts[here + 1] += 1
            elif here == DIVIDED:
                first, stop = start[divided], start[divided + 1]
                _add_subpixels(row, column, window, first, stop, moments)
                last[divided] = _distinct(window, first, stop, held, share)
                for entry in range(first, last[divided]):
                    counts[held[entry] + 1] += 1
                divided += 1
            pixel += 1
    starts = np.cumsum(counts).astype(np.int32)
    return moments, _by_window(whole, start, last, held, share, starts)


@njit(cache=True)
def _by_window(
    whole: Int32Array,
    start: IntArray,
    last: IntArray,
    held: Int32Array,
    share: FloatArray,
    starts: Int32Array,
) -> tuple[FloatArray, Int32Array, Int32Array]:
    """Weights and pixels, window by window."""
    weights, pixels = np.empty(starts[-1]), np.empty(starts[-1], dtype=np.int32)
    free, divided = starts[:-1].copy(), 0
    for pixel in range(len(whole)):
        here = whole[pixel]
        if here >= 0:
            weights[free[here]], pixels[free[here]] = 1.0, pixel
            free[here] += 1
        elif here == DIVIDED:
            for entry in range(start[divided], last[divided]):
                here = held[entry]
                weights[free[here]], pixels[free[here]] = share[entry], pixel
                free[here] += 1
            divided += 1
    return weights, pixels, starts


@njit(cache=True)
def _distinct(window: Int32Array, first: int, stop: int, held: Int32Array, share: FloatArray) -> int:
    """Write windows of a pixel and their shares of it from the first entry on; the end of these entries."""
    own, last = 1.0 / (stop - first), first
    for subpixel in range(first, stop):
        here = window[subpixel]
        if here < 0:
            continue
        entry = first
        while entry < last and held[entry] != here:
            entry += 1
        if entry == last:
            held[last], share[last] = here, 0.0
            last += 1
        share[entry] += own
    return last


@njit(cache=True)
def _add_subpixels(
    row: int, column: int, window: Int32Array, first: int, stop: int, moments: FloatArray
) -> None:
    """Add the subpixels of a pixel to the moments of their windows."""
    per_side, share = per_side_of(stop - first), 1.0 / (stop - first)
    side, subpixel = 1.0 / per_side, first
    for down in range(per_side):
        y = row + (down + 0.5) * side - 0.5
        for right in range(per_side):
            if window[subpixel] >= 0:
                x = column + (right + 0.5) * side - 0.5
                _add_square(moments, window[subpixel], y, x, side, share)
            subpixel += 1
    for more in range(subpixel, stop):
        if window[more] >= 0:
            _add_square(moments, window[more], float(row), float(column), 1.0, share)


@njit(cache=True, inline="always")
def _add_square(moments: FloatArray, here: int, y: float, x: float, side: float, area: float) -> None:
    """Add a square with its middle at a place to the moments of a window, with a weight."""
    own = side * side / 12.0  # second moment of a square around its middle, over its area
    moments[here, 0] += area * y
    moments[here, 1] += area * x
    moments[here, 2] += area * (y * y + own)
    moments[here, 3] += area * (x * x + own)
    moments[here, 4] += area * y * x


@njit(cache=True)
def per_side_of(count: int) -> int:
    """Subpixels along the side of a pixel that has so many of them, or a few more."""
    return FINE if count >= FINE * FINE else PER_SIDE
