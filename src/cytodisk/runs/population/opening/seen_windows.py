"""Whether each window of each cell came once while a table was read."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from cytodisk.arrays import BoolArray, IntArray
from cytodisk.errors import ReadError
from cytodisk.runs.population.opening.streamed_windows import WindowBlock
from cytodisk.store.table_file import REMEDY


class SeenWindows:
    """A mark for each (cell, channel, layer, sector).

    Parameters
    ----------
    path : Path
        Of the table, for messages.
    numbers : ndarray of shape (cells,) and dtype int
        Numbers of the cells in their study, for messages.
    shape : tuple of int
        (cells, channels, layers, sectors).
    """

    def __init__(self, path: Path, numbers: IntArray, shape: tuple[int, ...]) -> None:
        self._path, self._numbers = path, numbers
        self._seen = np.zeros(shape, dtype=bool)
        self._rows = 0

    def add(self, block: WindowBlock) -> IntArray:
        """Mark windows.

        Parameters
        ----------
        block : WindowBlock

        Returns
        -------
        ndarray of dtype int64
            Place of each in a flat array.

        Raises
        ------
        ReadError
            One has been there before.
        """
        _, channels, layers, sectors = self._seen.shape
        at = ((block.row * channels + block.channel) * layers + block.layer) * sectors + block.sector
        seen = self._seen.reshape(-1)
        if (before := seen[at]).any():
            first = block.where(before)
            raise ReadError(
                f"{self._path}: cell {self._numbers[int(first.row[0])]} has the window of layer "
                f"{first.layer[0]}, sector {first.sector[0]} twice: {REMEDY}"
            )
        seen[at] = True
        self._rows += len(at)
        return np.asarray(at)

    def lacking(self) -> BoolArray:
        """Which cells have no window at all of a channel that others of their study have.

        Returns
        -------
        ndarray of shape (cells, channels) and dtype bool

        Raises
        ------
        ReadError
            A window stands twice, or is missing where others of its cell and channel are there.
        """
        if np.count_nonzero(self._seen) < self._rows:
            raise ReadError(f"{self._path}: a window of a cell stands twice: {REMEDY}")
        counts = np.count_nonzero(self._seen, axis=(2, 3))
        windows = self._seen.shape[2] * self._seen.shape[3]
        none = np.asarray(counts == 0)
        gaps = ((counts < windows) & ~none).any(axis=1) | none.all(axis=1)
        if gaps.any():
            row = int(np.flatnonzero(gaps)[0])
            raise ReadError(
                f"{self._path}: cell {self._numbers[row]} has rows for {counts[row].sum()} of "
                f"{windows * counts.shape[1]} windows: {REMEDY}"
            )
        return none
