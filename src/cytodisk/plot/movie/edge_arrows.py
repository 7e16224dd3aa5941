"""Draw where the points of a cell's edge go from one frame to the next."""

from typing import Any, Literal

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Polygon
from matplotlib.quiver import Quiver

from cytodisk.arrays import FloatArray
from cytodisk.checks import one_of, positive_number, whole_number
from cytodisk.errors import ParameterError
from cytodisk.geometry.outline import on_border
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.edge import normal_displacement
from cytodisk.motion.tracking import TrackedBoundary
from cytodisk.plot.field_of_view import field_of_view, frame_field
from cytodisk.plot.style import (
    INWARD_COLOUR,
    LINE_COLOUR,
    MM_PER_INCH,
    OUTWARD_COLOUR,
    nice_length,
    scale_bar,
)
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale

_THIS_FRAME, _NEXT_FRAME = "0.65", "black"
_ARROW_WIDTH_MM = 0.22
_LONGEST_ARROW = 0.15  # of the cell, at most; the key's arrow, of the axes' width
_KEY_BELOW = 5.0  # points, at the height of the scale bar


def draw_velocity_arrows(
    ax: Axes,
    movie: DiskMovie,
    frame: int,
    *,
    every: int = 4,
    stretch: float | None = 1.0,
    along: Literal["path", "normal"] = "path",
    scale: Scale | None = None,
) -> Quiver:
    """Draw where the tracked points of an edge go until the next frame, red outwards and blue inwards.

    Parameters
    ----------
    ax : Axes
    movie : DiskMovie
    frame : int
        It and the next have a map. Points on the image's border, where the cell is cut off, have no arrow.
    every : int
        An arrow at every so many points.
    stretch : float, optional
        Length of the arrows over that of the displacements; None makes the longest 6 to 15 % of the cell.
    along : {"path", "normal"}
        Whether arrows follow the points, or show the part of it along the normal.
    scale : Scale, optional
        By default that of the movie; without a pixel size the scale is in px.

    Returns
    -------
    Quiver
        With stretch 1 arrows that follow the points end on the next outline.

    Raises
    ------
    ParameterError
        A frame has no map, or an option is out of its range.

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
    >>> movie = cd.map_movie(cd.simulate.movie("growing", frames=3, radius_px=12.0).masks)
    >>> figure, ax = plt.subplots()
    >>> arrows = cd.plot.draw_velocity_arrows(ax, movie, 1, every=8)
    """
    whole_number("every", every, 1)
    one_of("along", along, ("path", "normal"))
    stretch = None if stretch is None else positive_number("stretch", stretch)
    here, there = _two_boundaries(movie, frame)
    distance = normal_displacement(here, there)
    for boundary in (here, there):
        distance[on_border(boundary.outline_points_yx, movie.image_shape)] = np.nan
    step = there.points_yx - here.points_yx if along == "path" else distance[:, None] * here.normals_yx
    shown = np.flatnonzero(np.isfinite(distance[::every])) * every
    starts, step, distance = here.points_yx[shown], step[shown], distance[shown]
    outlines = here.contour.outline_yx, there.contour.outline_yx
    _draw_closed(ax, outlines[0], _THIS_FRAME, 0.8, "this frame")
    _draw_closed(ax, outlines[1], _NEXT_FRAME, 0.6, "next frame")
    longer = stretch or _readable_stretch(step, outlines[0])
    arrows = _draw_arrows(ax, starts, step, distance, longer)
    frame_field(ax, field_of_view([*outlines, starts + longer * step]))
    known = scale_for(movie, scale)
    scale_bar(ax, known)
    _draw_key(ax, arrows, step, longer, known)
    return arrows


def _two_boundaries(movie: DiskMovie, frame: int) -> tuple[TrackedBoundary, TrackedBoundary]:
    whole_number("frame", frame, 0)
    both = [record.boundary for record in movie.records[frame : frame + 2]]
    known = [boundary for boundary in both if boundary is not None]
    if len(known) < 2:
        raise ParameterError(f"frame {frame} or the next has no map: choose two frames in a row that have")
    return known[0], known[1]


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


def _longer_words(stretch: float) -> str:
    """How much longer than the way an arrow is, in words; empty if it is not."""
    times = {1.0: "", 2.0: "twice"}.get(stretch, f"{stretch:g} times")
    return f"\n(arrows {times} as long)" if times else ""


def _draw_key(ax: Axes, arrows: Quiver, step_yx: FloatArray, stretch: float, scale: Scale) -> None:
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
    size = scale.length(1.0)
    room = _LONGEST_ARROW * abs(float(np.subtract(*ax.get_xlim()))) / stretch
    length = nice_length(size * min(longest, room))
    words = f"{length:g} {scale.length_unit} per frame{_longer_words(stretch)}"
    ax.apply_aspect()
    below = -_KEY_BELOW / 72.0 * ax.figure.dpi / ax.get_window_extent().height
    ax.quiverkey(arrows, 0.64, below, length / size, words, labelpos="E", labelsep=0.04, color=LINE_COLOUR)
