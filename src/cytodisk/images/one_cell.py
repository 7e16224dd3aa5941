"""A mask that is to be one cell's: several pieces of size are refused with both remedies."""

from __future__ import annotations

from typing import Any

from cytodisk.geometry.fragments import SeveralCells, several_words
from cytodisk.images.file_parameters import Fragments

ONE_CELL = "--fragments largest"
"""What to pass to measure the largest piece alone."""


def without_others(mask: Any, fragments: Fragments, label: int | None) -> Any:
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
