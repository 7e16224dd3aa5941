"""Pieces of a mask, one cell with crumbs beside it or several cells, and the holes in a piece."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from scipy import ndimage

from cytodisk.arrays import BoolArray, IntArray
from cytodisk.errors import MaskError
from cytodisk.geometry.outline import has_one_outline

SEVERAL_FROM = 0.1
"""Share of the largest piece from which on the second one counts as another cell."""

ONE_CELL = "--fragments largest"
"""What to pass to measure the largest piece alone."""

_EIGHT = np.ones((3, 3), dtype=bool)
_FOUR = ndimage.generate_binary_structure(2, 1)


class SeveralCells(MaskError):
    """A mask of one cell holds several."""


def piece_areas(mask: Any) -> IntArray:
    """Pixels of each connected piece (8-connected), the largest first.

    Parameters
    ----------
    mask : ndarray of shape (H, W)
        What is not 0 belongs to a piece.

    Returns
    -------
    ndarray of shape (N,) and dtype int
    """
    labels, _ = ndimage.label(mask != 0, structure=_EIGHT)
    areas: IntArray = np.sort(np.bincount(labels.ravel())[1:])[::-1]
    return areas


def several_words(mask: Any) -> str:
    """What makes a mask that of several cells, in words; empty for one cell, with or without crumbs, or none.

    Parameters
    ----------
    mask : ndarray of shape (H, W)
        What is not 0 belongs to the cell.

    Returns
    -------
    str
        As "2 pieces, the second 45 % of the largest".
    """
    inside = np.asarray(mask) != 0
    if not inside.any() or has_one_outline(inside):
        return ""
    areas = piece_areas(inside)
    if len(areas) < 2 or areas[1] < SEVERAL_FROM * areas[0]:
        return ""
    return f"{len(areas)} pieces, the second {areas[1] / areas[0]:.0%} of the largest".replace("%", " %")


def without_others(mask: Any, fragments: Literal["refuse", "largest"], label: int | None) -> Any:
    """A mask as it is, or the reason why it cannot be that of one cell.

    Parameters
    ----------
    mask : ndarray of shape (H, W)
        What is not 0 belongs to the cell.
    fragments : {"refuse", "largest"}
        With "largest" it is never refused.
    label : int or None
        Its label in a label image.

    Returns
    -------
    ndarray of shape (H, W), or SeveralCells
        The error as data.
    """
    if fragments == "largest" or not (words := several_words(mask)):
        return mask
    if label is None:
        return SeveralCells(
            f"the mask has {words}, so it holds several cells: number them with --label, or measure the "
            f"largest piece alone with {ONE_CELL}"
        )
    return SeveralCells(
        f"label {label} has {words}, so it stands for several cells: give each a label of its own, or "
        f"measure the largest piece alone with {ONE_CELL}"
    )


def largest_piece(mask: BoolArray) -> tuple[BoolArray, int, int]:
    """The largest 8-connected piece of a mask, the first of equals.

    Parameters
    ----------
    mask : ndarray of shape (H, W) and dtype bool

    Returns
    -------
    piece : ndarray of shape (H, W) and dtype bool
    count : int
        How many pieces there are.
    dropped : int
        Pixels of the others.
    """
    labels, count = ndimage.label(mask, structure=_EIGHT)
    if count == 1:
        return mask, 1, 0
    areas = np.bincount(labels.ravel())[1:]
    piece: BoolArray = labels == 1 + int(areas.argmax())
    return piece, int(count), int(areas.sum() - areas.max())


def holes_in(piece: BoolArray) -> tuple[BoolArray | None, int]:
    """Background that a piece encloses, all of it and in how many holes; None if there is none.

    Background is 4-connected where the cell is 8-connected, so that a diagonal contact closes a hole.

    Parameters
    ----------
    piece : ndarray of shape (H, W) and dtype bool
    """
    labels, count = ndimage.label(np.pad(~piece, 1, constant_values=True), structure=_FOUR)
    if count == 1:
        return None, 0
    holes: BoolArray = ((labels != 0) & (labels != labels[0, 0]))[1:-1, 1:-1]
    return holes, int(count) - 1


def pixels_around(holes: BoolArray, nucleus: BoolArray) -> int:
    """Pixels of the holes that hold some part of the nucleus.

    Parameters
    ----------
    holes, nucleus : ndarray of shape (H, W) and dtype bool
    """
    labels, _ = ndimage.label(holes, structure=_FOUR)
    held = np.unique(labels[holes & nucleus])
    return int(np.isin(labels, held[held > 0]).sum())
