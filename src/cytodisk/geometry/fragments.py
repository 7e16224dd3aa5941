"""Pieces of a mask: one cell with crumbs beside it, or several cells."""

from __future__ import annotations

from typing import Any, Literal

import numpy as np
from scipy import ndimage

from cytodisk.arrays import IntArray
from cytodisk.errors import MaskError
from cytodisk.geometry.outline import has_one_outline

SEVERAL_FROM = 0.1
"""Share of the largest piece from which on the second one counts as another cell."""

ONE_CELL = "--fragments largest"
"""What to pass to measure the largest piece alone."""

_EIGHT = np.ones((3, 3), dtype=bool)


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
