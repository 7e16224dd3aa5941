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
_BEND_PX = 0.25  # neighbours whose distance is so much less than it would be in a plane are looked at closely
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
        Of all these pixels. Where a pixel lies in one window as a whole, four places stand for its subpixels.
    n_windows : int

    Returns
    -------
    ndarray of shape (windows, 3) and dtype float
        In pixels; NaN for a window without subpixels, and where the image shows no edge of the cell.
    """
    counts = np.zeros(n_windows, dtype=np.int64)
    for some in subpixels:
        _count(some.window, counts)
    start = np.concatenate([[0], np.cumsum(counts)])
    depth, weight = np.empty(start[-1], dtype=np.float32), np.empty(start[-1], dtype=np.float32)
    free = start[:-1].copy()
    for some in subpixels:
        per_side = math.isqrt(some.window.shape[1])
        _measure(
            pixels_yx[some.pixel],
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
def _count(window: IntArray | Int32Array, counts: IntArray) -> None:
    """Add the number of places in each window."""
    for pixel in range(window.shape[0]):
        if _whole(window, pixel):
            counts[window[pixel, 0]] += 4
            continue
        for place in range(window.shape[1]):
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
        row, column = pixels[pixel, 0], pixels[pixel, 1]
        i = nearest[row + 1, column + 1]
        if i < 0:
            continue
        whole = _whole(window, pixel)
        n_places = len(sparse) if whole else window.shape[1]
        area = share[pixel] * (window.shape[1] / n_places)
        middle = distance[row + 1, column + 1]
        down, right = _away_from(row, column, edges, i, middle)
        bent = _is_bent(row + 1, column + 1, down, right, distance)
        close = 0
        if bent or middle < _NEAR_PX:
            close = edges_around(row + 1, column + 1, 1 if bent else 0, edge, among)
        for place in range(n_places):
            here = window[pixel, place]
            if here < 0:
                continue
            y, x = lattice[place, 0], lattice[place, 1]
            if whole:
                y, x = sparse[place, 0], sparse[place, 1]
            if close > 0:
                found = depth_below(row + y, column + x, among, close, edges)
            else:
                found = middle + down * y + right * x
            depth[free[here]], weight[free[here]] = found, area
            free[here] += 1


@njit(cache=True, error_model="numpy")
def _away_from(row: int, column: int, edges: FloatArray, i: int, away: float) -> tuple[float, float]:
    """Direction from the nearest point of an edge to a pixel's centre, as a unit vector."""
    dy, dx = row - edges[i, 0], column - edges[i, 1]
    share = min(max((dy * edges[i, 2] + dx * edges[i, 3]) * edges[i, 4], 0.0), 1.0)
    length = max(away, 1e-12)
    return (dy - share * edges[i, 2]) / length, (dx - share * edges[i, 3]) / length


@njit(cache=True, error_model="numpy")
def _is_bent(row: int, column: int, down: float, right: float, distance: FloatArray) -> bool:
    """Whether a pixel at the side is nearer to another part of the edge."""
    least = distance[row, column] - _BEND_PX
    return bool(
        distance[row + 1, column] < least + down
        or distance[row - 1, column] < least - down
        or distance[row, column + 1] < least + right
        or distance[row, column - 1] < least - right
    )


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
