"""How equal windows are in area within cytoplasm and nucleus."""

from __future__ import annotations

from typing import Any

import numpy as np

from cytodisk.windows.on_cell import WindowsOnCell


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
