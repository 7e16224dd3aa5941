"""Draw windows on a cell through time: frames side by side, to one scale and in one field of view.

Sectors have cyclic colours, so that the eye can follow a window from frame to frame.
"""

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Colormap, LinearSegmentedColormap
from matplotlib.lines import Line2D

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import ParameterError, SignalError
from cytodisk.plot.cell import draw_outline
from cytodisk.plot.style import colour_map, scale_bar, signal_limits
from cytodisk.windows.cell_windows import CellWindows

SECTOR_COLOURS = LinearSegmentedColormap.from_list(
    "sectors", ["#1F3F99", "#1C9AA8", "#E3B92F", "#D1492E", "#7A2A6E", "#1F3F99"]
)
"""Cyclic. Neither white nor black, so that every sector shows on both; without red against green."""

SECTOR_NOTE = "○ sector 0"
EDGE_WIDTH = 2.2  # points
OVER_SIGNAL: Any = {"edgecolors": (1.0, 1.0, 1.0, 0.4), "linewidths": 0.2}
ON_WHITE: Any = {"edgecolors": "0.6", "linewidths": 0.2}

Extent: TypeAlias = tuple[float, float, float, float]

_MARGIN = 0.04  # of the field's longer side
_NOTE_BELOW = 5.0  # points, at the height of the scale bar


def draw_strip(
    axes: Sequence[Axes],
    windows: Sequence[CellWindows],
    titles: Sequence[str],
    *,
    extent_yx: Extent | None = None,
    pixel_size_um: float | None = None,
    signal: Sequence[Any] | None = None,
    cmap: str | Colormap = "gray",
    limits: tuple[float, float] | None = None,
) -> list[PolyCollection]:
    """Draw the windows of a few frames of a movie; six fit the width of a page.

    Without a signal the windows of the outermost layer are filled with the colours of their sectors; over a
    signal, which they would hide, it is the cell's edge that has them.

    Parameters
    ----------
    axes : sequence of Axes
        One a frame.
    windows : sequence of CellWindows
    titles : sequence of str
        One a frame, such as `time_stamp` gives.
    extent_yx : (float, float, float, float), optional
        Field of view: top, bottom, left and right in pixels; by default `field_of_view` of the cells.
    pixel_size_um : float, optional
        Micrometres a pixel; without it the scale bar is in px.
    signal : sequence of array_like of shape (H, W), optional
        One channel, one image a frame.
    cmap : str or Colormap
        Colours of the signal.
    limits : (float, float), optional
        Limits of the signal's colours; by default percentiles 1 and 99.5 inside the cells of all frames.

    Returns
    -------
    list of PolyCollection
        The windows of each frame, one polygon a window, by window number.

    Raises
    ------
    ParameterError
        There is no frame, or not one of everything a frame; or the pixel size is not a positive number.
    SignalError
        An image has another shape than its mask.

    See Also
    --------
    draw_sectors : One frame.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> movie = cd.map_movie(cd.simulate.movie("growing", frames=3, radius_px=12.0).masks)
    >>> grid = cd.polar_windows(layers=3, sectors=8)
    >>> figure, axes = plt.subplots(1, 2)
    >>> drawn = cd.plot.draw_strip(axes, [grid.on(movie[0]), grid.on(movie[2])], ["frame 0", "frame 2"])
    >>> len(drawn)
    2
    """
    images = _images(windows, signal)
    counts = {"axes": len(axes), "titles": len(titles), "signal": len(images)}
    if not windows or any(count != len(windows) for count in counts.values()):
        raise ParameterError(f"windows has {len(windows)} frames, but there are {counts}: pass one a frame")
    extent = extent_yx or field_of_view([frame.disk.outline_yx for frame in windows])
    colours = limits or _common_limits(windows, images)
    drawn = []
    for ax, frame, title, image in zip(axes, windows, titles, images, strict=True):
        if image is not None:
            ax.imshow(image, cmap=colour_map(cmap), vmin=colours[0], vmax=colours[1])
        drawn.append(draw_sectors(ax, frame, over_signal=image is not None))
        frame_field(ax, extent)
        ax.set_title(title, parse_math=False)
    scale_bar(axes[0], pixel_size_um)
    note_sector(axes[-1])
    return drawn


def draw_sectors(ax: Axes, windows: CellWindows, *, over_signal: bool = False) -> PolyCollection:
    """Draw windows whose sectors can be told apart, and mark sector 0 with a ring on the cell's edge.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    over_signal : bool
        Colour the cell's edge rather than fill the windows of the outermost layer.

    Returns
    -------
    PolyCollection
        One polygon a window, by window number.

    See Also
    --------
    draw_strip : Frames of a movie beside each other.

    Examples
    --------
    >>> import matplotlib.pyplot as plt
    >>> import cytodisk as cd
    >>> windows = cd.polar_windows(layers=3, sectors=8).on(cd.map_to_disk(cd.simulate.disk(12)))
    >>> figure, ax = plt.subplots()
    >>> polygons = cd.plot.draw_sectors(ax, windows)
    """
    sectors = windows.grid.sectors
    faces = np.zeros((windows.grid.n_windows, 4))
    if not over_signal:
        faces[:sectors] = sector_colours(sectors)
    polygons = [polygon[:, ::-1] for polygon in windows.polygons()]
    lines = OVER_SIGNAL if over_signal else ON_WHITE
    drawn = PolyCollection(polygons, facecolors=faces, **lines)
    ax.add_collection(drawn, autolim=False)
    draw_edge(ax, windows, over_signal=over_signal)
    return drawn


def draw_edge(ax: Axes, windows: CellWindows, *, over_signal: bool) -> None:
    """Draw the cell's outline, over a signal in the colours of its sectors, and the ring of sector 0.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    over_signal : bool
    """
    if over_signal:
        # White on both sides sets dark colours off a dark image.
        draw_outline(ax, windows.disk, color="white", linewidth=EDGE_WIDTH + 1.0)
        arcs = [arc[:, ::-1] for arc in sector_arcs(windows)]
        colours = sector_colours(windows.grid.sectors)
        edge = LineCollection(arcs, colors=colours, linewidths=EDGE_WIDTH, zorder=4)
        ax.add_collection(edge, autolim=False)
    else:
        draw_outline(ax, windows.disk)
    ((y, x),) = _on_outline(windows.disk, windows.grid.angles[:2].mean(keepdims=True))
    mark_point(ax, y, x)


def mark_point(ax: Axes, y: float, x: float) -> Line2D:
    """Draw the small ring that stands for sector 0.

    Parameters
    ----------
    ax : Axes
    y, x : float

    Returns
    -------
    Line2D
    """
    style: dict[str, Any] = {"markerfacecolor": "white", "markeredgecolor": "black", "markeredgewidth": 0.7}
    (ring,) = ax.plot([x], [y], "o", markersize=3.6, zorder=6, clip_on=False, **style)
    return ring


def note_sector(ax: Axes) -> None:
    """Say below the axes, to the right, what the ring means."""
    ax.annotate(
        SECTOR_NOTE,
        (1.0, 0.0),
        xycoords="axes fraction",
        xytext=(0, -_NOTE_BELOW),
        textcoords="offset points",
        ha="right",
        va="center_baseline",
        annotation_clip=False,
    )


def sector_colours(sectors: int) -> FloatArray:
    """Cyclic colours: neighbours are alike, the last sector and the first too.

    Parameters
    ----------
    sectors : int

    Returns
    -------
    ndarray of shape (sectors, 4) and dtype float
        Red, green, blue and opacity.
    """
    return np.asarray(SECTOR_COLOURS((np.arange(sectors) + 0.5) / sectors))


def sector_arcs(windows: CellWindows) -> list[FloatArray]:
    """The part of the cell's outline that belongs to each sector, both ends included.

    Parameters
    ----------
    windows : CellWindows

    Returns
    -------
    list of ndarray of shape (N, 2) and dtype float
        (row, column) in pixels.
    """
    angles = windows.grid.angles
    within = np.unique(np.concatenate([np.mod(windows.disk.boundary_angles, 2.0 * np.pi), angles]))
    points, ends = _on_outline(windows.disk, within), np.searchsorted(within, angles)
    return [points[ends[k] : ends[k + 1] + 1] for k in range(windows.grid.sectors)]


def field_of_view(outlines_yx: Sequence[FloatArray]) -> Extent:
    """The field that holds all outlines of a movie with a small margin.

    Parameters
    ----------
    outlines_yx : sequence of ndarray of shape (N, 2) and dtype float
        (row, column) in pixels.

    Returns
    -------
    (float, float, float, float)
        Top, bottom, left and right in pixels.
    """
    points = np.concatenate([np.asarray(outline).reshape(-1, 2) for outline in outlines_yx])
    low, high = np.nanmin(points, axis=0), np.nanmax(points, axis=0)
    margin = _MARGIN * float((high - low).max())
    (top, left), (bottom, right) = (low - margin).tolist(), (high + margin).tolist()
    return top, bottom, left, right


def frame_field(ax: Axes, extent_yx: Extent) -> None:
    """Fit the axes to a field of view and hide them.

    Parameters
    ----------
    ax : Axes
    extent_yx : (float, float, float, float)
        Top, bottom, left and right in pixels.
    """
    top, bottom, left, right = extent_yx
    ax.set_aspect("equal")
    ax.set_xlim(left, right)
    ax.set_ylim(bottom, top)
    ax.set_axis_off()


def time_stamp(frame: int, frame_interval_s: float | None = None) -> str:
    """A frame's time for a title: in seconds, in minutes if frames are a minute or more apart, or its number.

    Parameters
    ----------
    frame : int
        From 0.
    frame_interval_s : float, optional

    Returns
    -------
    str

    Raises
    ------
    ParameterError
        The interval is not a positive number.
    """
    if frame_interval_s is None:
        return f"frame {frame}"
    if not 0 < frame_interval_s < np.inf:
        raise ParameterError(
            f"frame_interval_s must be a positive number, got {frame_interval_s!r}: "
            "pass None when it is not known"
        )
    unit, seconds = ("s", 1.0) if frame_interval_s < 60.0 else ("min", 60.0)
    return f"{round(frame * frame_interval_s / seconds, 2):g} {unit}"


def _on_outline(disk: DiskMap, angles: FloatArray) -> FloatArray:
    """Points of the outline at angles of the disk, shape (N, 2)."""
    return np.column_stack(
        [np.interp(angles, disk.boundary_angles, along, period=2.0 * np.pi) for along in disk.outline_yx.T]
    )


def _images(windows: Sequence[CellWindows], signal: Sequence[Any] | None) -> list[FloatArray | None]:
    if signal is None:
        return [None] * len(windows)
    images = [np.asarray(image) for image in signal]
    for image, frame in zip(images, windows, strict=False):
        if image.shape != frame.mask.shape:
            raise SignalError(
                f"signal has shape {image.shape}, the mask {frame.mask.shape}: pass one channel a frame"
            )
    return list(images)


def _common_limits(
    windows: Sequence[CellWindows], images: Sequence[FloatArray | None]
) -> tuple[float, float]:
    pairs = [(image, frame.mask) for image, frame in zip(images, windows, strict=True) if image is not None]
    inside = np.concatenate([image[mask] for image, mask in pairs]) if pairs else np.empty(0)
    return signal_limits(inside, np.ones(inside.shape, dtype=bool))
