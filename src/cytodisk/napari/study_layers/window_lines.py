"""Lines between windows, the outline of the cell, and the edge in the colours of its velocity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
import pandas as pd

from cytodisk.arrays import FloatArray
from cytodisk.napari.study_layers.painted_frames import PaintedFrames
from cytodisk.plot.style import DIVERGING_COLOURS
from cytodisk.windows.polar_windows import CellWindows

MOST_LINES = 30_000
"""Straight pieces of a frame; where there are more, only outlines of cells are drawn."""

_STEP_PX = 2.5  # along a ring
_IN_LAYER = 3  # pieces of a ray in each layer
_RIM = 1.0 - 1e-9


def window_lines(painted: PaintedFrames, frame: int) -> tuple[FloatArray, pd.DataFrame]:
    """Outlines of the cells of a frame, and the lines between their windows.

    Parameters
    ----------
    painted : PaintedFrames
    frame : int

    Returns
    -------
    lines : ndarray of shape (N, 2, 2) or (N, 2, 3) and dtype float
        Begin and direction of each piece, (row, column) in pixels; in a stack (frame, row, column).
    features : DataFrame
        Cell of each piece, and what it is part of: outline, or window.
    """
    cells = painted.cells.mapped.get(frame, [])
    shown = [painted.windows.windows_at(cell, frame) for cell in cells]
    outlines = [_closed(windows.disk.outline_yx) for windows in shown]
    inner = [_between_windows(windows) for windows in shown]
    if sum(map(len, outlines)) + sum(map(len, inner)) > MOST_LINES:
        inner = [np.zeros((0, 2, 2))] * len(shown)
    parts = [part for pair in zip(outlines, inner, strict=True) for part in pair]
    counts = [len(part) for part in parts]
    features: dict[str, Any] = {
        "cell": np.repeat(np.repeat(np.asarray(cells, dtype=np.int64), 2), counts),
        "line": np.repeat(np.array(["outline", "window"] * len(cells), dtype=object), counts),
    }
    return in_frame(painted, frame, parts), pd.DataFrame(features)


def edge_lines(painted: PaintedFrames, frame: int, top_speed: float) -> tuple[FloatArray, FloatArray]:
    """The edges of the cells of a frame, and their colours by velocity.

    Parameters
    ----------
    painted : PaintedFrames
        Of a movie.
    frame : int
    top_speed : float
        At the ends of the colours, out and in.

    Returns
    -------
    lines : ndarray of shape (N, 2, 3) and dtype float
        Begin and direction of each piece.
    colours : ndarray of shape (N, 4) and dtype float
        Of pieces without a velocity transparent.
    """
    lines, colours = [], [np.zeros((0, 4))]
    for cell in painted.cells.mapped.get(frame, []):
        windows = painted.windows.windows_at(cell, frame)
        pieces = _closed(windows.disk.outline_yx)
        angles = windows.disk.boundary_angles
        turns = np.mod(np.diff(angles, append=angles[:1]), 2.0 * np.pi)
        middles = angles + 0.5 * turns
        sector = windows.grid.sector_of(np.column_stack([np.cos(middles), np.sin(middles)]))
        velocity = painted.values.at(cell, frame)["velocity"][sector]
        own = mpl.colormaps[DIVERGING_COLOURS](0.5 + 0.5 * velocity / top_speed)
        own[~np.isfinite(velocity), 3] = 0.0
        lines.append(pieces)
        colours.append(own)
    return in_frame(painted, frame, lines), np.concatenate(colours)


def in_frame(painted: PaintedFrames, frame: int, parts: Sequence[FloatArray]) -> FloatArray:
    """Pieces of all cells together, in a stack with the frame as their first coordinate."""
    pieces = np.concatenate([np.zeros((0, 2, 2)), *parts])
    if not painted.cells.is_stack:
        return pieces
    time = np.zeros((len(pieces), 2, 1))
    time[:, 0] = frame
    return np.concatenate([time, pieces], axis=2)


def _closed(loop_yx: FloatArray) -> FloatArray:
    """Begin and direction of the pieces of a closed line."""
    return np.stack([loop_yx, np.roll(loop_yx, -1, axis=0) - loop_yx], axis=1)


def _between_windows(windows: CellWindows) -> FloatArray:
    """Rings and rays of the grid inside the cell."""
    grid, disk = windows.grid, windows.disk
    radii = np.asarray(grid.radii)
    length = np.linalg.norm(_closed(disk.outline_yx)[:, 1], axis=1).sum()
    rings = np.unique(radii[(radii > 0.0) & (radii < 1.0)])
    per_sector = max(1, int(np.ceil(length / (_STEP_PX * grid.sectors))))
    around = np.linspace(0.0, 2.0 * np.pi, grid.sectors * per_sector + 1)
    shares = np.linspace(0.0, 1.0, _IN_LAYER + 1)[:-1]
    along = np.append((radii[:-1, None] + np.diff(radii)[:, None] * shares).ravel(), radii[-1])
    along = np.minimum(np.unique(along), _RIM)
    lines = [_polar(rings[:, None], around[None, :]), _polar(along[None, :], grid.angles[:-1, None])]
    pieces = []
    for line in lines:
        points = disk.to_cell(line.reshape(-1, 2)).reshape(line.shape)
        begins, ends = points[:, :-1].reshape(-1, 2), points[:, 1:].reshape(-1, 2)
        pieces.append(np.stack([begins, ends - begins], axis=1))
    found = np.concatenate(pieces)
    return np.asarray(found[np.isfinite(found).all(axis=(1, 2))])


def _polar(radius: FloatArray, angle: FloatArray) -> FloatArray:
    """Points of the disk, (u, v)."""
    return np.stack(np.broadcast_arrays(radius * np.cos(angle), radius * np.sin(angle)), axis=-1)
