"""Draw edge velocity through time: mean of the sectors, and how far they spread."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from cytodisk.errors import ParameterError
from cytodisk.plot.style import LINE_COLOUR
from cytodisk.plot.time_axis import stands_alone, time_axis

SPREAD = (10, 90)  # percentiles


def draw_mean_velocity(
    ax: Axes,
    velocity: Any,
    *,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
    unit: str = "µm/s",
) -> Line2D:
    """Draw edge velocity through time: mean of the sectors, and their percentiles 10 to 90.

    Parameters
    ----------
    ax : Axes
    velocity : array_like of shape (T, S)
        Positive outwards; NaN is left out, a frame without any number is a gap.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where the time axis starts.
    unit : str
        Unit of the velocity.

    Returns
    -------
    Line2D
        The mean.

    Raises
    ------
    ParameterError
        The velocity is no table, or the interval is not a positive number.

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
    table = np.asarray(velocity, dtype=np.float64)
    if table.ndim != 2 or not table.size:
        raise ParameterError(f"velocity must have shape (T, S), got {table.shape}: pass frames by sectors")
    time = time_axis(ax, len(table), frame_interval_s, first_frame)
    known = np.isfinite(table).any(axis=1)
    mean, low, high = np.full((3, len(table)), np.nan)
    if known.any():
        mean[known] = np.nanmean(table[known], axis=1)
        low[known], high[known] = np.nanpercentile(table[known], SPREAD, axis=1)
    ax.axhline(0.0, color="0.6", linewidth=0.5)
    ax.fill_between(
        time, low, high, color="0.8", linewidth=0, label=f"percentiles {SPREAD[0]}–{SPREAD[1]} of sectors"
    )
    alone = stands_alone(mean)
    ax.vlines(time[alone], low[alone], high[alone], color="0.8", linewidth=2.0)
    ax.plot(time[alone], mean[alone], ".", color=LINE_COLOUR, markersize=3.0)
    (line,) = ax.plot(time, mean, color=LINE_COLOUR, linewidth=1.0, label="mean of sectors")
    ax.set_ylabel(f"edge velocity ({unit})")
    ax.legend(frameon=False, ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.1)
    return line
