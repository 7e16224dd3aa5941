"""How regular windows on a cell are: the measures of the paper (Fig. 3B), by window and by layer."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr

from cytodisk.windows.layer_coords import layer_coords
from cytodisk.windows.on_cell import WindowsOnCell


def window_measures(windows: WindowsOnCell) -> xr.Dataset:
    """Area, eccentricity and connectedness of each window.

    Parameters
    ----------
    windows : WindowsOnCell
        Of any kind: polar, edge-based, rings.

    Returns
    -------
    Dataset with dims (layer, sector)
        area in square pixels, 0 for an empty window; eccentricity of the ellipse with the window's second
        moments, 0 to 1, NaN for an empty one; pieces that the window falls into, 0 for an empty one. With the
        dim layer alone: layer_pieces, the pieces that the windows of a layer fall into together, and
        completeness, the share of windows that hold signal, NaN for a layer deeper than the cell. The attr
        coverage is the share of the cell's area that lies in a window.

    See Also
    --------
    measures_by_layer : Their means and spread by layer.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.polar_windows(layers=2, sectors=6).on(cd.map_to_disk(cd.simulate.disk(15)))
    >>> measures = cd.window_measures(windows)
    >>> measures["area"].round().to_numpy()  # square pixels, by layer and sector
    array([[59., 59., 59., 59., 59., 59.],
           [59., 59., 59., 59., 59., 59.]])
    """
    by_window = ("layer", "sector")
    return xr.Dataset(
        {
            "area": (by_window, windows.areas, {"units": "px²"}),
            "eccentricity": (by_window, windows.eccentricities, {"units": "1"}),
            "pieces": (by_window, windows.pieces, {"units": "1"}),
            "layer_pieces": ("layer", windows.layer_pieces, {"units": "1"}),
            "completeness": ("layer", windows.completeness, {"units": "1"}),
        },
        layer_coords(windows.grid) | {"sector": np.arange(windows.sectors)},
        attrs={"coverage": windows.coverage} | windows.scale.attrs,
    )


def measures_by_layer(windows: WindowsOnCell | xr.Dataset) -> xr.Dataset:
    """Completeness of each layer, and how much its windows differ.

    Parameters
    ----------
    windows : WindowsOnCell, or Dataset
        Windows on a cell, or what `window_measures` made of them.

    Returns
    -------
    Dataset with dims (layer,)
        completeness, the share of windows that hold signal; over those that do, area_cv and eccentricity_cv,
        the coefficients of variation (standard deviation over mean; NaN for fewer than two windows, or where
        the mean is 0, as that of the eccentricities of squares), mean area (square pixels), mean
        eccentricity, mean pieces, and one_piece, the share of windows in one piece; layer_pieces, the pieces
        of the layer as a whole.

    See Also
    --------
    window_measures : The same for each window.

    References
    ----------
    u-Unwrap, section 4.1 and Fig. 3B.

    Examples
    --------
    >>> import cytodisk as cd
    >>> windows = cd.polar_windows(layers=2, sectors=6).on(cd.map_to_disk(cd.simulate.disk(15)))
    >>> cd.measures_by_layer(windows)["completeness"].to_numpy()
    array([1., 1.])
    """
    measures = windows if isinstance(windows, xr.Dataset) else window_measures(windows)
    held = measures["area"] > 0
    area, pieces = measures["area"].where(held), measures["pieces"].where(held)
    table = {
        "completeness": measures["completeness"],
        "area": area.mean("sector"),
        "area_cv": _variation(area),
        "eccentricity": measures["eccentricity"].mean("sector"),
        "eccentricity_cv": _variation(measures["eccentricity"]),
        "pieces": pieces.mean("sector"),
        "one_piece": (pieces == 1).where(held).mean("sector"),
        "layer_pieces": measures["layer_pieces"],
    }
    units: dict[str, Any] = {name: {"units": "px²" if name == "area" else "1"} for name in table}
    return xr.Dataset({name: column.assign_attrs(units[name]) for name, column in table.items()})


def _variation(values: xr.DataArray) -> xr.DataArray:
    """Standard deviation over mean, over sectors; NaN where fewer than two have a value, or the mean is 0."""
    mean = values.mean("sector")
    enough = (values.count("sector") > 1) & (mean > 0)
    return values.std("sector").where(enough) / mean
