"""Draw how fast waves run inwards and around the cell, by depth below the edge."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from cytodisk.plot.style import LINE_COLOUR
from cytodisk.plot.time_axis import TICK_STEPS
from cytodisk.plot.units import with_unit
from cytodisk.plot.waves.mode_power import wave_rows
from cytodisk.scale import ShownUnit

INWARD_LOOK: Any = {"color": "#D55E00", "marker": "o", "linestyle": "-"}
AROUND_LOOK: Any = {"color": "#0072B2", "marker": "s", "linestyle": (0, (4, 1.5))}
"""Of Okabe and Ito; marks and dashes tell the two apart without colours."""

_COLUMNS = {"layer", "depth", "inward_speed", "around_speed"}


def draw_depth_speeds(
    ax: Axes, depths: pd.DataFrame, *, speed: ShownUnit | None = None, length_unit: str = "µm"
) -> list[Line2D]:
    """Draw the speed of waves inwards and around by depth.

    Parameters
    ----------
    ax : Axes
    depths : DataFrame
        Rows of one cell of a study's `waves.depths`: depth, median of the layer below the edge;
        inward_speed, positive inwards; around_speed, positive towards higher sectors, clockwise in the image.
    speed : ShownUnit, optional
        Unit that the speeds are shown in; by default as they are, without a unit.
    length_unit : str
        Of the depths.

    Returns
    -------
    list of Line2D
        Inwards and around. What is not known is a gap.

    Raises
    ------
    ParameterError
        The table lacks a column, has no rows, or those of several cells.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import pandas as pd
    >>> import cytodisk as cd
    >>> columns = ["layer", "depth", "inward_speed", "around_speed"]
    >>> rows = pd.DataFrame([(0, 0.5, 0.1, 0.2), (1, 1.5, 0.1, 0.15)], columns=columns)
    >>> figure, ax = plt.subplots()
    >>> lines = cd.plot.draw_depth_speeds(ax, rows)
    """
    rows = wave_rows(depths, "depths", _COLUMNS).sort_values("depth")
    unit = ShownUnit("") if speed is None else speed
    common: Any = {"linewidth": 0.9, "markersize": 3.2, "clip_on": False}
    lines = []
    for name, look, words in (
        ("inward_speed", INWARD_LOOK, "inwards"),
        ("around_speed", AROUND_LOOK, "around, above 0 clockwise"),
    ):
        values = unit.factor * rows[name].to_numpy(dtype=np.float64)
        lines += ax.plot(rows["depth"].to_numpy(dtype=np.float64), values, label=words, **look, **common)
    ax.axhline(0.0, color=LINE_COLOUR, linewidth=0.4, zorder=0.5)
    ax.set(xlabel=f"depth below the edge ({length_unit})", ylabel=with_unit("speed", unit.name))
    ax.yaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    ax.xaxis.set_major_locator(MaxNLocator(5, steps=TICK_STEPS))
    return lines
