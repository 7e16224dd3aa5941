"""Mark holes in the cell that belong to no window."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba

from cytodisk.disk.disk_map import DiskMap
from cytodisk.plot.outline_sides import outline_sides
from cytodisk.plot.style import MISSING_COLOUR


def outline_holes(ax: Axes, disk: DiskMap, *, color: str, linewidth: float) -> None:
    """Draw the borders of excluded holes along the sides of their pixels.

    Parameters
    ----------
    ax : Axes
    disk : DiskMap
    color : str
    linewidth : float
        In points.
    """
    if disk.holes is None:
        return
    row, column = disk.holes.corner
    sides = outline_sides(disk.holes.box) + np.array([column, row]) - 0.5
    ax.add_collection(
        LineCollection(list(sides), colors=color, linewidths=linewidth, zorder=3), autolim=False
    )


def cover_holes(ax: Axes, disk: DiskMap) -> None:
    """Cover excluded holes with the grey of what is not there.

    Parameters
    ----------
    ax : Axes
        Its limits are set afterwards.
    disk : DiskMap
    """
    if disk.holes is None:
        return
    (row, column), box = disk.holes.corner, disk.holes.box
    height, width = box.shape
    colours = np.where(box[..., None], to_rgba(MISSING_COLOUR), (1.0, 1.0, 1.0, 0.0))
    sides = (column - 0.5, column + width - 0.5, row + height - 0.5, row - 0.5)
    ax.imshow(colours, extent=sides, interpolation="nearest", zorder=2)
