"""Correlations of a cell as the page shows them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.io.study import Study
from cytodisk.report.cell_data import CellData
from cytodisk.report.encode import pack_floats

MOST_CURVE_NUMBERS = 1_500_000
"""Of curves of single windows that a page holds; beyond, only peaks and the layers' curves are shown."""

_PEAK = ("correlation", "lag", "p", "q", "n", "n_effective", "low", "high")
_CURVE = ("correlation", "low", "high")


def pairs_of(cell: CellData) -> tuple[list[dict[str, Any]], list[str]]:
    """Every correlation of a study for one cell.

    Parameters
    ----------
    cell : CellData

    Returns
    -------
    pairs : list of dict
        For the page's scripts; empty if nothing was correlated.
    notes : list of str
        What was left out, in words.
    """
    study: Any = cell.study
    found = [(names, study.correlation(*names)) for names in correlated(cell.study)]
    numbers = sum(len(_of(cell, one.curves)) * len(_CURVE) for _, one in found)
    with_curves = numbers <= MOST_CURVE_NUMBERS
    pairs = [_pair(cell, names, one, with_curves) for names, one in found]
    left_out = (
        [] if with_curves else ["correlation curves of single windows (only those of layers are shown)"]
    )
    return [pair for pair in pairs if pair is not None], left_out


def correlated(study: Study) -> list[tuple[str, str]]:
    """Pairs of names that were correlated in a study."""
    return list(getattr(study, "correlations", []))


def _pair(cell: CellData, names: tuple[str, str], found: Any, with_curves: bool) -> dict[str, Any] | None:
    windows, layers = _of(cell, found.windows), _of(cell, found.layers)
    layer_curves = _of(cell, found.layer_curves)
    if windows.empty:
        return None
    lags = np.unique(layer_curves["lag"].to_numpy())
    curves = _of(cell, found.curves) if with_curves else None
    return {
        "signal": names[0],
        "with": names[1],
        "lags": lags.tolist(),
        "windows": {name: pack_floats(_grid(cell, windows, name)) for name in _PEAK if name in windows},
        "curves": None if curves is None else dict(_curves(cell, curves, lags)),
        "layer_curves": pack_floats(_curve(cell, layer_curves, "correlation", lags)),
        "threshold": pack_floats(_layer(cell, layers, "threshold")),
    }


def _curves(cell: CellData, curves: pd.DataFrame, lags: Any) -> Iterator[tuple[str, Any]]:
    for name in _CURVE:
        yield name, pack_floats(_curve(cell, curves, name, lags))


def _of(cell: CellData, table: pd.DataFrame) -> pd.DataFrame:
    return table[table["cell"] == cell.cell]


def _grid(cell: CellData, table: pd.DataFrame, name: str) -> FloatArray:
    values = np.full((cell.grid.layers, cell.grid.sectors), np.nan)
    values[table["layer"].to_numpy(), table["sector"].to_numpy()] = table[name].to_numpy(dtype=np.float64)
    return values


def _layer(cell: CellData, table: pd.DataFrame, name: str) -> FloatArray:
    values = np.full(cell.grid.layers, np.nan)
    values[table["layer"].to_numpy()] = table[name].to_numpy(dtype=np.float64)
    return values


def _curve(cell: CellData, table: pd.DataFrame, name: str, lags: Any) -> FloatArray:
    """By layer, sector if the table has one, and lag."""
    axes = [table["layer"].to_numpy(), np.searchsorted(lags, table["lag"].to_numpy())]
    shape = [cell.grid.layers, len(lags)]
    if "sector" in table:
        axes.insert(1, table["sector"].to_numpy())
        shape.insert(1, cell.grid.sectors)
    values = np.full(shape, np.nan)
    values[tuple(axes)] = table[name].to_numpy(dtype=np.float64)
    return values
