"""Sectors that the eye can follow from frame to frame: cyclic colours, and a ring that marks sector 0."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.lines import Line2D

from cytodisk.arrays import FloatArray
from cytodisk.plot.cell.cell_axes import draw_loop, draw_outline
from cytodisk.plot.cell.grid_look import line_opacity, line_width
from cytodisk.plot.cell.window_polygons import window_polygons
from cytodisk.windows.polar_windows import CellWindows, PolarGrid

SECTOR_COLOURS = LinearSegmentedColormap.from_list(
    "sectors", ["#1F3F99", "#1C9AA8", "#E3B92F", "#D1492E", "#7A2A6E", "#1F3F99"]
)
"""Cyclic. Neither white nor black, so that every sector shows on both; without red against green."""

SECTOR_NOTE = "○ sector 0"
EDGE_WIDTH = 2.2  # points
NUCLEUS_WIDTH = 1.1

_NOTE_BELOW = 5.0  # points, at the height of the scale bar


def draw_sectors(ax: Axes, windows: CellWindows, *, over_signal: bool = False) -> PolyCollection:
    """Draw windows whose sectors can be told apart, and mark sector 0 with a ring on the cell's edge.

    With a nucleus its outline, or its first layer, has the colours of the sectors too.

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
    drawn = PolyCollection(window_polygons(windows), **sector_style(windows.grid, over_signal=over_signal))
    ax.add_collection(drawn, autolim=False)
    draw_edge(ax, windows, over_signal=over_signal)
    return drawn


def sector_style(grid: PolarGrid, *, over_signal: bool) -> dict[str, Any]:
    """How polygons of all windows are filled and bordered, for a PolyCollection.

    Parameters
    ----------
    grid : PolarGrid
    over_signal : bool
        Fill none, rather than those of the outermost layer, and of the first in the nucleus.

    Returns
    -------
    dict
    """
    faces = np.zeros((grid.n_windows, 4))
    if not over_signal:
        faces[: grid.sectors] = sector_colours(grid.sectors)
        if grid.nucleus_layers:
            first = grid.cytoplasm_layers * grid.sectors
            faces[first : first + grid.sectors] = sector_colours(grid.sectors)
    lines = (1.0, 1.0, 1.0, line_opacity(grid.n_windows)) if over_signal else "0.6"
    return {"facecolors": faces, "edgecolors": lines, "linewidths": line_width(grid.n_windows)}


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
        draw_loop(ax, windows.disk.outline_yx, "white", EDGE_WIDTH + 1.0)
        _draw_arcs(ax, sector_arcs(windows), EDGE_WIDTH)
        if windows.disk.nucleus_outline_yx is not None:
            draw_loop(ax, windows.disk.nucleus_outline_yx, "white", NUCLEUS_WIDTH + 0.8)
            _draw_arcs(ax, nucleus_arcs(windows), NUCLEUS_WIDTH)
    else:
        draw_outline(ax, windows.disk)
    middle = windows.grid.angles[:2].mean(keepdims=True)
    ((y, x),) = _along_loop(middle, windows.disk.boundary_angles, windows.disk.outline_yx)
    mark_point(ax, y, x)


def _draw_arcs(ax: Axes, arcs_yx: list[FloatArray], width: float) -> None:
    """Draw one arc a sector in the sectors' colours."""
    colours, arcs = sector_colours(len(arcs_yx)), [arc[:, ::-1] for arc in arcs_yx]
    ax.add_collection(LineCollection(arcs, colors=colours, linewidths=width, zorder=4), autolim=False)


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
    return _loop_arcs(windows.grid, windows.disk.boundary_angles, windows.disk.outline_yx)


def nucleus_arcs(windows: CellWindows) -> list[FloatArray]:
    """The part of the nuclear outline that belongs to each sector; none without a nucleus.

    Parameters
    ----------
    windows : CellWindows

    Returns
    -------
    list of ndarray of shape (N, 2) and dtype float
        (row, column) in pixels.
    """
    nucleus, outline = windows.disk.nucleus, windows.disk.nucleus_outline_yx
    if nucleus is None or outline is None:
        return []
    return _loop_arcs(windows.grid, nucleus.boundary_angles, outline)


def _loop_arcs(grid: PolarGrid, loop_angles: FloatArray, loop_yx: FloatArray) -> list[FloatArray]:
    """Arc of each sector on a loop whose points have angles in the disk, both ends included."""
    within = np.unique(np.concatenate([np.mod(loop_angles, 2.0 * np.pi), grid.angles]))
    points, ends = _along_loop(within, loop_angles, loop_yx), np.searchsorted(within, grid.angles)
    return [points[ends[k] : ends[k + 1] + 1] for k in range(grid.sectors)]


def _along_loop(angles: FloatArray, loop_angles: FloatArray, loop_yx: FloatArray) -> FloatArray:
    """Points of a loop at angles of the disk, shape (N, 2)."""
    return np.column_stack([np.interp(angles, loop_angles, along, period=2.0 * np.pi) for along in loop_yx.T])
