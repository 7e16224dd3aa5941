"""Which layers a picture shows, their names and their colours.

Layers of a nucleus have a hue of their own: cytoplasm from brown at the membrane to yellow at the nucleus,
nucleus from dark to light blue. People with any colour blindness tell the two apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.colors import LinearSegmentedColormap

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.plot.style import LAYER_COLOURS

CYTOPLASM_COLOURS = LinearSegmentedColormap.from_list(
    "cytoplasm", ["#5A1F04", "#C0480B", "#F58518", "#FDC46B", "#FFF0C8"]
)
NUCLEUS_COLOURS = LinearSegmentedColormap.from_list("nucleus", ["#0B2E6B", "#2F74C0", "#9CC9EF"])
NUCLEUS_LINE = "#56B4E9"
"""Of lines over an image: sky blue, of Okabe and Ito."""

_DASHES: Any = ("-", (0, (4.0, 1.2)), (0, (1.2, 1.0)), (0, (5.0, 1.2, 1.2, 1.2)))
_MOST_LAYERS = 4
_MOST_IN_CYTOPLASM, _MOST_IN_NUCLEUS = 3, 2
_LIGHTEST = 0.85  # share of the colours that can be seen on white
_LIGHTEST_CYTOPLASM, _LIGHTEST_NUCLEUS = 0.5, 0.75


def layer_dashes(layers: Sequence[int]) -> list[Any]:
    """Dashes of the line of each shown layer: without colours, neighbours are told apart.

    The last is solid as the first is: their colours differ most.
    """
    inner = [_DASHES[place % len(_DASHES)] for place in range(len(layers) - 1)]
    return [*inner, "-"] if len(layers) else []


def shown_layers(layers: int, cytoplasm_layers: int | None = None) -> list[int]:
    """Layers that pictures show: all up to four, else the edge's, two between, the centre's.

    Parameters
    ----------
    layers : int
        At least 1.
    cytoplasm_layers : int, optional
        How many of them are not in the nucleus, where cells have one: then three of these, and two of the
        nucleus.

    Returns
    -------
    list of int
    """
    if cytoplasm_layers is None:
        return _spread(0, layers, _MOST_LAYERS)
    outer = _spread(0, cytoplasm_layers, _MOST_IN_CYTOPLASM)
    return outer + _spread(cytoplasm_layers, layers, _MOST_IN_NUCLEUS)


def cytoplasm_layers_of(values: Any) -> int | None:
    """How many layers of an array are not in the nucleus, by its coordinate compartment; None without it."""
    coords = getattr(values, "coords", {})
    if "compartment" not in coords:
        return None
    return int((np.atleast_1d(coords["compartment"].to_numpy()) != "nucleus").sum())


def layer_names(
    layers: Sequence[int],
    count: int,
    depths: xr.DataArray | None = None,
    cytoplasm_layers: int | None = None,
) -> list[str]:
    """Names of layers, with what the first and last are, and how deep they lie.

    Parameters
    ----------
    layers : sequence of int
    count : int
        Number of all layers.
    depths : DataArray with the dim layer, optional
        As `activity["depth"]`, with its unit; the median over all other dims is told, or of layers by depth
        their borders, where the attribute "borders" has them. Its coordinate compartment tells layers of the
        nucleus.
    cytoplasm_layers : int, optional
        How many of the layers are not in the nucleus, where `depths` does not say so.

    Returns
    -------
    list of str
        As "layer 0 (edge), 0.4 µm deep" or "layer 0 (edge), 0–0.5 µm"; in cells with a nucleus "layer 7 (at
        the nucleus), 3.1 µm deep" and "layer 8 (nucleus 1), 4 µm deep".
    """
    outer = cytoplasm_layers_of(depths) if cytoplasm_layers is None else cytoplasm_layers
    deep = dict.fromkeys(layers, "")
    if depths is not None:
        borders = depths.attrs.get("borders", [""] * count)
        deep = {
            layer: f", {borders[layer]}"
            if borders[layer]
            else depth_words(float(depths.sel(layer=layer).median()), depths)
            for layer in layers
        }
    return [f"{layer_word(layer, count, outer)}{deep[layer]}" for layer in layers]


def layer_word(layer: int, count: int, cytoplasm_layers: int | None = None) -> str:
    """Name of a layer with what it is, as "layer 0 (edge)", "layer 3", "layer 8 (nucleus 1)"."""
    return f"layer {layer}{layer_place(layer, count, cytoplasm_layers)}"


def layer_place(layer: int, count: int, cytoplasm_layers: int | None = None) -> str:
    """What a layer is, as " (edge)", " (at the nucleus)", " (nucleus 1)", " (centre)"; empty for others."""
    if cytoplasm_layers is None:
        return {count - 1: " (centre)", 0: " (edge)"}.get(layer, "")
    if layer >= cytoplasm_layers:
        return f" (nucleus {layer - cytoplasm_layers + 1})"
    return {cytoplasm_layers - 1: " (at the nucleus)", 0: " (edge)"}.get(layer, "")


def depth_words(depth: float, depths: xr.DataArray) -> str:
    """A depth as ", 0.4 µm deep"; empty where it is NaN."""
    return f", {rounded(depth, 2)} {depths.attrs.get('units', 'px')} deep" if np.isfinite(depth) else ""


def layer_colours(layers: Sequence[int], cytoplasm_layers: int | None = None) -> FloatArray:
    """Colours of lines on white, from dark for the first layer to light for the last.

    Parameters
    ----------
    layers : sequence of int
        Increasing.
    cytoplasm_layers : int, optional
        How many layers are not in the nucleus, where cells have one; those in it are blue.

    Returns
    -------
    ndarray of shape (N, 4) and dtype float
        Red, green, blue and opacity.
    """
    if cytoplasm_layers is None:
        return np.asarray(mpl.colormaps[LAYER_COLOURS](np.linspace(0.0, _LIGHTEST, len(layers))))
    inside = sum(layer >= cytoplasm_layers for layer in layers)
    return np.concatenate(
        [
            CYTOPLASM_COLOURS(np.linspace(0.0, _LIGHTEST_CYTOPLASM, len(layers) - inside)),
            NUCLEUS_COLOURS(np.linspace(0.0, _LIGHTEST_NUCLEUS, inside)),
        ]
    )


def layer_fills(layers: int, nucleus_layers: int) -> FloatArray:
    """Colours that fill all layers of cells with a nucleus, dark at the membrane and at the nuclear outline.

    Parameters
    ----------
    layers, nucleus_layers : int
        Number of all layers, and of the last ones that are in the nucleus.

    Returns
    -------
    ndarray of shape (layers, 4) and dtype float
    """
    return np.concatenate(
        [
            CYTOPLASM_COLOURS(np.linspace(0.0, 1.0, layers - nucleus_layers)),
            NUCLEUS_COLOURS(np.linspace(0.0, 1.0, nucleus_layers)),
        ]
    )


def _spread(first: int, stop: int, most: int) -> list[int]:
    """All numbers from one to another, or as many as wanted, evenly spread."""
    chosen = np.linspace(first, stop - 1, min(stop - first, most)).round().astype(int)
    return [int(layer) for layer in np.unique(chosen)]
