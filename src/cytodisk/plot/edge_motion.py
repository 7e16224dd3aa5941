"""Draw how a cell's edge moves: arrows of one frame, outlines through time, area won and lost."""

from typing import Any, Literal

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.quiver import Quiver

from cytodisk.arrays import FloatArray
from cytodisk.errors import ParameterError
from cytodisk.plot.activity_maps import bar_beside
from cytodisk.plot.strip import field_of_view, frame_field
from cytodisk.plot.style import LINE_COLOUR, MM_PER_INCH, SIGNAL_COLOURS, colour_bar, nice_length, scale_bar
from cytodisk.plot.time_axis import stands_alone, time_axis, time_scale

OUTWARD_COLOUR, INWARD_COLOUR = "#B2182B", "#2166AC"  # near the ends of the diverging colours

_THIS_FRAME, _NEXT_FRAME = "0.65", "black"
_ARROW_WIDTH_MM = 0.22
_LONGEST_ARROW = 0.15  # of the cell, at most; the key's arrow, of the axes' width
_KEY_BELOW = 5.0  # points, at the height of the scale bar
# The signal's colours without their light end, which is lost on white.
_TIME_COLOURS = ListedColormap(mpl.colormaps[SIGNAL_COLOURS](np.linspace(0.0, 0.88, 256)))


def draw_velocity_arrows(
    ax: Axes,
    points_yx: FloatArray,
    next_points_yx: FloatArray,
    normals_yx: FloatArray,
    displacement_px: FloatArray,
    outline_yx: FloatArray,
    next_outline_yx: FloatArray,
    *,
    pixel_size_um: float | None = None,
    every: int = 4,
    stretch: float | None = 1.0,
    along: Literal["path", "normal"] = "path",
) -> Quiver:
    """Draw where the tracked points of an edge go until the next frame, red outwards and blue inwards.

    Parameters
    ----------
    ax : Axes
    points_yx, next_points_yx : ndarray of shape (N, 2) and dtype float
        Tracked points in this frame and the next, (row, column) in pixels; NaN is left out.
    normals_yx : ndarray of shape (N, 2) and dtype float
        Outward unit normals in this frame.
    displacement_px : ndarray of shape (N,) and dtype float
        Along the normals, positive outwards; gives the colours.
    outline_yx, next_outline_yx : ndarray of shape (B, 2) and dtype float
        Outlines of the two frames, drawn grey and black.
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale is in px.
    every : int
        An arrow at every so many points.
    stretch : float, optional
        Length of the arrows over that of the displacements; None makes the longest 6 to 15 % of the cell.
    along : {"path", "normal"}
        Whether arrows follow the points, or show the part of it along the normal.

    Returns
    -------
    Quiver
        With stretch 1 arrows that follow the points end on the next outline.

    Raises
    ------
    ParameterError
        The arrays do not fit each other, or an option is out of its range.

    See Also
    --------
    draw_tracks : Through the whole movie.

    References
    ----------
    u-Unwrap, Fig. S5.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> movie = cd.map_movie(cd.simulate.movie("growing", frames=2, radius_px=12.0).masks)
    >>> here, there = movie.points_yx
    >>> normals = movie.normals_yx[0]
    >>> along = ((there - here) * normals).sum(axis=1)
    >>> figure, ax = plt.subplots()
    >>> outlines = movie[0].outline_yx, movie[1].outline_yx
    >>> arrows = cd.plot.draw_velocity_arrows(ax, here, there, normals, along, *outlines)
    """
    points = np.asarray(points_yx, dtype=np.float64)
    distance = np.asarray(displacement_px, dtype=np.float64)
    _check_arrows(points, next_points_yx, normals_yx, distance, every, stretch, along)
    step = next_points_yx - points if along == "path" else distance[:, None] * normals_yx
    step = step[::every]
    seen = np.isfinite(step).all(axis=1) & np.isfinite(distance[::every])
    starts, step = points[::every][seen], step[seen]
    outlines = (np.asarray(outline_yx), np.asarray(next_outline_yx))
    _draw_closed(ax, outlines[0], _THIS_FRAME, 0.8, "this frame")
    _draw_closed(ax, outlines[1], _NEXT_FRAME, 0.6, "next frame")
    longer = stretch or _readable_stretch(step, outlines[0])
    arrows = _draw_arrows(ax, starts, step, distance[::every][seen], longer)
    frame_field(ax, field_of_view([*outlines, starts + longer * step]))
    scale_bar(ax, pixel_size_um)
    _draw_key(ax, arrows, step, longer, pixel_size_um)
    return arrows


def draw_tracks(
    ax: Axes,
    points_yx: FloatArray,
    *,
    every: int = 1,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
    pixel_size_um: float | None = None,
    paths: int = 12,
) -> LineCollection:
    """Draw outlines of a movie in colours of time, and the paths of a few tracked points.

    Parameters
    ----------
    ax : Axes
    points_yx : ndarray of shape (T, N, 2) and dtype float
        Tracked points of a closed edge, (row, column) in pixels; frames with NaN are left out.
    every : int
        The outline of every so many frames.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where time starts.
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale bar is in px.
    paths : int
        Number of points whose path is drawn, evenly chosen; a dot is where it starts.

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
    _check_count("every", every, 1)
    _check_count("paths", paths, 0)
    step, label = time_scale(first_frame + len(points), frame_interval_s)
    shown = [t for t in range(0, len(points), every) if np.isfinite(points[t]).all()]
    closed = [np.concatenate([points[t], points[t, :1]])[:, ::-1] for t in shown]
    lines = LineCollection(closed, cmap=_TIME_COLOURS, linewidths=0.5)
    lines.set_array(step * (first_frame + np.array(shown, dtype=np.float64)))
    lines.set_clim(step * first_frame, step * (first_frame + max(len(points) - 1, 1)))
    ax.add_collection(lines, autolim=False)
    _draw_paths(ax, points, paths)
    if shown:
        frame_field(ax, field_of_view([points]))
        scale_bar(ax, pixel_size_um)
        ax.apply_aspect()
    colour_bar(lines, bar_beside(ax), label)
    return lines


def draw_area_change(
    ax: Axes,
    protruded: Any,
    retracted: Any,
    *,
    frame_interval_s: float | None = None,
    first_frame: int = 0,
    unit: str = "px²",
) -> tuple[Line2D, Line2D]:
    """Draw the area that the whole edge won, upwards, and lost, downwards, from frame to frame.

    Parameters
    ----------
    ax : Axes
    protruded, retracted : array_like of shape (T,)
        Areas, the sum over sectors; the sign of the second does not matter. NaN is a gap.
    frame_interval_s : float, optional
        Seconds between frames; without it time is in frames.
    first_frame : int
        Number of the first frame, where time starts.
    unit : str
        Unit of the areas.

    Returns
    -------
    (Line2D, Line2D)
        Area won and area lost, the second below 0.

    Raises
    ------
    ParameterError
        The areas are not as many, or the interval is not a positive number.

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
    won, lost = np.asarray(protruded, dtype=np.float64), -np.abs(np.asarray(retracted, dtype=np.float64))
    if won.ndim != 1 or won.shape != lost.shape or not won.size:
        raise ParameterError(
            f"protruded has shape {won.shape}, retracted {lost.shape}: pass one number a frame"
        )
    time = time_axis(ax, len(won), frame_interval_s, first_frame)
    alone = stands_alone(won)
    ax.axhline(0.0, color=LINE_COLOUR, linewidth=0.5)
    lines = []
    for area, colour, name in ((won, OUTWARD_COLOUR, "protruded"), (lost, INWARD_COLOUR, "retracted")):
        ax.fill_between(time, area, color=colour, alpha=0.2, linewidth=0)
        lines += ax.plot(time, area, color=colour, linewidth=1.0, label=name)
        ax.plot(time[alone], area[alone], ".", color=colour, markersize=3.0)
    ax.set_ylabel(f"area per frame ({unit})")
    ax.legend(frameon=False, ncols=2, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=0.1)
    return lines[0], lines[1]


def _check_arrows(
    points: FloatArray,
    next_points: FloatArray,
    normals: FloatArray,
    distance: FloatArray,
    every: int,
    stretch: float | None,
    along: str,
) -> None:
    shapes = {"next_points_yx": np.shape(next_points), "normals_yx": np.shape(normals)}
    wrong = {name: shape for name, shape in shapes.items() if shape != points.shape}
    if wrong or points.ndim != 2 or points.shape[-1] != 2 or distance.shape != points.shape[:1]:
        raise ParameterError(
            f"points_yx has shape {points.shape}, displacement_px {distance.shape}, {shapes}: "
            "pass (N, 2), and (N,) for the displacement"
        )
    _check_count("every", every, 1)
    if stretch is not None and not 0 < stretch < np.inf:
        raise ParameterError(f"stretch must be a positive number, got {stretch!r}: None chooses it")
    if along not in ("path", "normal"):
        raise ParameterError(f"along must be 'path' or 'normal', got {along!r}")


def _check_count(name: str, value: int, least: int) -> None:
    if isinstance(value, bool) or not isinstance(value, int | np.integer) or value < least:
        raise ParameterError(f"{name} must be a whole number of at least {least}, got {value!r}")


def _draw_closed(ax: Axes, outline_yx: FloatArray, color: str, linewidth: float, label: str) -> None:
    ax.add_artist(Polygon(outline_yx[:, ::-1], fill=False, edgecolor=color, linewidth=linewidth, label=label))


def _draw_arrows(
    ax: Axes, points_yx: FloatArray, step_yx: FloatArray, distance: FloatArray, stretch: float
) -> Quiver:
    return ax.quiver(
        points_yx[:, 1],
        points_yx[:, 0],
        step_yx[:, 1],
        step_yx[:, 0],
        color=np.where(distance >= 0, OUTWARD_COLOUR, INWARD_COLOUR).tolist(),
        angles="xy",
        scale_units="xy",
        scale=1.0 / stretch,
        units="inches",
        width=_ARROW_WIDTH_MM / MM_PER_INCH,
        headwidth=3.5,
        headlength=4.0,
        headaxislength=3.6,
        minlength=0.5,
        zorder=4,
    )


def _readable_stretch(step_yx: FloatArray, outline_yx: FloatArray) -> float:
    longest = float(np.hypot(*step_yx.T).max(initial=0.0))
    size = float(np.ptp(outline_yx, axis=0).max())
    return nice_length(max(_LONGEST_ARROW * size / longest, 1.0)) if longest > 0 else 1.0


def _draw_key(
    ax: Axes, arrows: Quiver, step_yx: FloatArray, stretch: float, pixel_size_um: float | None
) -> None:
    """Above the cell what lines and colours mean, below it how far an arrow of known length goes."""
    handles = [
        Line2D([], [], color=color, linewidth=linewidth, label=label)
        for label, color, linewidth in (
            ("outwards", OUTWARD_COLOUR, 1.5),
            ("inwards", INWARD_COLOUR, 1.5),
            ("this frame", _THIS_FRAME, 0.8),
            ("next frame", _NEXT_FRAME, 0.6),
        )
    ]
    place: Any = {"loc": "lower left", "bbox_to_anchor": (0.0, 1.0), "borderaxespad": 0.2}
    ax.legend(handles=handles, ncols=2, frameon=False, handlelength=1.2, columnspacing=1.2, **place)
    if not (longest := float(np.hypot(*step_yx.T).max(initial=0.0))):
        return
    unit, size = ("px", 1.0) if pixel_size_um is None else ("µm", pixel_size_um)
    room = _LONGEST_ARROW * abs(float(np.subtract(*ax.get_xlim()))) / stretch
    length = nice_length(size * min(longest, room))
    words = f"{length:g} {unit} per frame" + (f" (× {stretch:g})" if stretch != 1.0 else "")
    ax.apply_aspect()
    below = -_KEY_BELOW / 72.0 * ax.figure.dpi / ax.get_window_extent().height
    ax.quiverkey(arrows, 0.64, below, length / size, words, labelpos="E", labelsep=0.04, color=LINE_COLOUR)


def _draw_paths(ax: Axes, points: FloatArray, paths: int) -> None:
    chosen = np.unique(np.linspace(0, points.shape[1], paths, endpoint=False).astype(int))
    traced = points[:, chosen]
    ax.plot(traced[..., 1], traced[..., 0], linewidth=0.8, color=LINE_COLOUR, zorder=4)
    ax.plot(traced[0, :, 1], traced[0, :, 0], "o", markersize=2.0, color=LINE_COLOUR, zorder=4)
