"""The pieces of a nucleus' mask: which of them are nuclei, and how several are joined."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, IntArray
from cytodisk.errors import NucleusError
from cytodisk.geometry.fragments import SEVERAL_FROM
from cytodisk.geometry.outline import has_one_outline

_EIGHT = np.ones((3, 3), dtype=bool)


@dataclass(frozen=True, eq=False)
class NucleusPieces:
    """Connected pieces (8-connected) of nuclei, each within one label, the largest first.

    Attributes
    ----------
    numbered : ndarray of shape (H, W) and dtype int
        Number of each pixel's piece, from 1; 0 outside. What lies in a hole of a larger piece is part of it.
    areas : ndarray of shape (n,) and dtype int
        Pixels of each piece.
    """

    numbered: IntArray
    areas: IntArray

    @classmethod
    def of(cls, labels: Any) -> NucleusPieces:
        """The pieces of a 0/1 mask, or of an image with a label for each nucleus.

        Parameters
        ----------
        labels : ndarray of shape (H, W) and dtype bool or int
        """
        given = labels != 0
        if labels.dtype == bool and has_one_outline(given):
            return cls(given.astype(np.int64), np.array([np.count_nonzero(given)]))
        numbered = _sorted_by_area(_absorbed(_sorted_by_area(_connected(labels))))
        return cls(numbered, np.bincount(numbered.ravel())[1:])

    @property
    def nuclei(self) -> BoolArray:
        """Which pieces are as large as a nucleus, shape (n,): at least a tenth of the largest."""
        large: BoolArray = self.areas >= SEVERAL_FROM * self.areas.max(initial=0)
        return large

    def inside(self, cell: BoolArray) -> IntArray:
        """Pixels of each piece that lie in a cell, shape (n,)."""
        return np.bincount(self.numbered[cell], minlength=len(self.areas) + 1)[1:]

    def mask_of(self, chosen: BoolArray) -> BoolArray:
        """Pixels of some of the pieces, shape (H, W)."""
        mask: BoolArray = np.concatenate([[False], chosen])[self.numbered]
        return mask


def _connected(labels: Any) -> IntArray:
    if labels.dtype == bool:
        pieces, _ = ndimage.label(labels, structure=_EIGHT)
        return np.asarray(pieces, dtype=np.int64)
    from skimage import measure  # takes long to import, and few masks need it

    numbered = measure.label(labels, background=0, connectivity=2)  # type: ignore[no-untyped-call,unused-ignore]
    return np.asarray(numbered, dtype=np.int64)


def _sorted_by_area(numbered: IntArray) -> IntArray:
    areas = np.bincount(numbered.ravel())[1:]
    order = np.argsort(-areas, kind="stable")
    order = order[areas[order] > 0]
    number = np.zeros(len(areas) + 1, dtype=np.int64)
    number[order + 1] = np.arange(1, len(order) + 1)
    renumbered: IntArray = number[numbered]
    return renumbered


def _absorbed(numbered: IntArray) -> IntArray:
    """Pieces that lie in a hole of a larger one, as nucleoli with their own labels, become part of it."""
    areas = np.bincount(numbered.ravel())[1:]
    part_of = np.arange(len(areas) + 1)
    for piece in range(1, len(areas)):
        if part_of[piece] != piece or areas[piece - 1] < SEVERAL_FROM * areas[0]:
            continue
        held = np.unique(numbered[without_holes(numbered == piece)])
        part_of[held[held > 0]] = piece
    joined: IntArray = part_of[numbered]
    return joined


def listed_areas(areas: IntArray) -> str:
    """As "180 and 40 px"; of many the first ones."""
    words = [str(int(area)) for area in areas[:4]] + ["…"] * (len(areas) > 4)
    return f"{', '.join(words[:-1])} and {words[-1]} px" if len(areas) <= 4 else f"{', '.join(words)} px"


def without_holes(piece: BoolArray) -> BoolArray:
    """A mask with its holes filled: background that is enclosed (4-connected)."""
    if has_one_outline(piece):
        return piece
    filled: BoolArray = ndimage.binary_fill_holes(piece)
    return filled


def joined(numbered: IntArray, room: BoolArray) -> BoolArray:
    """All pieces as one: each next one by a path of one pixel's width, the shortest within a room.

    Parameters
    ----------
    numbered : ndarray of shape (H, W) and dtype int
        Number of each pixel's piece; the others are joined to number 1.
    room : ndarray of shape (H, W) and dtype bool
        Where paths may go; holds all pieces.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool
        One 8-connected piece, with a hole where paths enclose cytoplasm.

    Raises
    ------
    NucleusError
        No path leads from one to another.
    """
    from skimage.graph import MCP_Geometric

    union: BoolArray = numbered == 1
    left = numbered > 1
    costs = np.where(room, 1.0, -1.0)  # negative: no way through
    while left.any():
        ways, ends = MCP_Geometric(costs), np.argwhere(left)
        cost, _ = ways.find_costs(np.argwhere(union), ends, find_all_ends=False)
        nearest = tuple(ends[np.argmin(cost[left])])
        if not np.isfinite(cost[nearest]):
            raise NucleusError(
                "the nuclei cannot be joined: the cell between them is so narrow that a path would touch its "
                "edge; take the largest with several='largest' (--several largest)"
            )
        union[tuple(np.array(ways.traceback(nearest)).T)] = True
        union |= numbered == numbered[nearest]
        left &= ~union
    return union
