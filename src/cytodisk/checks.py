"""One checker for each kind of argument; the error names it, what came and what to do."""

from __future__ import annotations

import math
import os
from collections.abc import Collection
from typing import Any, TypeVar

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError

SMALLEST_SCALE, LARGEST_SCALE = 1e-6, 1e6
"""µm per pixel and seconds per frame: from far below an atom to a metre, from 1 µs to 12 days."""

Word = TypeVar("Word", bound=str)


def is_number(value: Any) -> bool:
    """Whether a value is one finite real number; True and False are none."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer | np.floating):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # a whole number beyond all floats
        return False


def whole_number(name: str, value: Any, least: int, most: float = np.inf) -> int:
    """A parameter as a whole number; 2.0 counts as 2.

    Parameters
    ----------
    name : str
        Name of the parameter, for the message.
    value : object
    least : int
    most : float
        Both counted.

    Returns
    -------
    int

    Raises
    ------
    ParameterError
        It is not a number, not whole, or out of range.
    """
    if not (is_number(value) and least <= value <= most and value == int(value)):
        words = f"of at least {least}" if most == np.inf else f"from {least} to {most}"
        raise ParameterError(f"{name} must be a whole number {words}, got {value!r}")
    return int(value)


def number_between(name: str, value: Any, low: float, high: float = np.inf) -> float:
    """A parameter as a number from `low` to `high`, both counted.

    Raises
    ------
    ParameterError
        It is not a number, or out of range.
    """
    if not (is_number(value) and low <= value <= high):
        words = f"of at least {low:g}" if high == np.inf else f"from {low:g} to {high:g}"
        raise ParameterError(f"{name} must be a number {words}, got {value!r}")
    return float(value)


def positive_number(name: str, value: Any) -> float:
    """A parameter as a number above 0.

    Raises
    ------
    ParameterError
        It is not a number, or not above 0.
    """
    if not (is_number(value) and value > 0):
        raise ParameterError(f"{name} must be a positive number, got {value!r}")
    return float(value)


def one_of(name: str, value: Any, choices: Collection[Word]) -> Word:
    """A parameter that is one of a few words.

    Raises
    ------
    ParameterError
        It is another one.
    """
    chosen: Word = value
    if not (isinstance(value, str) and value in choices):
        raise ParameterError(f"{name} must be one of {', '.join(choices)}, got {value!r}")
    return chosen


def instance_of(name: str, value: Any, kinds: type | tuple[type, ...], words: str, hint: str = "") -> None:
    """Check that an argument is an object of one kind, or of a few.

    Parameters
    ----------
    name : str
        Name of the argument, for the message.
    value : object
    kinds : type or tuple of type
    words : str
        What it must be, such as "a DiskMovie".
    hint : str
        What to do, such as the order of the arguments.

    Raises
    ------
    ParameterError
        It is something else.
    """
    if not isinstance(value, kinds):
        raise ParameterError(f"{name} must be {words}, got {type(value).__name__}{hint and f': {hint}'}")


def is_path(name: str, value: Any) -> None:
    """Check that an argument is a path, and one that tables and messages can hold: it may have any bytes.

    Raises
    ------
    ParameterError
        It is something else, or not in UTF-8.
    """
    instance_of(name, value, (str, os.PathLike), "a path")
    try:
        text = os.fsencode(value).decode("utf-8")
    except (UnicodeDecodeError, UnicodeEncodeError):
        raise ParameterError(
            f"{name} {os.fspath(value)!a} is not in UTF-8: rename that file or folder"
        ) from None
    if "\0" in text:
        raise ParameterError(f"{name} {text!a} holds a null character, which no path can have: leave it out")


def as_points(name: str, points: Any) -> tuple[FloatArray, tuple[int, ...]]:
    """Points of shape (N, 2), and the shape (…, 2) that they came in.

    Raises
    ------
    ParameterError
        The last dimension is not 2.
    """
    array = np.asarray(points, dtype=np.float64)
    if array.ndim == 0 or array.shape[-1] != 2:
        raise ParameterError(f"{name} must have 2 as its last dimension, got shape {array.shape}")
    return array.reshape(-1, 2), array.shape
