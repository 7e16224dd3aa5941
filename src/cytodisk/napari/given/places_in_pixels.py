"""Places of one layer in the pixels of another, as they lie on each other in the viewer."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray


def in_pixels(layer: Any, points: FloatArray, image: Any | None) -> FloatArray:
    """Points of a layer in the pixels of an image layer.

    Parameters
    ----------
    layer : napari.layers.Layer
    points : ndarray of shape (N, D)
        In the data coordinates of `layer`.
    image : napari.layers.Layer or None
        None leaves the points as they are.

    Returns
    -------
    ndarray of shape (N, D)
    """
    if image is None:
        return points
    dims = points.shape[1]
    world = np.array([layer.data_to_world(point) for point in points], dtype=float)
    padded = np.zeros((len(world), max(dims, image.ndim)))
    padded[:, -dims:] = world
    found = np.array([image.world_to_data(place) for place in padded], dtype=float)
    both = min(dims, found.shape[1])
    moved = points.copy()
    moved[:, -both:] = found[:, -both:]
    return moved
