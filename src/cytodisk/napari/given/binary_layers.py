"""Which image layers look like masks."""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

import numpy as np

from cytodisk.napari.given.layer_kinds import pixels_of

_STEP = 4  # every fourth pixel is looked at

_LOOKED_AT: WeakKeyDictionary[Any, tuple[int, bool]] = WeakKeyDictionary()
"""Arrays of layers, by their id, and whether they look so."""


def looks_binary(layer: Any) -> bool:
    """Whether the first plane of an image layer holds two values, the lower of them 0.

    Parameters
    ----------
    layer : napari.layers.Image

    Returns
    -------
    bool
    """
    data = pixels_of(layer)
    known = _LOOKED_AT.get(layer)
    if known is None or known[0] != id(data):  # once an array: it may lie on a disk far away
        known = _LOOKED_AT[layer] = id(data), _is_binary(data)
    return known[1]


def _is_binary(data: Any) -> bool:
    if data.ndim < 2 or not min(data.shape):
        return False
    plane = np.asarray(data[(0,) * (data.ndim - 2)])[::_STEP, ::_STEP]
    values = np.unique(plane)
    return len(values) == 2 and not values[0]
