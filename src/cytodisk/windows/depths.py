"""How deep below the edge of a cell its windows lie."""

import math
from typing import TypeAlias

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.geometry.edge_distance import MOST_AROUND, Edge, EdgeDistance, depth_below, edges_around
from cytodisk.windows.pixel_shares.shares import DIVIDED, FINE, NOWHERE, PER_SIDE, Subpixels

DEPTHS = ("depth", "depth_p5", "depth_p95")
"""Names of the percentiles of a window's depth, in their order."""
NUCLEUS_DISTANCES = ("nucleus_distance", "nucleus_distance_p5", "nucleus_distance_p95")
"""The same of its distance to the nuclear outline, where the cell has a nucleus."""

_PERCENTILES, _COLUMNS = (0.05, 0.5, 0.95), (1, 0, 2)  # ascending, and their places in `DEPTHS`
_BINS = 256  # between the least and the greatest depth of a window
_NEAR_PX = 1.5  # deeper than this the distance is as good as linear within a pixel
_BEND_PX = (
    0.25  # where the neighbours' distances are so much less than in a plane, two parts of the edge meet
)
_DEEP_PX = 3.0  # for pixels deeper than this two places do
_SPREAD = math.sqrt(1.0 / 12.0)  # standard deviation of a place in a pixel, along an axis
_SPARSE = np.array([(-1.0, -3.0), (3.0, -1.0), (1.0, 3.0), (-3.0, 1.0)]) / 8.0  # a turned 2×2 lattice

_Parts: TypeAlias = tuple[Int32Array, IntArray, Int32Array]
_Places: TypeAlias = tuple[IntArray, FloatArray, FloatArray]


def window_depths(
    distance: EdgeDistance, subpixels: Subpixels, n_windows: int, inside: BoolArray | None = None
) -> FloatArray:
    """Median, 5th and 95th percentile of the depth of each window's subpixels.

    Parameters
    ----------
    distance : EdgeDistance
    subpixels : Subpixels
        Of the same mask. Where a pixel lies in one window as a whole, two or four places stand for its
        subpixels.
    n_windows : int
    inside : ndarray of the shape of `distance.inside` and dtype bool, optional
        The mask that the subpixels are of, if it is another one.

    Returns
    -------
    ndarray of shape (windows, 3) and dtype float
        In pixels; NaN for a window without subpixels, and where the image shows no edge of the cell.
    """
    lattice = np.concatenate([_SPARSE, _lattice(PER_SIDE), _lattice(FINE)])
    parts = subpixels.whole, subpixels.start, subpixels.window
    mask = distance.inside if inside is None else inside
    return _depths(mask, parts, lattice, distance.arrays, n_windows)


def _lattice(per_side: int) -> FloatArray:
    """Places of the subpixels in their pixel, row by row, shape (subpixels, 2)."""
    steps = (np.arange(per_side) + 0.5) / per_side - 0.5
    return np.stack(np.meshgrid(steps, steps, indexing="ij"), axis=-1).reshape(-1, 2)


@njit(cache=True, error_model="numpy")
def _depths(inside: BoolArray, parts: _Parts, lattice: FloatArray, edge: Edge, n_windows: int) -> FloatArray:
    """Count the places of each window, measure them, and take percentiles."""
    start = np.cumsum(_count(inside, parts, edge, n_windows))
    free = start[:-1].copy()
    depth, weight = np.empty(start[-1], dtype=np.float32), np.empty(start[-1], dtype=np.float32)
    _measure(inside, parts, lattice, edge, (free, depth, weight))
    found = np.full((n_windows, len(_PERCENTILES)), np.nan)
    _percentiles(start, depth, weight, found)
    return found


@njit(cache=True, error_model="numpy")
def _count(inside: BoolArray, parts: _Parts, edge: Edge, n_windows: int) -> IntArray:
    """Number of places in each window, from entry 1 on."""
    whole, start, window = parts
    nearest, distance, _, _ = edge
    counts = np.zeros(n_windows + 1, dtype=np.int64)
    pixel = divided = 0
    for row in range(inside.shape[0]):
        for column in range(inside.shape[1]):
            if not inside[row, column]:
                continue
            here, known = whole[pixel], nearest[row, column] >= 0
            if here >= 0 and known:
                counts[here + 1] += 2 if distance[row, column] > _DEEP_PX else 4
            elif here == DIVIDED:
                for entry in range(start[divided], start[divided + 1]):
                    if window[entry] >= 0 and known:
                        counts[window[entry] + 1] += 1
                divided += 1
            pixel += 1
    return counts


@njit(cache=True, error_model="numpy")
def _measure(inside: BoolArray, parts: _Parts, lattice: FloatArray, edge: Edge, places: _Places) -> None:
    """Write the depth and the weight of each place to where its window's are gathered."""
    whole, start, window = parts
    nearest, distance, edges, _ = edge
    free, depth, weight = places
    among = np.empty(MOST_AROUND, dtype=np.int64)
    pixel = divided = -1
    for row in range(inside.shape[0]):
        for column in range(inside.shape[1]):
            if not inside[row, column]:
                continue
            pixel += 1
            here, middle = whole[pixel], distance[row, column]
            divided += here == DIVIDED
            if here == NOWHERE or nearest[row, column] < 0:
                continue
            down, right, bent = _slope(row, column, distance)
            if (
                here >= 0 and middle > _DEEP_PX and not bent
            ):  # as far from the middle as subpixels are on average
                spread, first = _SPREAD * math.sqrt(down * down + right * right), free[here]
                depth[first], depth[first + 1] = middle - spread, middle + spread
                weight[first], weight[first + 1] = 0.5, 0.5
                free[here] += 2
                continue
            first, n_places, begin, size = 0, 2 if middle > _DEEP_PX else 4, 0, 4
            if here == DIVIDED:
                first, n_places = start[divided], start[divided + 1] - start[divided]
                begin, size = (20, FINE**2) if n_places >= FINE**2 else (4, PER_SIDE**2)
            close = 0
            if bent or middle < _NEAR_PX:
                close = edges_around(row, column, 1 if bent else 0, edge, among)
            for place in range(n_places):
                if begin > 0:
                    here = window[first + place]
                if here < 0:
                    continue
                y, x = 0.0, 0.0
                if place < size:
                    y, x = lattice[begin + place, 0], lattice[begin + place, 1]
                if close > 0:
                    found = depth_below(row - 1 + y, column - 1 + x, among, close, edges)
                else:
                    found = middle + down * y + right * x
                depth[free[here]], weight[free[here]] = found, 1.0 / n_places
                free[here] += 1


@njit(cache=True, error_model="numpy")
def _slope(row: int, column: int, distance: FloatArray) -> tuple[float, float, bool]:
    """How the distance grows by row and by column, and whether it does not grow evenly."""
    twice = 2.0 * distance[row, column] - _BEND_PX
    above, below = distance[row - 1, column], distance[row + 1, column]
    left, right = distance[row, column - 1], distance[row, column + 1]
    return 0.5 * (below - above), 0.5 * (right - left), above + below < twice or left + right < twice


@njit(cache=True, error_model="numpy")
def _percentiles(start: IntArray, depth: FloatArray, weight: FloatArray, found: FloatArray) -> None:
    """Percentiles of the weighted depths of each window, from a histogram of them."""
    histogram = np.empty(_BINS)
    for window in range(len(found)):
        first, last = start[window], start[window + 1]
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
        passed, place = 0.0, 0
        for rank in range(len(_PERCENTILES)):
            wanted = _PERCENTILES[rank] * total
            while place < _BINS - 1 and passed + histogram[place] < wanted:
                passed += histogram[place]
                place += 1
            within = (wanted - passed) / histogram[place] if histogram[place] > 0.0 else 0.0
            found[window, _COLUMNS[rank]] = low + (place + min(max(within, 0.0), 1.0)) / _BINS * (high - low)
