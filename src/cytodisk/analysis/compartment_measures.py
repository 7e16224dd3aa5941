"""How equal windows are in area within cytoplasm and nucleus."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from scipy.stats import spearmanr

from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.pixel_shares.shares import strips
from cytodisk.windows.rings.nucleus_edges import NucleusEdges

_FIVE = 5


def compartment_measures(windows: WindowsOnCell, compartments: Any) -> dict[str, float]:
    """How unequal the areas of windows are within each compartment, and how much the outermost layer holds.

    Parameters
    ----------
    windows : WindowsOnCell
    compartments : array_like of shape (layers,)
        Name of each layer's compartment, as `grid.compartments` gives it.

    Returns
    -------
    dict of str to float
        area_error_<compartment>, the mean |ln| of the areas of its windows over their mean; NaN if all are
        empty. Empty windows count in the mean area alone, since their logarithm is infinite.
    """
    names = np.asarray(compartments)
    found = {}
    for name in dict.fromkeys(names.tolist()):
        areas = windows.areas[names == name]
        held = areas[areas > 0.0]
        error = np.abs(np.log(held / areas.mean())).mean() if len(held) else np.nan
        found[f"area_error_{name}"] = float(error)
    return found


def outermost_share(windows: WindowsOnCell, compartments: Any) -> float:
    """Share of the cytoplasm's area that lies in layer 0, 0 to 1; NaN if windows hold none of it.

    Parameters
    ----------
    windows : WindowsOnCell
    compartments : array_like of shape (layers,)
    """
    by_layer = windows.areas.sum(axis=1)
    whole = by_layer[np.asarray(compartments) == "cytoplasm"].sum()
    return float(by_layer[0] / whole) if whole else float("nan")


def outer_fifth(windows: Any) -> float:
    """Share of the cytoplasm in the outermost of five layers of the same kind; a fifth if they are equal.

    Parameters
    ----------
    windows : WindowsOnCell
        Of a grid with layers of cytoplasm and nucleus.
    """
    five = replace(windows, grid=replace(windows.grid, layers=_FIVE + 1, sectors=1, nucleus_layers=1))
    return outermost_share(five, five.grid.compartments)


def nearness(windows: WindowsOnCell, compartments: Any, edges: NucleusEdges) -> float:
    """Rank correlation of the layers of the cytoplasm with the nearness to the nucleus, −1 to 1, or NaN.

    Parameters
    ----------
    windows : WindowsOnCell
    compartments : array_like of shape (layers,)
    edges : NucleusEdges
        Of the cell and its nucleus.

    Returns
    -------
    float
        Spearman's, over the pixels of the cytoplasm: their layer, counted from the edge, and how short their
        way through the cell to the nucleus is. Pixels in no window, or in one of the nucleus, do not count.
    """
    layer = windows.labels // windows.sectors
    held = (windows.labels >= 0) & (layer < np.count_nonzero(np.asarray(compartments) == "cytoplasm"))
    pixels = np.argwhere(held & ~edges.nucleus.mask)
    if len(pixels) < 2:
        return float("nan")
    ways = [edges.ways_from_nucleus(block).mean(axis=1) for _, block in strips(pixels)]
    layers = layer[tuple(pixels.T)]
    return float(spearmanr(layers, -np.concatenate(ways)).statistic) if np.ptp(layers) else float("nan")
