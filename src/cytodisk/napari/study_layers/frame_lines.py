"""Lines between windows, the edge in the colours of its velocity, and points that stay on it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.napari.study_layers.byte_cache import ByteCache
from cytodisk.napari.study_layers.painted_frames import PaintedFrames
from cytodisk.plot.style import DIVERGING_COLOURS
from cytodisk.windows.polar_windows import CellWindows

MOST_LINES = 30_000
"""Straight pieces of a frame; where there are more, only outlines of cells are drawn."""

LINE_BYTES = 64 * 2**20
"""Of lines and points of frames."""
SECTOR_0, TRACKED = "sector 0", "begin of sector"

_STEP_PX = 2.5  # along a ring
_IN_LAYER = 3  # pieces of a ray in each layer
_RIM = 1.0 - 1e-9


class FrameLines:
    """Lines and points of the frames of a source, kept within a bound.

    Parameters
    ----------
    painted : PaintedFrames

    Attributes
    ----------
    crowded : set of int
        Frames of which only outlines of cells were drawn.
    """

    def __init__(self, painted: PaintedFrames):
        self._painted = painted
        self.crowded: set[int] = set()
        self._kept: ByteCache[tuple[Any, ...]] = ByteCache(LINE_BYTES, _size_of)

    @property
    def is_full(self) -> bool:
        """Whether more frames would push others out."""
        return self._kept.is_full

    def windows(self, frame: int) -> Any:
        """Outlines of the cells of a frame, and the lines between their windows.

        Parameters
        ----------
        frame : int

        Returns
        -------
        ndarray of shape (N, 2, 2) or (N, 2, 3) and dtype float32
            Begin and direction of each piece, (row, column) in pixels; in a stack (frame, row, column).
        """
        return self._kept.get((frame, "windows"), lambda: (self._windows(frame),))[0]

    def _windows(self, frame: int) -> Any:
        shown = self._shown(frame)
        outlines = [_closed(windows.disk.outline_yx) for _, windows in shown]
        inner = [_between_windows(windows) for _, windows in shown]
        if sum(map(len, [*outlines, *inner])) > MOST_LINES:
            inner = []
            self.crowded.add(frame)
        return self._in_frame(frame, [*outlines, *inner])

    def nuclei(self, frame: int) -> Any:
        """Outlines of the nuclei of a frame, as `windows`."""
        return self._kept.get((frame, "nuclei"), lambda: (self._nuclei(frame),))[0]

    def _nuclei(self, frame: int) -> Any:
        outlines = [windows.disk.nucleus_outline_yx for _, windows in self._shown(frame)]
        return self._in_frame(frame, [_closed(outline) for outline in outlines if outline is not None])

    def edge(self, frame: int, top_speed: float) -> tuple[Any, Any]:
        """The edges of the cells of a frame, and their colours by velocity.

        Parameters
        ----------
        frame : int
        top_speed : float
            At the ends of the colours, out and in.

        Returns
        -------
        lines : ndarray of shape (N, 2, 3) and dtype float32
            Begin and direction of each piece.
        colours : ndarray of shape (N, 4) and dtype float32
            Of pieces without a velocity transparent.
        """
        lines, colours = self._kept.get((frame, "edge", top_speed), lambda: self._edge(frame, top_speed))
        return lines, colours

    def _edge(self, frame: int, top_speed: float) -> tuple[Any, Any]:
        lines, colours = [], [np.zeros((0, 4))]
        for cell, windows in self._shown(frame):
            angles = windows.disk.boundary_angles
            middles = angles + 0.5 * np.mod(np.diff(angles, append=angles[:1]), 2.0 * np.pi)
            sector = windows.grid.sector_of(np.column_stack([np.cos(middles), np.sin(middles)]))
            velocity = self._painted.values.at(cell, frame)["velocity"][sector]
            own = mpl.colormaps[DIVERGING_COLOURS](0.5 + 0.5 * velocity / top_speed)
            own[~np.isfinite(velocity), 3] = 0.0
            lines.append(_closed(windows.disk.outline_yx))
            colours.append(own)
        return self._in_frame(frame, lines), np.concatenate(colours).astype(np.float32)

    def sector_0(self, frame: int) -> Any:
        """Middle of sector 0 on the edge of each cell, as the places of `points`."""
        points, features = self.points(frame)
        return points[features["point"] == SECTOR_0]

    def points(self, frame: int) -> tuple[Any, dict[str, Any]]:
        """Points on the edges of the cells of a frame that stay on the same place of the disk.

        Parameters
        ----------
        frame : int

        Returns
        -------
        points : ndarray of shape (N, 2) or (N, 3) and dtype float32
            (row, column) in pixels; in a stack (frame, row, column).
        features : dict of str to ndarray
            Cell, sector, and whether the sector begins there on the edge, or it is the middle of sector 0.
        """
        return self._kept.get((frame, "points"), lambda: self._points(frame))

    def _points(self, frame: int) -> tuple[Any, dict[str, Any]]:
        shown, sectors = self._shown(frame), self._painted.windows.grid.sectors
        points = np.concatenate([np.zeros((0, 2)), *(_edge_points(windows) for _, windows in shown)])
        if self._painted.cells.is_stack:
            points = np.column_stack([np.full(len(points), float(frame)), points])
        count = len(shown)
        features = {
            "cell": np.repeat(np.asarray([cell for cell, _ in shown], dtype=np.int64), sectors + 1),
            "sector": np.tile(np.append(np.arange(sectors), 0), count),
            "point": np.tile(np.array([TRACKED] * sectors + [SECTOR_0], dtype=object), count),
        }
        return points.astype(np.float32), features

    def _shown(self, frame: int) -> list[tuple[int, CellWindows]]:
        cells = self._painted.shown(frame)
        return [(cell, self._painted.windows.windows_at(cell, frame)) for cell in cells]

    def _in_frame(self, frame: int, parts: Sequence[FloatArray]) -> Any:
        """Pieces of all cells together, in a stack with the frame as their first coordinate."""
        pieces = np.concatenate([np.zeros((0, 2, 2)), *parts])
        if self._painted.cells.is_stack:
            time = np.zeros((len(pieces), 2, 1))
            time[:, 0] = frame
            pieces = np.concatenate([time, pieces], axis=2)
        return pieces.astype(np.float32)


def cell_lines(windows: CellWindows) -> Any:
    """Outline of a cell and the lines between its windows, shape (N, 2, 2): begin and direction."""
    return np.concatenate([_closed(windows.disk.outline_yx), _between_windows(windows)]).astype(np.float32)


def _edge_points(windows: CellWindows) -> FloatArray:
    """Where each sector begins on the edge, then the middle of sector 0, shape (sectors + 1, 2)."""
    angles = windows.grid.angles
    wanted = np.append(angles[:-1], angles[:2].mean())
    around, loop = windows.disk.boundary_angles, windows.disk.outline_yx
    return np.column_stack([np.interp(wanted, around, along, period=2.0 * np.pi) for along in loop.T])


def _size_of(arrays: tuple[Any, ...]) -> int:
    return sum(array.nbytes for array in arrays if isinstance(array, np.ndarray))


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
