"""What the marks of a SuperPlot are, and their legend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd
from matplotlib.lines import Line2D

from cytodisk.plot.population.condition_looks import Look, are_shared, checked_units, experiment_looks
from cytodisk.plot.style import LINE_COLOUR


def experiment_key(
    cells: pd.DataFrame, conditions: Sequence[str] | None = None, *, paired: bool | None = None
) -> list[Any]:
    """Handles of a legend: which mark is which experiment, and what is a cell, a mean and an interval.

    Parameters
    ----------
    cells : DataFrame
        condition and experiment.
    conditions : sequence of str, optional
        As for `draw_super_plot`.
    paired : bool, optional
        As for `draw_super_plot`.

    Returns
    -------
    list of Artist

    See Also
    --------
    draw_super_plot : Draws the marks.

    Examples
    --------
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> cells = pd.DataFrame({"condition": ["control", "drug"], "experiment": ["day 1", "day 1"]})
    >>> [handle.get_label() for handle in cd.plot.experiment_key(cells)]
    ['day 1', 'cell', 'mean and 95 % interval over experiments']
    """
    rows = checked_units(cells, "cells")
    names = list(dict.fromkeys(rows["condition"])) if conditions is None else [str(one) for one in conditions]
    shared = are_shared(rows) if paired is None else paired
    looks = experiment_looks(in_order(rows, names), shared=shared)
    if shared:
        named: Mapping[str, Look] = {
            experiment: look for (_, experiment), look in looks.items() if experiment
        }
    else:
        known = [(unit, look) for unit, look in looks.items() if unit[1]]
        named = {f"mean of one experiment of {unit[0]}": look for unit, look in reversed(known)}
        named = dict(reversed(list(named.items())))
    handles: list[Any] = [
        Line2D([], [], linewidth=0, label=name, **mean_look(look, 5.0)) for name, look in named.items()
    ]
    handles.append(Line2D([], [], linewidth=0, marker="o", markersize=2.0, color="0.6", label="cell"))
    words = "mean and 95 % interval over experiments" if named else "mean of cells"
    handles.append(Line2D([], [], color=LINE_COLOUR, marker="_", markersize=6, linewidth=0.9, label=words))
    return handles


def in_order(rows: pd.DataFrame, names: Sequence[str]) -> pd.DataFrame:
    """Rows of the named conditions, in the order of the names."""
    return pd.concat([rows[rows["condition"] == name] for name in names])


def mean_look(look: Look, size: float) -> dict[str, Any]:
    """Style of the mark of an experiment's mean, `size` points wide."""
    return {
        "marker": look.mark,
        "markersize": size,
        "markerfacecolor": look.colour,
        "markeredgecolor": "white" if look.colour == "#000000" else "black",
        "markeredgewidth": 0.6,
    }
