"""Numbers of sectors around a cell."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from cytodisk.arrays import FloatArray
from cytodisk.plot.cell.sector_marks import sector_arcs
from cytodisk.plot.field_of_view import frame_field
from cytodisk.plot.style import NUMBER_SIZE, scale_bar
from cytodisk.plot.units import scale_for
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import CellWindows

"""Height in points."""

_AWAY = 7.0  # points from the edge
_HALF = np.array([0.7, 0.6]) * NUMBER_SIZE  # of a number of two digits, down and across
_ROUNDS = 3


def number_sectors(
    ax: Axes, windows: CellWindows, name: str, *, first: int = 0, scale: Scale | None = None
) -> None:
    """Numbers of the four sectors that have theirs on the disk, outside the cell at their beginning.

    The field of view grows so far that it holds them, and its scale bar moves along.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    name : str
        The gid of the numbers.
    first : int
        Sector of the windows that is called 0, as in cells that were turned.
    scale : Scale, optional
        By default that of the windows.
    """
    arcs, places = sector_arcs(windows), []
    for quarter in range(4):
        called = len(arcs) * quarter // 4
        number = (called + first) % len(arcs)
        y, x = arcs[number][0]
        down, right = arcs[number][-1] - arcs[number - 1][0]
        # Sectors follow one another clockwise on the page: where they go down, outwards is to the right.
        away = _AWAY * np.array([down, right]) / max(np.hypot(down, right), 1e-9)
        places.append([y, x, -away[1], away[0]])
        ax.annotate(
            str(called),
            (x, y),
            xytext=tuple(away.tolist()),
            textcoords="offset points",
            ha="center",
            va="center_baseline",
            fontsize=NUMBER_SIZE,
            annotation_clip=False,
            gid=name,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "shrinkA": 3.0, "shrinkB": 0.0},
        )
    _make_room(ax, np.array(places))
    scale_bar(ax, scale_for(windows, scale))


def _make_room(ax: Axes, places: FloatArray) -> None:
    """Let the field hold numbers, whose places are (y, x) in pixels and how far from there in points."""
    box, to_points = ax.get_window_extent(), 72.0 / ax.figure.dpi
    size = to_points * np.array([box.height, box.width])
    low, high = np.sort([ax.get_ylim(), ax.get_xlim()], axis=1).T
    first, last = low, high
    for _ in range(_ROUNDS):  # as the field grows, so do points in pixels
        per_point = float(((last - first) / size).max())
        middle = places[:, :2] + per_point * places[:, 2:]
        first = np.minimum(low, middle.min(axis=0) - per_point * _HALF)
        last = np.maximum(high, middle.max(axis=0) + per_point * _HALF)
    frame_field(ax, (float(first[0]), float(last[0]), float(first[1]), float(last[1])))
