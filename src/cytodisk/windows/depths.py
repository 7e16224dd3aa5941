"""How deep below the edge of a cell its windows lie."""

import math
from collections.abc import Sequence

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, Int32Array, IntArray
from cytodisk.geometry.edge_distance import MOST_AROUND, Edge, EdgeDistance, depth_below, edges_around
from cytodisk.windows.shares import Subpixels

DEPTHS = ("depth", "depth_p5", "depth_p95")
"""Names of the percentiles of a window's depth, in their order."""

_PERCENTILES = (0.5, 0.05, 0.95)
_BINS = 256  # between the least and the greatest depth of a window
_NEAR_PX = 1.5  # deeper than this the distance is as good as linear within a pixel
_BEND_PX = (
    0.25  # where the neighbours' distances are so much less than in a plane, two parts of the edge meet
)
_DEEP_PX = 3.0  # for pixels deeper than this two places do
_SPREAD = math.sqrt(1.0 / 12.0)  # standard deviation of a place in a pixel, along an axis
_SPARSE = np.array([(-1.0, -3.0), (3.0, -1.0), (1.0, 3.0), (-3.0, 1.0)]) / 8.0  # a turned 2×2 lattice


def window_depths(
    distance: EdgeDistance, pixels_yx: IntArray, subpixels: Sequence[Subpixels], n_windows: int
) -> FloatArray:
    """Median, 5th and 95th percentile of the depth of each window's subpixels.

    Parameters
    ----------
    distance : EdgeDistance
    pixels_yx : ndarray of shape (P, 2) and dtype int
        (row, column) of the mask's pixels in row-major order.
    subpixels : sequence of Subpixels
        Of all these pixels. Where a pixel lies in one window as a whole, two or four places stand for its
        subpixels.
    n_windows : int

    Returns
    -------
    ndarray of shape (windows, 3) and dtype float
        In pixels; NaN for a window without subpixels, and where the image shows no edge of the cell.
    """
    counts = np.zeros(n_windows, dtype=np.int64)
    places = [pixels_yx[some.pixel] - distance.corner for some in subpixels]
    for pixels, some in zip(places, subpixels, strict=True):
        _count(pixels, some.window, distance.pixels, counts)
    start = np.concatenate([[0], np.cumsum(counts)])
    depth, weight = np.empty(start[-1], dtype=np.float32), np.empty(start[-1], dtype=np.float32)
    free = start[:-1].copy()
    for pixels, some in zip(places, subpixels, strict=True):
        per_side = math.isqrt(some.window.shape[1])
        _measure(
            pixels,
            some.window,
            some.share,
            (_SPARSE, _lattice(per_side)),
            distance.arrays,
            (free, depth, weight),
        )
    found = np.full((n_windows, len(_PERCENTILES)), np.nan)
    _percentiles(start[:-1], free, depth, weight, np.array(_PERCENTILES), found)
    return found


def _lattice(per_side: int) -> FloatArray:
    """Places of the subpixels in their pixel, row by row, shape (subpixels, 2)."""
    steps = (np.arange(per_side) + 0.5) / per_side - 0.5
    return np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)


@njit(cache=True, error_model="numpy")
def _whole(window: IntArray | Int32Array, pixel: int) -> bool:
    """Whether the subpixels of a pixel, 16 or more of them, are all in one window."""
    count = window.shape[1]
    if count < 16:
        return False
    first, others = window[pixel, 0], 0
    for place in range(1, count):
        others |= window[pixel, place] ^ first
    return others == 0 and first >= 0


@njit(cache=True, error_model="numpy")
def _n_places(window: IntArray | Int32Array, pixel: int, depth: float) -> int:
    """Number of places that stand for the subpixels of a pixel."""
    if not _whole(window, pixel):
        return int(window.shape[1])
    return 2 if depth > _DEEP_PX else 4


@njit(cache=True, error_model="numpy")
def _count(pixels: IntArray, window: IntArray | Int32Array, distance: FloatArray, counts: IntArray) -> None:
    """Add the number of places in each window."""
    for pixel in range(window.shape[0]):
        n_places = _n_places(window, pixel, distance[pixels[pixel, 0] + 1, pixels[pixel, 1] + 1])
        if n_places < window.shape[1]:
            counts[window[pixel, 0]] += n_places
            continue
        for place in range(n_places):
            if window[pixel, place] >= 0:
                counts[window[pixel, place]] += 1


@njit(cache=True, error_model="numpy")
def _measure(
    pixels: IntArray,
    window: IntArray | Int32Array,
    share: FloatArray,
    lattices: tuple[FloatArray, FloatArray],
    edge: Edge,
    places: tuple[IntArray, FloatArray, FloatArray],
) -> None:
    """Write the depth and the weight of each place to where its window's are gathered."""
    nearest, distance, edges, _ = edge
    free, depth, weight = places
    sparse, lattice = lattices
    among = np.empty(MOST_AROUND, dtype=np.int64)
    for pixel in range(pixels.shape[0]):
        row, column = pixels[pixel, 0] + 1, pixels[pixel, 1] + 1
        if nearest[row, column] < 0:
            continue
        middle = distance[row, column]
        n_places = _n_places(window, pixel, middle)
        whole = n_places < window.shape[1]
        area = share[pixel] * (window.shape[1] / n_places)
        down, right, bent = _slope(row, column, distance)
        if n_places == 2 and not bent:  # as far from the middle as subpixels are on average
            here = window[pixel, 0]
            spread, first = _SPREAD * math.sqrt(down * down + right * right), free[here]
            depth[first], depth[first + 1] = middle - spread, middle + spread
            weight[first], weight[first + 1] = area, area
            free[here] += 2
            continue
        close = 0
        if bent or middle < _NEAR_PX:
            close = edges_around(row, column, 1 if bent else 0, edge, among)
        for place in range(n_places):
            here = window[pixel, place]
            if here < 0:
                continue
            y, x = lattice[place, 0], lattice[place, 1]
            if whole:
                y, x = sparse[place, 0], sparse[place, 1]
            if close > 0:
                found = depth_below(row - 1 + y, column - 1 + x, among, close, edges)
            else:
                found = middle + down * y + right * x
            depth[free[here]], weight[free[here]] = found, area
            free[here] += 1


@njit(cache=True, error_model="numpy")
def _slope(row: int, column: int, distance: FloatArray) -> tuple[float, float, bool]:
    """How the distance grows by row and by column, and whether it does not grow evenly."""
    twice = 2.0 * distance[row, column] - _BEND_PX
    above, below = distance[row - 1, column], distance[row + 1, column]
    left, right = distance[row, column - 1], distance[row, column + 1]
    return 0.5 * (below - above), 0.5 * (right - left), above + below < twice or left + right < twice


@njit(cache=True, error_model="numpy")
def _percentiles(
    start: IntArray,
    stop: IntArray,
    depth: FloatArray,
    weight: FloatArray,
    shares: FloatArray,
    found: FloatArray,
) -> None:
    """Percentiles of the weighted depths of each window, from a histogram of them."""
    histogram = np.empty(_BINS)
    for window in range(len(found)):
        first, last = start[window], stop[window]
        if first == last:
            continue
        low, high = depth[first], depth[first]
        for i in range(first, last):
            low, high = min(low, depth[i]), max(high, depth[i])
        if not high > low:
            found[window] = low
            continue
        histogram[:] = 0.0
        total = 0.0
        factor = (_BINS - 1e-3) / (high - low)
        for i in range(first, last):
            histogram[int((depth[i] - low) * factor)] += weight[i]
            total += weight[i]
        for column in range(len(shares)):
            wanted, passed, place = shares[column] * total, 0.0, 0
            while place < _BINS - 1 and passed + histogram[place] < wanted:
                passed += histogram[place]
                place += 1
            within = (wanted - passed) / histogram[place] if histogram[place] > 0.0 else 0.0
            found[window, column] = low + (place + min(max(within, 0.0), 1.0)) / _BINS * (high - low)
