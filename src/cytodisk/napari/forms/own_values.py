"""The values of one model among those of several."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from cytodisk.parameters import Group


def with_own(model: type[Group], values: Mapping[str, Any], flags: Mapping[str, str]) -> Group:
    """A model of parameters with those of the values that are its own.

    Parameters
    ----------
    model : type of Parameters
    values : mapping
        By name, of this model and of others.
    flags : mapping of str to str
        What messages call them.

    Returns
    -------
    Parameters

    Raises
    ------
    ParameterError
        A value is wrong, or two exclude each other.
    """
    return model.called({name: one for name, one in values.items() if name in model.model_fields}, flags)
