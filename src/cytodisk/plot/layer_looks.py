"""Which layers a picture shows, their names and their colours."""

from __future__ import annotations

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.plot.style import LAYER_COLOURS

_MOST_LAYERS = 4
_LIGHTEST = 0.85  # share of the colours that can be seen on white


def shown_layers(layers: int) -> list[int]:
    """Layers that pictures show: all up to four, else the edge's, two between, the centre's.

    Parameters
    ----------
    layers : int
        At least 1.

    Returns
    -------
    list of int
    """
    chosen = np.linspace(0, layers - 1, min(layers, _MOST_LAYERS)).round().astype(int)
    return [int(layer) for layer in np.unique(chosen)]


def layer_names(layers: Sequence[int], count: int, depths: xr.DataArray | None = None) -> list[str]:
    """Names of layers, with what the first and last are, and how deep they lie.

    Parameters
    ----------
    layers : sequence of int
    count : int
        Number of all layers.
    depths : DataArray with the dim layer, optional
        As `activity["depth"]`, with its unit; the median over all other dims is told, or of layers by depth
        their borders, where the attribute "borders" has them.

    Returns
    -------
    list of str
        As "layer 0 (edge), 0.4 µm deep" or "layer 0 (edge), 0–0.5 µm".
    """
    places = {count - 1: " (centre)", 0: " (edge)"}
    deep = dict.fromkeys(layers, "")
    if depths is not None:
        borders = depths.attrs.get("borders", [""] * count)
        deep = {
            layer: f", {borders[layer]}"
            if borders[layer]
            else depth_words(float(depths.sel(layer=layer).median()), depths)
            for layer in layers
        }
    return [f"layer {layer}{places.get(layer, '')}{deep[layer]}" for layer in layers]


def depth_words(depth: float, depths: xr.DataArray) -> str:
    """A depth as ", 0.4 µm deep"; empty where it is NaN."""
    return f", {rounded(depth, 2)} {depths.attrs.get('units', 'px')} deep" if np.isfinite(depth) else ""


def layer_colours(layers: Sequence[int]) -> FloatArray:
    """Colours of lines on white, from dark for the first layer to light for the last.

    Parameters
    ----------
    layers : sequence of int

    Returns
    -------
    ndarray of shape (N, 4) and dtype float
        Red, green, blue and opacity.
    """
    return np.asarray(mpl.colormaps[LAYER_COLOURS](np.linspace(0.0, _LIGHTEST, len(layers))))
