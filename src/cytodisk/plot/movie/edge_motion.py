"""Draw how a cell's edge moves through a movie: outlines and paths of points, area won and lost."""

from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D

from cytodisk.arrays import FloatArray
from cytodisk.checks import whole_number
from cytodisk.errors import ParameterError
from cytodisk.plot.field_of_view import field_of_view, frame_field
from cytodisk.plot.style import (
    INWARD_COLOUR,
    LINE_COLOUR,
    OUTWARD_COLOUR,
    SIGNAL_COLOURS,
    colour_bar,
    key_above,
    scale_bar,
)
from cytodisk.plot.time_axis import FrameTimes, stands_alone
from cytodisk.plot.time_raster import bar_beside
from cytodisk.plot.units import scale_for, unit_of, with_unit
from cytodisk.scale import Scale

# The signal's colours without their light end, which is lost on white.
_TIME_COLOURS = ListedColormap(mpl.colormaps[SIGNAL_COLOURS](np.linspace(0.0, 0.88, 256)))


def draw_tracks(
    ax: Axes,
    points_yx: FloatArray,
    *,
    every: int = 1,
    first_frame: int = 0,
    paths: int = 12,
    scale: Scale | None = None,
) -> LineCollection:
    """Draw outlines of a movie in colours of time, and the paths of a few tracked points.

    Parameters
    ----------
    ax : Axes
    points_yx : ndarray of shape (T, N, 2) and dtype float
        Tracked points of a closed edge, (row, column) in pixels; frames with NaN are left out.
    every : int
        The outline of every so many frames.
    first_frame : int
        Number of the first frame, where time starts.
    paths : int
        Number of points whose path is drawn, evenly chosen; a dot is where it starts.
    scale : Scale, optional
        Such as `movie.scale`. Unknown, the scale bar is in px and time in frames.

    Returns
    -------
    LineCollection
        The outlines; its array is their time.

    Raises
    ------
    ParameterError
        The points have another shape, or a number is out of its range.

    See Also
    --------
    draw_velocity_arrows : From a frame to the next.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> movie = cd.map_movie(cd.simulate.movie("bulging", frames=4, radius_px=12.0).masks)
    >>> figure, ax = plt.subplots()
    >>> outlines = cd.plot.draw_tracks(ax, movie.points_yx)
    >>> len(outlines.get_paths())
    4
    """
    points = np.asarray(points_yx, dtype=np.float64)
    if points.ndim != 3 or points.shape[-1] != 2 or not points.size:
        raise ParameterError(f"points_yx must have shape (T, N, 2), got {points.shape}: pass tracked points")
    whole_number("every", every, 1)
    whole_number("paths", paths, 0)
    known = scale or Scale()
    times = FrameTimes(first_frame, len(points), known.frame_interval_s)
    shown = [t for t in range(0, len(points), every) if np.isfinite(points[t]).all()]
    closed = [np.concatenate([points[t], points[t, :1]])[:, ::-1] for t in shown]
    lines = LineCollection(closed, cmap=_TIME_COLOURS, linewidths=0.5)
    lines.set_array(times.at[shown])
    lines.set_clim(times.at[0], times.at[0] + times.per_frame * max(len(points) - 1, 1))
    ax.add_collection(lines, autolim=False)
    _draw_paths(ax, points, paths)
    if shown:
        frame_field(ax, field_of_view([points]))
        scale_bar(ax, known)
        ax.apply_aspect()
    colour_bar(lines, bar_beside(ax), times.label)
    return lines


def draw_area_change(
    ax: Axes, protruded: Any, retracted: Any, *, scale: Scale | None = None
) -> tuple[Line2D, Line2D]:
    """Draw the area that the whole edge won, upwards, and lost, downwards, from frame to frame.

    Parameters
    ----------
    ax : Axes
    protruded, retracted : array_like or DataArray of shape (T,)
        Areas, the sum over sectors; the sign of the second does not matter. NaN is a gap. A DataArray brings
        its unit and its times.
    scale : Scale, optional
        Of plain numbers: the unit of areas and the time between frames. Unknown, they are in px² and frames.

    Returns
    -------
    (Line2D, Line2D)
        Area won and area lost, the second below 0.

    Raises
    ------
    ParameterError
        The areas are not as many, or their frames are not at even steps.

    See Also
    --------
    draw_mean_velocity : Velocity through time.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> truth = cd.simulate.movie("growing", frames=4, radius_px=12.0)
    >>> changes = cd.edge_changes(cd.map_movie(truth.masks), sectors=8)
    >>> figure, ax = plt.subplots()
    >>> total = changes.sum("sector", keep_attrs=True)
    >>> won, lost = cd.plot.draw_area_change(ax, total["protruded_area"], total["retracted_area"])
    """
    won, lost = (np.asarray(area, dtype=np.float64) for area in (protruded, retracted))
    if won.ndim != 1 or won.shape != lost.shape or not won.size:
        raise ParameterError(
            f"protruded has shape {won.shape}, retracted {lost.shape}: pass one number a frame"
        )
    time = FrameTimes.of(protruded, "protruded", scale).set_axis(ax)
    alone = stands_alone(won)
    ax.axhline(0.0, color=LINE_COLOUR, linewidth=0.5)
    lines = []
    for area, colour, name in (
        (won, OUTWARD_COLOUR, "protruded"),
        (-np.abs(lost), INWARD_COLOUR, "retracted"),
    ):
        ax.fill_between(time, area, color=colour, alpha=0.2, linewidth=0)
        lines += ax.plot(time, area, color=colour, linewidth=1.0, label=name)
        ax.plot(time[alone], area[alone], ".", color=colour, markersize=3.0)
    unit = unit_of(protruded, scale_for(protruded, scale).area_unit)
    ax.set_ylabel(with_unit("area per frame", unit))
    key_above(ax)
    return lines[0], lines[1]


def _draw_paths(ax: Axes, points: FloatArray, paths: int) -> None:
    chosen = np.unique(np.linspace(0, points.shape[1], paths, endpoint=False).astype(int))
    traced = points[:, chosen]
    ax.plot(traced[..., 1], traced[..., 0], linewidth=0.8, color=LINE_COLOUR, zorder=4)
    ax.plot(traced[0, :, 1], traced[0, :, 0], "o", markersize=2.0, color=LINE_COLOUR, zorder=4)
