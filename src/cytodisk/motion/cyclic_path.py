"""Cheapest order-preserving pairing of two closed curves, by dynamic programming."""

from typing import NamedTuple

import numpy as np
from numba import njit

from cytodisk.arrays import FloatArray, IntArray

# Steps (along here, along there) from pair to pair; their slopes bound the stretch from 1/6 to 6.
_STEPS = np.array(
    [(1, 1), (1, 2), (2, 1), (2, 3), (3, 2), (1, 3), (3, 1), (1, 4), (4, 1), (1, 6), (6, 1)], dtype=np.int64
)
_BAND = 0.25  # of the curve: how far a pair may lie from an even pairing, on either side
_TURNS = 2


class _Strip(NamedTuple):
    """Where a path may run: from one row to another, in a band about an even pairing.

    Attributes
    ----------
    first, last : int
        Rows: samples of `here`.
    offset : float
        Partner of row 0 in the even pairing.
    half : int
        How far from it partners may lie, on either side.
    pinned : int
        Partner of `first`, and one turn later of `last`; -1 leaves both free.
    """

    first: int
    last: int
    offset: float
    half: int
    pinned: int


def cyclic_path(
    here: FloatArray, there: FloatArray, spacing: float, smoothness: float
) -> tuple[IntArray, IntArray]:
    """Pair the samples of two closed curves so that order is kept and little moves.

    The cost of a pairing is the integral of |d|² + smoothness · |d'|², with d the displacement from a
    sample to its partner and d' its change along the curve.

    Parameters
    ----------
    here, there : ndarray of shape (N, 2) and (M, 2) and dtype float
        Evenly spaced along each curve, in one frame, in pixels.
    spacing : float
        Mean distance of neighbouring samples, in pixels.
    smoothness : float
        In square pixels.

    Returns
    -------
    here_index, there_index : ndarray of shape (K,) and dtype int
        Pairs in order through one turn, both strictly increasing; indices may go beyond N and M into the
        next turn.
    """
    n, m = len(here), len(there)
    nearest = np.square(here[:, None] - there[None]).sum(axis=2).argmin(axis=1)
    lead = 2.0 * np.pi * (nearest / m - np.arange(n) / n)
    offset = float(np.angle(np.exp(1j * lead).sum())) / (2.0 * np.pi) * m
    half = max(3, round(_BAND * m))
    # Two turns with free ends: their middle does not feel the ends, and is a pair to cut the circle at.
    free = _Strip(0, _TURNS * n, offset, half, -1)
    i, j = _path(here, there, free, spacing, smoothness, _STEPS)
    cut = int(np.abs(i - n).argmin())
    pinned = _Strip(int(i[cut]), int(i[cut]) + n, offset, half, int(j[cut]))
    i, j = _path(here, there, pinned, spacing, smoothness, _STEPS)
    return i[:-1], j[:-1]


@njit(cache=True)
def _reach(
    cost: FloatArray,
    step_of: IntArray,
    before: tuple[FloatArray, FloatArray, FloatArray],
    d_y: FloatArray,
    d_x: FloatArray,
    length: float,
    smoothness: float,
    step: int,
) -> None:
    """Take a step to each pair of a row where that is cheaper; d is linear in between.

    `before` holds the cost and both components of d of the pairs that the step comes from.
    """
    cost_before, y_before, x_before = before
    for place in range(len(cost)):
        y0, x0, y1, x1 = y_before[place], x_before[place], d_y[place], d_x[place]
        size = (y0 * y0 + x0 * x0 + y1 * y1 + x1 * x1 + y0 * y1 + x0 * x1) / 3.0
        change = (y1 - y0) ** 2 + (x1 - x0) ** 2
        total = cost_before[place] + (size * length + smoothness * change / length)
        cheaper = total < cost[place]
        cost[place] = total if cheaper else cost[place]
        step_of[place] = step if cheaper else step_of[place]


@njit(cache=True)
def _path(
    here: FloatArray,
    there: FloatArray,
    strip: _Strip,
    spacing: float,
    smoothness: float,
    steps: IntArray,
) -> tuple[IntArray, IntArray]:
    """Cheapest path through a strip."""
    first, last, offset, half, pinned = strip
    n, m = here.shape[0], there.shape[0]
    rows, width = last - first + 1, 2 * half + 1
    low = np.empty(rows, np.int64)
    for row in range(rows):
        low[row] = int(np.floor((first + row) * m / n + offset)) - half
    d_y, d_x = np.empty((rows, width)), np.empty((rows, width))
    for row in range(rows):
        i = (first + row) % n
        for column in range(width):
            j = (low[row] + column) % m
            d_y[row, column], d_x[row, column] = there[j, 0] - here[i, 0], there[j, 1] - here[i, 1]
    cost = np.full((rows, width), np.inf)
    step_of = np.full((rows, width), -1, np.int64)
    for column in range(width):
        if pinned < 0 or low[0] + column == pinned:
            cost[0, column] = 0.0
    for row in range(1, rows):
        for k in range(steps.shape[0]):
            before = row - steps[k, 0]
            if before < 0:
                continue
            shift = low[row] - steps[k, 1] - low[before]  # of the columns of that row
            shared = max(0, width - abs(shift))
            to = slice(max(0, -shift), max(0, -shift) + shared)
            come = slice(max(0, shift), max(0, shift) + shared)
            _reach(
                cost[row, to],
                step_of[row, to],
                (cost[before, come], d_y[before, come], d_x[before, come]),
                d_y[row, to],
                d_x[row, to],
                0.5 * (steps[k, 0] + steps[k, 1]) * spacing,
                smoothness,
                k,
            )
    row = rows - 1
    column = pinned + m - low[row] if pinned >= 0 else int(cost[row].argmin())
    i, j = [first + row], [low[row] + column]
    while row > 0:
        k = step_of[row, column]
        column = low[row] + column - steps[k, 1]
        row -= steps[k, 0]
        column -= low[row]
        i.append(first + row)
        j.append(low[row] + column)
    return np.array(i)[::-1].copy(), np.array(j)[::-1].copy()
