"""How many pixels the labels of two images share, in one pass over their strips."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from cytodisk.arrays import IntArray


@dataclass(frozen=True, eq=False)
class LabelOverlaps:
    """Labels of cells and of nuclei in one image, with their areas and what they share, in pixels.

    Attributes
    ----------
    cells, nuclei : ndarray of shape (C,), (N,) and dtype int
        Labels, sorted, without 0.
    cell_px, nucleus_px : ndarray of shape (C,), (N,) and dtype int
        Their areas.
    pairs : ndarray of shape (P, 2) and dtype int
        Places in `cells` and in `nuclei` of all that share a pixel.
    shared_px : ndarray of shape (P,) and dtype int
    """

    cells: IntArray
    nuclei: IntArray
    cell_px: IntArray
    nucleus_px: IntArray
    pairs: IntArray
    shared_px: IntArray

    @classmethod
    def of(cls, strips: Iterable[tuple[np.ndarray[Any, Any], np.ndarray[Any, Any]]]) -> LabelOverlaps:
        """Count pixels by label, and by pair of labels.

        Memory goes by the labels, and time by the pixels once.

        Parameters
        ----------
        strips : iterable of (ndarray of shape (h, W), ndarray of shape (h, W))
            Rows of the image of cells, and the same rows of the image of nuclei; 0 is neither.
        """
        counted = _summed([_counted(cells, nuclei) for cells, nuclei in strips])
        cells, cell_px = _by_label(counted[:, 0], counted[:, 2])
        nuclei, nucleus_px = _by_label(counted[:, 1], counted[:, 2])
        shared = counted[(counted[:, 0] != 0) & (counted[:, 1] != 0)]
        places = [np.searchsorted(cells, shared[:, 0]), np.searchsorted(nuclei, shared[:, 1])]
        return cls(cells, nuclei, cell_px, nucleus_px, np.column_stack(places), shared[:, 2])

    def adding(self, shared: IntArray) -> LabelOverlaps:
        """The same with more shared pixels, which belonged to no cell, such as those of its holes.

        Parameters
        ----------
        shared : ndarray of shape (P, 3) and dtype int
            Label of the cell, label of the nucleus, pixels.
        """
        known = [self.cells[self.pairs[:, 0]], self.nuclei[self.pairs[:, 1]], self.shared_px]
        counted = _summed([np.column_stack(known), shared])
        places = [np.searchsorted(self.cells, counted[:, 0]), np.searchsorted(self.nuclei, counted[:, 1])]
        cell_px = self.cell_px + np.bincount(
            np.searchsorted(self.cells, shared[:, 0]), shared[:, 2], minlength=len(self.cells)
        ).astype(np.int64)
        return replace(self, cell_px=cell_px, pairs=np.column_stack(places), shared_px=counted[:, 2])


def _counted(cells: np.ndarray[Any, Any], nuclei: np.ndarray[Any, Any]) -> IntArray:
    """Label of a cell, of a nucleus, and their pixels, by pair in a strip, shape (P, 3); 0 and 0 is left out.

    By runs of one pair in a row, which are few: sorting all pixels takes ten times as long.
    """
    if not (cells.any() or nuclei.any()):
        return np.empty((0, 3), dtype=np.int64)
    begins = np.ones(cells.shape, dtype=bool)
    np.not_equal(cells[:, 1:], cells[:, :-1], out=begins[:, 1:])
    begins[:, 1:] |= nuclei[:, 1:] != nuclei[:, :-1]
    starts = np.flatnonzero(begins)
    lengths = np.diff(np.append(starts, cells.size))
    runs = np.column_stack([cells[begins], nuclei[begins], lengths]).astype(np.int64)
    return _summed([runs[(runs[:, 0] != 0) | (runs[:, 1] != 0)]])


def _summed(parts: list[IntArray]) -> IntArray:
    """Each pair once, with the sum of its pixels, sorted."""
    counted = np.concatenate(parts) if parts else np.empty((0, 3), dtype=np.int64)
    if not len(counted):
        return counted
    counted = counted[np.lexsort((counted[:, 1], counted[:, 0]))]
    changes = (counted[1:, :2] != counted[:-1, :2]).any(axis=1)
    first = np.flatnonzero(np.append(True, changes))
    return np.column_stack([counted[first, :2], np.add.reduceat(counted[:, 2], first)])


def _by_label(labels: IntArray, counts: IntArray) -> tuple[IntArray, IntArray]:
    """Each label but 0 once, sorted, with the sum of its pixels."""
    found, place = np.unique(labels, return_inverse=True)
    pixels = np.zeros(len(found), dtype=np.int64)
    np.add.at(pixels, place.ravel(), counts)
    held = found != 0
    return found[held], pixels[held]
