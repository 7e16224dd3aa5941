"""Draw the correlations of all layers of a cell against lag in one pair of axes."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cytodisk.plot.correlation.lag_axis import LagUnit, rows_of_cell, sides
from cytodisk.plot.layer_looks import layer_colours, layer_names, shown_layers
from cytodisk.plot.style import CHANCE_LINE, LINE_COLOUR

_CURVES = {"cell", "layer", "lag", "correlation"}


def draw_lag_curves(
    ax: Axes, by_layer: pd.DataFrame, *, cell: int = 0, signal: str = "signal", with_: str = "velocity"
) -> list[Line2D]:
    """Draw the mean correlation of layers against lag, all in one picture.

    Parameters
    ----------
    ax : Axes
    by_layer : DataFrame
        `layer_curves` of a study's correlation.
    cell : int
    signal, with_ : str
        Names for the words at the lags.

    Returns
    -------
    list of Line2D
        One for each of `shown_layers`, dark for the edge; broken lines show what chance gives the first.

    See Also
    --------
    draw_correlation_curves : Layer under layer, with quartiles.
    """
    curves = rows_of_cell(by_layer, cell, _CURVES, "by_layer")
    numbers = np.unique(curves["layer"])
    layers = [int(numbers[place]) for place in shown_layers(len(numbers))]
    unit, lines = LagUnit.of(curves), []
    ax.axhline(0.0, color=LINE_COLOUR, linewidth=0.5)
    ax.axvline(0.0, color=LINE_COLOUR, linewidth=0.5)
    names = layer_names(layers, len(numbers), None)
    for layer, name, colour in zip(layers, names, layer_colours(layers), strict=True):
        one = curves[curves["layer"] == layer].sort_values("lag")
        lines += ax.plot(one[unit.column], one["correlation"], color=colour, linewidth=1.2, label=name)
    first = curves[curves["layer"] == layers[0]]
    if "threshold" in first and np.isfinite(first["threshold"].iloc[0]):
        for side in (-1, 1):
            ax.axhline(side * first["threshold"].iloc[0], color=CHANCE_LINE, linestyle="--", linewidth=0.8)
    ax.margins(x=0.0)
    ax.set_xlabel(f"{unit.label}\n{sides(signal, with_)}", parse_math=False)
    ax.set_ylabel("correlation")
    return lines
