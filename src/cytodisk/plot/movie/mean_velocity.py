"""Draw edge velocity through time: mean of the sectors, and how far they spread."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cytodisk.analysis.top_speed import top_speed
from cytodisk.plot.number_tables import number_table
from cytodisk.plot.style import LINE_COLOUR, key_above
from cytodisk.plot.time_axis import FrameTimes, stands_alone
from cytodisk.plot.units import velocity_unit, with_unit
from cytodisk.scale import Scale

SPREAD = (10, 90)  # percentiles


def draw_mean_velocity(ax: Axes, velocity: Any, *, scale: Scale | None = None) -> Line2D:
    """Draw edge velocity through time: mean of the sectors, and their percentiles 10 to 90.

    Parameters
    ----------
    ax : Axes
    velocity : array_like or DataArray of shape (T, S)
        Positive outwards; NaN is left out, a frame without any number is a gap. A DataArray, such as
        `edge_velocity` returns, brings its unit and its times.
    scale : Scale, optional
        Of plain numbers: their unit and the time between frames. Unknown, they are in px/frame and frames.

    Returns
    -------
    Line2D
        The mean.

    Raises
    ------
    ParameterError
        The velocity is no table of numbers.

    See Also
    --------
    draw_velocity_map : By sector.
    draw_area_change : Areas won and lost.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=12.0)
    >>> velocity = cd.edge_velocity(cd.map_movie(truth.masks), sectors=8)
    >>> figure, ax = plt.subplots()
    >>> line = cd.plot.draw_mean_velocity(ax, velocity)
    >>> len(line.get_xdata())
    4
    """
    table = number_table(velocity, "velocity", ("time", "sector"))
    times = FrameTimes.of(velocity, "velocity", scale)
    time = times.set_axis(ax)
    unit = velocity_unit(velocity, scale, times.unit, top_speed(table))
    table = unit.factor * table
    known = np.isfinite(table).any(axis=1)
    mean, low, high = np.full((3, len(table)), np.nan)
    if known.any():
        mean[known] = np.nanmean(table[known], axis=1)
        low[known], high[known] = np.nanpercentile(table[known], SPREAD, axis=1)
    ax.axhline(0.0, color="0.6", linewidth=0.5)
    words = f"percentiles {SPREAD[0]}–{SPREAD[1]} of sectors"
    ax.fill_between(time, low, high, color="0.8", linewidth=0, label=words)
    alone = stands_alone(mean)
    ax.vlines(time[alone], low[alone], high[alone], color="0.8", linewidth=2.0)
    ax.plot(time[alone], mean[alone], ".", color=LINE_COLOUR, markersize=3.0)
    (line,) = ax.plot(time, mean, color=LINE_COLOUR, linewidth=1.0, label="mean of sectors")
    ax.set_ylabel(with_unit("edge velocity", unit.name))
    key_above(ax)
    return line
