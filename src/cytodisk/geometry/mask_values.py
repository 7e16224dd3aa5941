"""Checks of a raw mask: one cell, as a boolean array."""

from typing import Any

import numpy as np

from cytodisk.arrays import BoolArray
from cytodisk.errors import EmptyMaskError, MaskError


def parse_mask(mask: Any) -> BoolArray:
    """Check that an array is the mask of one cell and make it boolean.

    Parameters
    ----------
    mask : array_like of shape (H, W)
        Boolean, or numbers with at most one value beside 0 (for floats: exactly 0 and 1). Of a DataArray the
        dims y and x may come in any order.

    Returns
    -------
    ndarray of shape (H, W) and dtype bool

    Raises
    ------
    MaskError
        Not 2D, several labels, or floats other than 0 and 1.
    EmptyMaskError
        No pixel belongs to the cell.
    """
    if getattr(mask, "dims", None) == ("x", "y"):  # a DataArray goes by its names
        mask = mask.transpose("y", "x")
    try:
        array = np.asarray(mask)
    except ValueError as error:
        raise MaskError(f"mask must be an array of shape (H, W): {error}") from error
    if array.ndim != 2:
        raise MaskError(
            f"mask must be 2D, got shape {array.shape}: pass one image, for a stack one frame at a time"
        )
    if array.dtype == bool:
        parsed: BoolArray = array
    elif np.issubdtype(array.dtype, np.integer):
        parsed = _parse_integers(array)
    elif np.issubdtype(array.dtype, np.floating):
        parsed = _parse_floats(array)
    else:
        raise MaskError(f"mask must be boolean or numeric, got dtype {array.dtype}: pass mask > 0")
    if not parsed.any():
        raise EmptyMaskError(f"mask of shape {array.shape} is empty: no pixel belongs to the cell")
    return parsed


def _parse_integers(array: np.ndarray[Any, Any]) -> BoolArray:
    if array.min(initial=0) < 0:
        raise MaskError(f"mask has negative values (down to {array.min()}): set what is no cell to 0")
    inside: BoolArray = array != 0
    values = array[inside]
    if values.size and values.min() != values.max():
        labels = np.unique(values)
        raise MaskError(
            f"mask holds {len(labels)} labels ({labels[0]} … {labels[-1]}): pass one cell, as mask == label, "
            "or where each label is a cell, kind='labels' (--kind labels)"
        )
    return inside


def _parse_floats(array: np.ndarray[Any, Any]) -> BoolArray:
    if np.isin(array, (0.0, 1.0)).all():
        return np.asarray(array == 1.0)
    if not np.isfinite(array).all():
        raise MaskError(
            f"mask is {array.dtype} with values that are NaN or infinite: set what is no cell to 0"
        )
    raise MaskError(
        f"mask is {array.dtype} with values other than 0 and 1 "
        f"({array.min():g} … {array.max():g}): "
        "threshold it first, as image > threshold"
    )
