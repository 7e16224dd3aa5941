"""Draw a signal by layer and condition: experiments as lines, their mean and its interval."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from cytodisk.arrays import FloatArray
from cytodisk.number_words import rounded
from cytodisk.plot.layer_looks import cytoplasm_layers_of
from cytodisk.plot.nucleus.nucleus_profile import shade_compartments
from cytodisk.plot.population.condition_looks import checked_units, condition_colours
from cytodisk.plot.population.experiment_lines import (
    BAND_OPACITY,
    EXPERIMENT_LOOK,
    MEAN_LOOK,
    draw_experiment_lines,
    fit_to_lines,
)
from cytodisk.plot.style import LINE_COLOUR, plain_numbers
from cytodisk.plot.time_axis import TICK_STEPS

_MOST_TICKS = 10
_MOST_BAND = 0.4  # of the range of the lines, that bands may reach beyond it
_MARKS = ("o", "s", "^", "D", "v", "P", "X")


def draw_condition_profiles(
    ax: Axes, profiles: pd.DataFrame, *, depths: xr.DataArray | None = None, label: str = "mean"
) -> list[Line2D]:
    """Draw a signal by layer, from the centre of the cell on the left to its edge on the right.

    A thin line is an experiment (the mean of its cells), a thick one the mean of experiments, the band its
    95 % interval over experiments.

    Parameters
    ----------
    ax : Axes
    profiles : DataFrame
        condition, experiment, layer and value: a row for each experiment of a condition and layer, or for
        each cell, which are averaged by experiment then.
    depths : DataArray with the dim layer, optional
        Depth of the layers with its unit; the medians over other dims are written below the layers. Its
        coordinate compartment tells layers of the nucleus, which are marked.
    label : str
        Of the upright axis.

    Returns
    -------
    list of Line2D
        The means, one a condition, in the order of the table.

    Raises
    ------
    ParameterError
        A column is missing, or there is no row.

    See Also
    --------
    draw_atlas : By sector too.
    condition_key : Says what lines and bands are.

    Examples
    --------
    >>> import itertools
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> rows = itertools.product(["control", "drug"], ["day 1", "day 2"], range(4))
    >>> profiles = pd.DataFrame(rows, columns=["condition", "experiment", "layer"])
    >>> profiles["value"] = 100.0 - 10 * profiles["layer"] + 5 * (profiles["condition"] == "drug")
    >>> figure, ax = plt.subplots()
    >>> control, drug = cd.plot.draw_condition_profiles(ax, profiles, label="mean Rac1 (a.u.)")
    >>> drug.get_label()
    'drug'
    """
    rows = checked_units(profiles, "profiles", ("layer", "value"))
    layers = np.unique(rows["layer"].to_numpy())
    count = len(layers)
    places = np.asarray(count - 0.5 - np.arange(count), dtype=np.float64)
    colours = condition_colours(list(dict.fromkeys(rows["condition"])))
    lines = []
    for mark, (name, colour) in zip(_MARKS * len(colours), colours.items(), strict=False):
        own = rows[rows["condition"] == name]
        table = own.pivot_table(
            index="experiment", columns="layer", values="value", dropna=False, sort=False, observed=True
        ).reindex(columns=layers)
        values = table.to_numpy(dtype=np.float64)
        lines.append(draw_experiment_lines(ax, places, values, colour, label=name, mark=mark))
    outer = cytoplasm_layers_of(depths)
    if outer is not None and outer < count:
        shade_compartments(ax, (0.0, float(count - outer), float(count)))
    else:
        _mark_ends(ax, count)
    _label_layers(ax, layers, places, depths)
    ax.set_xlim(0.0, float(count))
    ax.set_ylabel(label, parse_math=False)
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    ax.yaxis.set_major_formatter(plain_numbers())
    fit_to_lines([ax], _MOST_BAND)
    return lines


def condition_key(lines: list[Line2D], *, cells: bool = False, experiments: bool = True) -> list[Any]:
    """Handles of a legend for lines of conditions, experiments and cells.

    Parameters
    ----------
    lines : list of Line2D
        The means.
    cells : bool
        Whether cells have lines too.
    experiments : bool
        Whether experiments are known; else a line is the mean of all cells.

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_condition_profiles, draw_pooled_curves : Draw the lines.

    Examples
    --------
    >>> from matplotlib.lines import Line2D
    >>> import cytodisk as cd
    >>> handles = cd.plot.condition_key([Line2D([], [], color="black", label="control")])
    >>> [handle.get_label() for handle in handles]
    ['control', 'one experiment', '95 % interval over experiments']
    """
    grey = LINE_COLOUR
    more: list[Any] = []
    if experiments:
        more = [
            Line2D([], [], color=grey, label="one experiment", **EXPERIMENT_LOOK),
            Patch(color=grey, alpha=BAND_OPACITY, linewidth=0, label="95 % interval over experiments"),
        ]
    if cells:
        more.insert(0, Line2D([], [], color="0.75", linewidth=0.5, label="one cell"))
    named = [
        Line2D(
            [],
            [],
            color=line.get_color(),
            label=str(line.get_label()),
            marker=line.get_marker(),
            markersize=3.0,
            **MEAN_LOOK,
        )
        for line in lines
    ]
    return [*named, *more]


def _mark_ends(ax: Axes, count: int) -> None:
    """What lies on the left and on the right, in cells without a nucleus."""
    above: Any = {"xycoords": ax.get_xaxis_transform(), "textcoords": "offset points", "va": "bottom"}
    for x, words, side in ((0.0, "centre", "left"), (float(count), "edge of the cell", "right")):
        ax.annotate(words, (x, 1.0), xytext=(0, 2), ha=side, annotation_clip=False, color="0.3", **above)


def _label_layers(ax: Axes, layers: Any, places: FloatArray, depths: xr.DataArray | None) -> None:
    every = -(-len(layers) // _MOST_TICKS)
    shown = range(0, len(layers), every)
    words, label = [f"{int(layers[k])}" for k in shown], "layer, 0 at the edge"
    if depths is not None and bool(np.isfinite(depths.to_numpy()).any()):
        others = [dim for dim in depths.dims if dim != "layer"]
        deep = depths.median(others).to_numpy() if others else depths.to_numpy()
        words = [f"{word}\n{_short(deep[k])}" for word, k in zip(words, shown, strict=True)]
        label = f"layer, and below it its depth ({depths.attrs.get('units', 'px')})"
    ax.set_xticks(places[list(shown)], words)
    ax.tick_params(axis="x", length=0)
    ax.set_xlabel(label)


def _short(depth: float) -> str:
    return rounded(float(depth), 2) if np.isfinite(depth) else ""
