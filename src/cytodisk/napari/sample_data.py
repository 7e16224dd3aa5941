"""Sample data of the plugin, simulated: to try each widget without a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.runs.demo_input import demo_movie, demo_signal
from cytodisk.simulate.moving_cells import SimulatedMovie
from cytodisk.simulate.nuclei.label_images_with_nuclei import label_image_with_nuclei
from cytodisk.simulate.signals import depth

LayerData = tuple[Any, dict[str, Any], str]

WRONG_FRAME = 17
"""Of the movie with a mask that is wrong in one frame."""

_ASIDE_PX = 14  # how far the wrong mask reaches beyond the cell
_CELLS, _CELL_PIXEL_UM = 16, 0.32
_CORTEX_PX, _BRIGHT, _BACKGROUND = 4.0, 600.0, 100.0
_CHANNEL_COLOURS = ("magenta", "green")
_WHITE = {0: "transparent", 1: "white", None: "yellow"}  # of labels: the usual colour of 1 is too dark to see


def movie_sample() -> list[LayerData]:
    """One cell in 40 frames, its mask and two signals, of which "edge" follows the edge on one side.

    Returns
    -------
    list of (data, settings, kind)

    Examples
    --------
    >>> from cytodisk.napari.sample_data import movie_sample
    >>> [(kind, settings["name"]) for data, settings, kind in movie_sample()]
    [('image', 'material'), ('image', 'edge'), ('labels', 'masks')]
    """
    truth = demo_movie()
    return _layers(truth, truth.masks.astype(np.uint8))


def wrong_frame_sample() -> list[LayerData]:
    """The same movie with a mask that is far too large in frame 17, as segmentation programs make them.

    Returns
    -------
    list of (data, settings, kind)
    """
    truth = demo_movie()
    masks = truth.masks.astype(np.uint8)
    masks[WRONG_FRAME] |= np.roll(masks[WRONG_FRAME], (_ASIDE_PX, _ASIDE_PX), (0, 1))
    return _layers(truth, masks)


def _layers(truth: SimulatedMovie, masks: Any) -> list[LayerData]:
    place = {
        "scale": (truth.frame_interval_s, truth.pixel_size_um, truth.pixel_size_um),
        "units": ("second", "micrometer", "micrometer"),
        "axis_labels": ("time", "y", "x"),
    }
    signal = demo_signal(truth)
    images: list[LayerData] = [
        (
            np.asarray(signal.sel(channel=name)),
            {"name": str(name), "colormap": colour, "blending": "additive", **place},
            "image",
        )
        for name, colour in zip(signal["channel"].to_numpy(), _CHANNEL_COLOURS, strict=True)
    ]
    return [*images, (masks, {"name": "masks", "opacity": 0.3, "colormap": _WHITE, **place}, "labels")]


def cells_sample() -> list[LayerData]:
    """Sixteen cells of every shape with their nuclei, and a signal in their cortex.

    Returns
    -------
    list of (data, settings, kind)
    """
    field = label_image_with_nuclei(_CELLS, seed=3)
    place = {
        "scale": (_CELL_PIXEL_UM, _CELL_PIXEL_UM),
        "units": ("micrometer", "micrometer"),
        "axis_labels": ("y", "x"),
    }
    cortex = _cortex(field.cells, field.nuclei)
    return [
        (cortex, {"name": "cortex", **place}, "image"),
        (field.nuclei, {"name": "nuclei", "opacity": 0.3, "visible": False, **place}, "labels"),
        (field.cells, {"name": "cells", "opacity": 0.3, **place}, "labels"),
    ]


def _cortex(cells: Any, nuclei: Any) -> Any:
    """Photons of a signal at the edge of each cell, each of another brightness; dim in nuclei."""
    random = np.random.default_rng(3)
    expected = np.full(cells.shape, _BACKGROUND)
    for label in range(1, int(cells.max()) + 1):
        inside = cells == label
        bright = _BRIGHT * random.uniform(0.5, 1.5)
        shade = 0.3 + np.exp(-depth(inside)[inside] / _CORTEX_PX)
        expected[inside] += bright * np.where(nuclei[inside] > 0, 0.2, shade)
    return random.poisson(expected).astype(np.uint16)
