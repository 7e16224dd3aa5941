"""Sums and means of cells' windows by group, in one pass over the cells."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_array

from cytodisk.arrays import FloatArray, IntArray
from cytodisk.population.ratios import ratio


@dataclass(frozen=True, eq=False)
class GroupSums:
    """Sums of values over the cells of groups.

    Attributes
    ----------
    total, count : ndarray of shape (groups, channels, layers, last) and dtype float64
        Sum of the values that there are, and their number.
    """

    total: FloatArray
    count: FloatArray

    @property
    def mean(self) -> FloatArray:
        """Mean of each group; NaN where no cell has a value."""
        return ratio(self.total, self.count, self.count > 0)


def group_sums(
    blocks: Iterator[tuple[slice, FloatArray]],
    codes: IntArray,
    groups: int,
    shape: tuple[int, ...],
    centre: FloatArray | None = None,
) -> GroupSums:
    """Sums over the cells of each group.

    Parameters
    ----------
    blocks : iterator of (slice, ndarray of shape (cells, …))
        See `Population.blocks`.
    codes : ndarray of shape (cells,) and dtype int64
        Group of each cell; -1 for none.
    groups : int
    shape : tuple of int
        Of the values of a cell.
    centre : ndarray of shape (groups, …), optional
        With it, sums of squares about the group's own centre.

    Returns
    -------
    GroupSums
    """
    width = int(np.prod(shape))
    total, count = np.zeros((groups, width)), np.zeros((groups, width))
    for rows, block in blocks:
        code = codes[rows]
        chosen = np.flatnonzero(code >= 0)
        if not len(chosen):
            continue
        values = block.reshape(len(block), width)[chosen]
        member = csr_array(
            (np.ones(len(chosen)), (code[chosen], np.arange(len(chosen)))), shape=(groups, len(chosen))
        )
        if centre is not None:
            values = (values - centre.reshape(groups, width)[code[chosen]]) ** 2
        finite = np.isfinite(values)
        if finite.all():
            total += np.asarray(member @ values)
            count += np.bincount(code[chosen], minlength=groups)[:, None]
        else:
            total += np.asarray(member @ np.where(finite, values, 0.0))
            count += np.asarray(member @ finite.astype(np.float64))
    return GroupSums(total.reshape(groups, *shape), count.reshape(groups, *shape))
