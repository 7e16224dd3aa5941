"""Numbers that a caller passes, checked."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.errors import ParameterError


def whole_number(name: str, value: Any, least: int) -> int:
    """A parameter as a whole number; 2.0 counts as 2.

    Parameters
    ----------
    name : str
        Of the parameter, for the message.
    value : object
    least : int

    Returns
    -------
    int

    Raises
    ------
    ParameterError
        It is not a number, not whole, or below `least`.
    """
    number = isinstance(value, int | float | np.integer | np.floating) and not isinstance(value, bool)
    if not (number and least <= value < np.inf and value == int(value)):
        raise ParameterError(f"{name} must be a whole number of at least {least}, got {value!r}")
    return int(value)
