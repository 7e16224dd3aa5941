"""Numbers of sectors around a cell."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from cytodisk.plot.cell.sector_marks import sector_arcs
from cytodisk.windows.polar_windows import CellWindows

NUMBER_SIZE = 6.0
"""Height in points."""

_AWAY = 7.0  # points from the edge


def number_sectors(ax: Axes, windows: CellWindows, name: str, *, first: int = 0) -> None:
    """Numbers of the four sectors that have theirs on the disk, outside the cell at their beginning.

    Parameters
    ----------
    ax : Axes
    windows : CellWindows
    name : str
        The gid of the numbers.
    first : int
        Sector of the windows that is called 0, as in cells that were turned.
    """
    arcs = sector_arcs(windows)
    for quarter in range(4):
        called = len(arcs) * quarter // 4
        number = (called + first) % len(arcs)
        y, x = arcs[number][0]
        down, right = arcs[number][-1] - arcs[number - 1][0]
        # Sectors follow one another clockwise on the page: where they go down, outwards is to the right.
        away = _AWAY * np.array([down, right]) / max(np.hypot(down, right), 1e-9)
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
