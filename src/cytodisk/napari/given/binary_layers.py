"""Which image layers look like masks."""

from __future__ import annotations

from typing import Any

import numpy as np

_STEP = 4  # every fourth pixel is looked at


def looks_binary(layer: Any) -> bool:
    """Whether the first plane of an image layer holds two values, the lower of them 0.

    Parameters
    ----------
    layer : napari.layers.Image

    Returns
    -------
    bool
    """
    data = layer.data[0] if layer.multiscale else layer.data
    if data.ndim < 2 or not min(data.shape):
        return False
    plane = np.asarray(data[(0,) * (data.ndim - 2)])[::_STEP, ::_STEP]
    values = np.unique(plane)
    return len(values) == 2 and not values[0]
