"""Lines of the disk as Qt paints them: the grid of windows, and the outline of one."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRectF
from qtpy.QtGui import QPainterPath

from cytodisk.napari.disk_view.disk_pixels import DiskFrame
from cytodisk.windows.polar_windows import PolarGrid

_NARROWEST = 3.0  # pixels between two lines, or they hide what is below them


def grid_path(grid: PolarGrid, frame: DiskFrame) -> QPainterPath:
    """Lines between windows, but for those that would lie closer than three pixels.

    Parameters
    ----------
    grid : PolarGrid
    frame : DiskFrame
    """
    path = QPainterPath()
    middle = QPointF(0.5 * frame.size, 0.5 * frame.size)
    last = frame.radius
    for radius in frame.radius * grid.radii[1:-1]:
        if last - radius >= _NARROWEST:
            path.addEllipse(middle, float(radius), float(radius))
            last = radius
    within = min(1.0, _NARROWEST * grid.sectors / (2.0 * np.pi * frame.radius))
    for angle in grid.angles[:-1] if grid.sectors > 1 else ():
        u, v = np.cos(angle), np.sin(angle)
        path.moveTo(QPointF(*frame.point(within * u, within * v)))
        path.lineTo(QPointF(*frame.point(u, v)))
    return path


def window_path(grid: PolarGrid, frame: DiskFrame, number: int) -> QPainterPath:
    """Outline of a window.

    Parameters
    ----------
    grid : PolarGrid
    frame : DiskFrame
    number : int
    """
    layer, sector = divmod(number, grid.sectors)
    outer, inner = frame.radius * grid.radii[layer : layer + 2]
    first, turn = np.degrees(grid.angles[sector]), 360.0 / grid.sectors
    boxes = [_box(frame, float(radius)) for radius in (outer, inner)]
    path = QPainterPath()
    path.arcMoveTo(boxes[0], -first)  # Qt counts angles against the clock, upwards
    path.arcTo(boxes[0], -first, -turn)
    path.arcTo(boxes[1], -first - turn, turn)
    path.closeSubpath()
    return path


def _box(frame: DiskFrame, radius: float) -> QRectF:
    corner = 0.5 * frame.size - radius
    return QRectF(corner, corner, 2.0 * radius, 2.0 * radius)
