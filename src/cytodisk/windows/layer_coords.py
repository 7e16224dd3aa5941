"""Coordinates along the layers of a grid."""

from typing import Any

import numpy as np

from cytodisk.windows.on_cell import Grid
from cytodisk.windows.polar_layout import PolarLayout


def layer_coords(grid: Grid) -> dict[str, Any]:
    """The coordinate layer of a Dataset; with layers of a nucleus compartment, too, along it.

    Parameters
    ----------
    grid : PolarGrid or any other grid

    Returns
    -------
    dict
    """
    coords: dict[str, Any] = {"layer": np.arange(grid.layers)}
    if isinstance(grid, PolarLayout) and grid.nucleus_layers:
        coords["compartment"] = ("layer", grid.compartments)
    return coords
