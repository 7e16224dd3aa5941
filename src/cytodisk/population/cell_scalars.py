"""One number a cell: level by layer, ratios, polarity."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.population.cell_directions import around, first_harmonic
from cytodisk.population.ratios import known_mean, ratio

Blocks = Callable[[], Iterator[tuple[slice, FloatArray]]]
Levels = Callable[[], Iterator[tuple[slice, FloatArray, FloatArray]]]

MEAN, LAYER = "mean_{}", "layer_{}_{}"
EDGE_TO_CENTRE, TO_CYTOPLASM, POLARITY = (
    "edge_to_centre_{}",
    "nucleus_to_cytoplasm_{}",
    "polarity_{}",
)


def scalar_names(
    channels: Sequence[str], compartments: Sequence[str], last: str
) -> dict[str, tuple[str, str]]:
    """Names of the scalars that follow from the windows: by name the channel and what it is in words.

    Parameters
    ----------
    channels, compartments : sequence of str
    last : str
        The values' last dim.

    Returns
    -------
    dict
    """
    names = {}
    for channel in channels:
        names[MEAN.format(channel)] = channel, "mean of the cell, not normalised"
        for layer in range(len(compartments)):
            names[LAYER.format(layer, channel)] = channel, f"mean of layer {layer}"
        if last != "sector":
            continue
        if len(_outside(compartments)) > 1:
            names[EDGE_TO_CENTRE.format(channel)] = channel, "outermost over innermost layer"
        if "nucleus" in compartments:
            names[TO_CYTOPLASM.format(channel)] = channel, "nucleus over cytoplasm"
        names[POLARITY.format(channel)] = channel, "first harmonic around the cell over the mean"
    return names


def scalars_of(
    cells: pd.DataFrame,
    named: Sequence[str],
    channels: Sequence[str],
    compartments: Sequence[str],
    blocks: Blocks,
    levels: Levels,
    last: str,
) -> pd.DataFrame:
    """The table of `Population.scalar_table`.

    Parameters
    ----------
    cells : DataFrame
    named : sequence of str
        Columns of cells that are scalars themselves.
    channels, compartments : sequence of str
    blocks, levels : callable
        See `Population`; values that are not turned, normalised and as they were.
    last : str

    Returns
    -------
    DataFrame
    """
    names = scalar_names(channels, compartments, last)
    columns = {name: np.full(len(cells), np.nan) for name in names}
    for (rows, block), (_, level, weight) in zip(blocks(), levels(), strict=True):
        for k, channel in enumerate(channels):
            columns[MEAN.format(channel)][rows] = known_mean(level[:, k], (1, 2), weight)
            for layer in range(len(compartments)):
                columns[LAYER.format(layer, channel)][rows] = known_mean(
                    block[:, k, layer], 1, weight[:, layer]
                )
            if last == "sector":
                _fill_ratios(columns, channel, rows, level[:, k], weight, compartments)
    for name in named:
        if name not in columns:
            columns[name] = cells[name].to_numpy(dtype=np.float64, na_value=np.nan)
    return pd.DataFrame(columns, index=cells.index)


def _fill_ratios(
    columns: dict[str, FloatArray],
    channel: str,
    rows: slice,
    level: FloatArray,
    weight: FloatArray,
    compartments: Sequence[str],
) -> None:
    outside = _outside(compartments)
    inside = [k for k in range(len(compartments)) if k not in outside]
    if len(outside) > 1:
        edge, centre = outside[0], outside[-1]
        columns[EDGE_TO_CENTRE.format(channel)][rows] = _above(
            known_mean(level[:, edge], 1, weight[:, edge]),
            known_mean(level[:, centre], 1, weight[:, centre]),
        )
    if "nucleus" in compartments:
        columns[TO_CYTOPLASM.format(channel)][rows] = _above(
            known_mean(level[:, inside], (1, 2), weight[:, inside]),
            known_mean(level[:, outside], (1, 2), weight[:, outside]),
        )
    sectors = level.shape[-1]
    wave = 2.0 * np.abs(first_harmonic(level)) / sectors
    columns[POLARITY.format(channel)][rows] = _above(wave, around(level).mean(axis=-1))


def _outside(compartments: Sequence[str]) -> list[int]:
    """Layers of the cytoplasm, or all of a cell without a nucleus."""
    return [k for k, name in enumerate(compartments) if name != "nucleus"]


def _above(above: FloatArray, below: FloatArray) -> FloatArray:
    """NaN where what it is divided by is not above 0."""
    return ratio(above, below, below > 0)
