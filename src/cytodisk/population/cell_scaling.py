"""What is done to the values of each cell before they are averaged: level, factor, turn."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray, IntArray

BLOCK_VALUES = 4_000_000  # values of cells held at a time: 32 MB


@dataclass(frozen=True, eq=False)
class CellScaling:
    """(value - background - centre) × factor, then turned, for each cell.

    Attributes
    ----------
    background, centre, factor : ndarray of shape (cells, channels) and dtype float64
    shift : ndarray of shape (cells,) and dtype int64
        Sector that becomes sector 0.
    """

    background: FloatArray
    centre: FloatArray
    factor: FloatArray
    shift: IntArray

    @classmethod
    def none(cls, cells: int, channels: int) -> CellScaling:
        """Nothing is done."""
        zeros = np.zeros((cells, channels))
        return cls(zeros, zeros, np.ones((cells, channels)), np.zeros(cells, dtype=np.int64))

    @property
    def background_only(self) -> CellScaling:
        """The background alone is taken away."""
        return replace(CellScaling.none(*self.background.shape), background=self.background)

    def of(self, rows: Any) -> CellScaling:
        """The same for some of the cells."""
        return CellScaling(self.background[rows], self.centre[rows], self.factor[rows], self.shift[rows])

    def turned_to(self, shift: IntArray) -> CellScaling:
        """The same with other turns."""
        return replace(self, shift=shift)

    def scaled_on(self, centre: FloatArray, factor: FloatArray) -> CellScaling:
        """The same, and then (value - centre) × factor."""
        return replace(self, centre=self.centre + centre / self.factor, factor=self.factor * factor)


def rolled(block: FloatArray, shift: IntArray) -> FloatArray:
    """Each cell's values turned so that its sector `shift` becomes sector 0.

    Parameters
    ----------
    block : ndarray of shape (cells, …, sectors) and dtype float64
    shift : ndarray of shape (cells,) and dtype int64

    Returns
    -------
    ndarray of the shape of block
    """
    if not shift.any():
        return block
    sectors = block.shape[-1]
    at = (np.arange(sectors) + shift[:, None]) % sectors
    at = at.reshape(len(block), *(1,) * (block.ndim - 2), sectors)
    return np.take_along_axis(block, np.broadcast_to(at, block.shape), axis=-1)
