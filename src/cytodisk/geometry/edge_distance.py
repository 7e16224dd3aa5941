"""Distance to the edge of a cell from any place in it, by the nearest edge of each pixel of its mask."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from numba import njit

from cytodisk.arrays import BoolArray, FloatArray, Int32Array, IntArray
from cytodisk.geometry.lower_envelope import lower_envelope, outside_in_column
from cytodisk.geometry.outline import on_border
from cytodisk.geometry.placed_mask import PlacedMask

_THIN_PX = 4  # in parts that are thinner, edges on both sides are looked at
MOST_AROUND = 11  # edges that `edges_around` finds

Edge: TypeAlias = tuple[Int32Array, FloatArray, FloatArray, BoolArray]
"""`nearest`, `pixels`, `edges` and `counts` of an `EdgeDistance`."""


@dataclass(frozen=True, eq=False)
class EdgeDistance:
    """Distance to a cell's edge: to its outline, but for what the image's border cuts off.

    Attributes
    ----------
    placed : PlacedMask
    outline_yx : ndarray of shape (B, 2) and dtype float
        Closed polygon around the mask, (row, column) in pixels, from +x towards +y.
    """

    placed: PlacedMask
    outline_yx: FloatArray

    @cached_property
    def corner(self) -> IntArray:
        """First row and column that counts: one before the box of the cell, if the image has it."""
        y, x = self.placed.corner
        return np.array([max(y - 1, 0), max(x - 1, 0)])

    @cached_property
    def inside(self) -> BoolArray:
        """Pixels of the cell and those of the image around them, in a margin of one that is no part of it."""
        rows, columns = self.placed.slices
        height, width = self.placed.image_shape
        end = np.array([min(rows.stop + 1, height), min(columns.stop + 1, width)])
        inside = np.zeros(end - self.corner + 2, dtype=bool)
        y, x = 1 - self.corner
        inside[rows.start + y : rows.stop + y, columns.start + x : columns.stop + x] = self.placed.box
        return inside

    @cached_property
    def edges(self) -> FloatArray:
        """Start from the corner, direction and 1 / length² of each edge of the outline, shape (B, 5)."""
        along = np.roll(self.outline_yx, -1, axis=0) - self.outline_yx
        squared = np.maximum((along * along).sum(axis=1), 1e-300)
        return np.column_stack([self.outline_yx - self.corner, along, 1.0 / squared])

    @cached_property
    def counts(self) -> BoolArray:
        """Whether each edge of the outline is one of the cell, not one of the image, shape (B,)."""
        cut = on_border(self.outline_yx, self.placed.image_shape)
        return ~(cut & np.roll(cut, -1))

    @property
    def nearest(self) -> Int32Array:
        """Nearest edge of each pixel of the cell, in the shape of `inside`; or -1.

        Pixels outside have one if they are next to an edge.
        """
        return self._by_pixel[0]

    @property
    def pixels(self) -> FloatArray:
        """Distance of each pixel's centre to its nearest edge, in the shape of `nearest`; below 0 outside."""
        return self._by_pixel[1]

    @property
    def arrays(self) -> Edge:
        """All of it, for kernels, which count rows and columns from the corner."""
        return (*self._by_pixel, self.edges, self.counts)

    @cached_property
    def _by_pixel(self) -> tuple[Int32Array, FloatArray]:
        return _nearest_edges(self.inside, self.edges, self.counts)

    def at(self, points_yx: FloatArray) -> FloatArray:
        """Distance to the edge of some places, 0 outside; infinite if the image shows no edge of the cell.

        Parameters
        ----------
        points_yx : ndarray of shape (..., 2) and dtype float
            (row, column) in pixels, in the cell or within a pixel of it.

        Returns
        -------
        ndarray of shape (...) and dtype float
            In pixels; exact but for places between parts of the edge that are equally near, where it can be
            0.4 px too long.
        """
        flat = points_yx.reshape(-1, 2) - self.corner
        return _depths(flat, self.arrays).reshape(points_yx.shape[:-1])


@njit(cache=True, error_model="numpy")
def squared_distance(y: float, x: float, edges: FloatArray, i: int) -> float:
    """Square of the distance from a point to an edge, a row of `EdgeDistance.edges`."""
    dy, dx = y - edges[i, 0], x - edges[i, 1]
    share = min(max((dy * edges[i, 2] + dx * edges[i, 3]) * edges[i, 4], 0.0), 1.0)
    dy -= share * edges[i, 2]
    dx -= share * edges[i, 3]
    return float(dy * dy + dx * dx)


@njit(cache=True, error_model="numpy")
def edges_around(row: int, column: int, reach: int, edge: Edge, into: IntArray) -> int:
    """Collect edges that can be the nearest one of a place in a pixel, and say how many there are.

    Those of the pixel and of its neighbours within `reach`, 0 or 1; and the two beside its own.
    """
    nearest, _, edges, counts = edge
    found = 0
    for beside in range(row - reach, row + reach + 1):
        for along in range(column - reach, column + reach + 1):
            found = _add(nearest[beside, along], found, into)
    own = nearest[row, column]
    if own >= 0:
        for i in ((own + 1) % len(edges), (own - 1) % len(edges)):
            if counts[i]:
                found = _add(i, found, into)
    return found


@njit(cache=True, error_model="numpy")
def _add(i: int, found: int, into: IntArray) -> int:
    for known in range(found):
        if into[known] == i:
            return found
    if i < 0:
        return found
    into[found] = i
    return found + 1


@njit(cache=True, error_model="numpy")
def depth_below(y: float, x: float, among: IntArray, found: int, edges: FloatArray) -> float:
    """Distance of a place to the nearest of some edges; 0 outside, infinite if there are none."""
    best, nearest = np.inf, 0
    for entry in range(found):
        here = squared_distance(y, x, edges, among[entry])
        if here < best:
            best, nearest = here, among[entry]
    return math.sqrt(best) if not found or _is_inside(y, x, nearest, edges) else 0.0


@njit(cache=True, error_model="numpy")
def _is_inside(y: float, x: float, nearest: int, edges: FloatArray) -> bool:
    """Whether a place with a known nearest edge is inside; at a corner, if that points inwards."""
    dy, dx = y - edges[nearest, 0], x - edges[nearest, 1]
    share = (dy * edges[nearest, 2] + dx * edges[nearest, 3]) * edges[nearest, 4]
    if share <= 0.0 or share >= 1.0:
        after = nearest if share <= 0.0 else (nearest + 1) % len(edges)
        turn = edges[after - 1, 3] * edges[after, 2] - edges[after - 1, 2] * edges[after, 3]
        if turn != 0.0:
            return bool(turn < 0.0)
    return bool(dy * edges[nearest, 3] >= dx * edges[nearest, 2])


@njit(cache=True, error_model="numpy")
def _depths(points: FloatArray, edge: Edge) -> FloatArray:
    nearest, _, edges, _ = edge
    height, width = nearest.shape
    depth, among = np.empty(len(points)), np.empty(MOST_AROUND, dtype=np.int64)
    for i in range(len(points)):
        y, x = points[i, 0], points[i, 1]
        if not (math.isfinite(y) and math.isfinite(x)):
            depth[i] = np.nan
            continue
        row = min(max(math.floor(y + 1.5), 1), height - 2)
        column = min(max(math.floor(x + 1.5), 1), width - 2)
        depth[i] = depth_below(y, x, among, edges_around(row, column, 1, edge, among), edges)
    return depth


@njit(cache=True, error_model="numpy")
def _nearest_edges(inside: BoolArray, edges: FloatArray, counts: BoolArray) -> tuple[Int32Array, FloatArray]:
    """From the nearest pixel outside to the edge before it, and from there along the outline."""
    height, width = inside.shape
    nearest, distance = _around_edges(inside.shape, edges, counts)
    outside = outside_in_column(inside)
    lowest = np.empty(width, dtype=np.int64)  # columns whose parabolas make up the lower envelope
    begin = np.empty(width + 1)  # and where each of them begins
    for row in range(1, height - 1):
        last = 0
        for first in range(1, width - 1):
            if first <= last or not inside[row, first]:
                continue
            last = first
            while inside[row, last + 1]:
                last += 1
            count = lower_envelope(row, outside[row], (first - 1, last + 1), lowest, begin)
            place = 0
            for column in range(first, last + 1 if count > 0 else first):
                while place < count - 1 and begin[place + 1] < column:
                    place += 1
                down, aside = outside[row, lowest[place]] - row, lowest[place] - column
                steps = max(abs(down), abs(aside))
                before = (steps - 1.0) / steps  # of the way from here to that pixel
                y, x, found = row - 1.0, column - 1.0, nearest[row, column]
                inner = nearest[row + round(before * down), column + round(before * aside)]
                if found < 0:
                    found = inner
                if steps < _THIN_PX:  # edges at both sides of that pixel, and of this one
                    found = _nearer(y, x, found, inner, edges)
                    found = _nearer(y, x, found, nearest[row + down, column + aside], edges)
                if found >= 0:
                    found = _walk(y, x, found, edges, counts)
                    nearest[row, column] = found
                    distance[row, column] = math.sqrt(squared_distance(y, x, edges, found))
    return nearest, distance


@njit(cache=True, error_model="numpy")
def _nearer(y: float, x: float, one: int, other: int, edges: FloatArray) -> int:
    """Of two edges the one nearer to a place; -1 is none."""
    if other < 0 or other == one:
        return one
    if one >= 0 and squared_distance(y, x, edges, one) <= squared_distance(y, x, edges, other):
        return one
    return other


@njit(cache=True, error_model="numpy")
def _walk(y: float, x: float, start: int, edges: FloatArray, counts: BoolArray) -> int:
    """Edge that is nearest to a point, from one near to it along the outline."""
    nearest, best = start, squared_distance(y, x, edges, start)
    for step in (1, -1):
        i = start
        while True:
            i += step
            if i == len(edges):
                i = 0
            elif i < 0:
                i = len(edges) - 1
            if not counts[i]:
                break
            here = squared_distance(y, x, edges, i)
            if here >= best:
                break
            best, nearest = here, i
    return nearest


@njit(cache=True, error_model="numpy")
def _around_edges(
    shape: tuple[int, int], edges: FloatArray, counts: BoolArray
) -> tuple[Int32Array, FloatArray]:
    """Nearest edge of the pixels around each edge, -1 elsewhere, and minus their distance to it."""
    nearest = np.full(shape, -1, dtype=np.int32)
    distance = np.full(shape, -np.inf)
    for i in range(len(edges)):
        if not counts[i]:
            continue
        steps = max(math.ceil(math.hypot(edges[i, 2], edges[i, 3])), 1)
        for step in range(steps + 1):
            middle_row = math.floor(edges[i, 0] + step / steps * edges[i, 2] + 1.5)
            middle_column = math.floor(edges[i, 1] + step / steps * edges[i, 3] + 1.5)
            for row in range(max(middle_row - 1, 0), min(middle_row + 2, shape[0])):
                for column in range(max(middle_column - 1, 0), min(middle_column + 2, shape[1])):
                    here = -math.sqrt(squared_distance(row - 1.0, column - 1.0, edges, i))
                    if here > distance[row, column]:
                        nearest[row, column], distance[row, column] = i, here
    return nearest, distance
