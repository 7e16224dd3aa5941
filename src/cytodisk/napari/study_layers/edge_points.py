"""Points on the cell's edge that stay on the same place of the disk: where sectors begin, and sector 0."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.napari.study_layers.painted_frames import PaintedFrames
from cytodisk.windows.polar_windows import CellWindows

SECTOR_0, TRACKED = "sector 0", "sector's begin"


def edge_points(painted: PaintedFrames, frame: int) -> tuple[FloatArray, pd.DataFrame]:
    """Points on the edges of all cells of a frame.

    Parameters
    ----------
    painted : PaintedFrames
    frame : int

    Returns
    -------
    points : ndarray of shape (N, 2) or (N, 3) and dtype float
        (row, column) in pixels; in a stack (frame, row, column).
    features : DataFrame
        Cell, sector, and what the point is: where the sector begins on the edge, or the middle of sector 0.
    """
    shown = painted.cells.mapped.get(frame, [])
    parts = [_of_cell(painted.windows.windows_at(cell, frame)) for cell in shown]
    sectors = painted.windows.grid.sectors
    stack = [np.full((0, 2), 0.0), *parts]
    points = np.concatenate(stack)
    if painted.cells.is_stack:
        points = np.column_stack([np.full(len(points), float(frame)), points])
    count, each = len(shown), sectors + 1
    features: dict[str, Any] = {
        "cell": np.repeat(np.asarray(shown, dtype=np.int64), each),
        "sector": np.tile(np.append(np.arange(sectors), 0), count),
        "point": np.tile(np.array([TRACKED] * sectors + [SECTOR_0], dtype=object), count),
    }
    return points, pd.DataFrame(features)


def _of_cell(windows: CellWindows) -> FloatArray:
    """Where each sector begins on the edge, then the middle of sector 0, shape (sectors + 1, 2)."""
    angles = windows.grid.angles
    wanted = np.append(angles[:-1], angles[:2].mean())
    around, loop = windows.disk.boundary_angles, windows.disk.outline_yx
    return np.column_stack([np.interp(wanted, around, along, period=2.0 * np.pi) for along in loop.T])
