"""One frame of a movie's run: measure what was mapped, and put it into rows."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.errors import CytodiskError
from cytodisk.images.tracks import MissingLabel
from cytodisk.motion.edge import EdgeMotion, edge_motion, mean_by_sector, normal_displacement
from cytodisk.motion.frame_file import save_frame
from cytodisk.motion.map_movie import status_of
from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.runs.cell_rows import cell_columns, window_columns
from cytodisk.runs.movie.movie_parameters import FollowedCellParameters
from cytodisk.scale import Scale
from cytodisk.windows.polar_windows import PolarGrid


@dataclass(frozen=True, eq=False)
class FrameTask:
    """Everything that a worker needs to measure a mapped frame."""

    cell: int
    label: int
    frame: MappedFrame
    before: MappedFrame | None
    signal: xr.DataArray | None
    grid: PolarGrid
    parameters: FollowedCellParameters
    scale: Scale
    map_path: Path
    seconds: float


@dataclass(frozen=True)
class FrameRows:
    """Rows of a frame: its own, its windows', and those of the edge of the frame before."""

    row: dict[str, Any]
    tables: dict[str, dict[str, Any]]
    edge_before: dict[str, Any] | None

    @property
    def cell(self) -> int:
        """Number of the cell."""
        return int(self.row["cell"])

    @property
    def frame(self) -> int:
        """Number of the frame."""
        return int(self.row["frame"])


def measure_frame(task: FrameTask) -> FrameRows:
    """Sample a mapped frame, measure how the edge moved since the one before, and save the map.

    Parameters
    ----------
    task : FrameTask

    Returns
    -------
    FrameRows

    Raises
    ------
    StudyError
        The map cannot be written.
    """
    started = clock.perf_counter()
    frame, scale = task.frame, task.scale
    place = task.cell, frame.time, scale.seconds(frame.time)
    windows = task.grid.on(frame.disk)
    columns = window_columns(place, windows, task.signal, task.parameters.nan, scale.pixel_size_um)
    row = frame_row(place, task.label) | cell_columns(frame.disk, windows, task.signal, scale.pixel_size_um)
    row |= _track_columns(frame, scale)
    row["qc_flags"] = "; ".join(filter(None, [row["qc_flags"], _jump(task)]))
    save_frame(task.map_path, frame)
    edge = None if task.before is None else _edge_before(task, task.before)
    row |= {"status": "ok", "reason": "", "seconds": task.seconds + clock.perf_counter() - started}
    return FrameRows(row, {"windows": columns}, edge)


def _jump(task: FrameTask) -> str:
    """Remark on a cell that is nowhere where it was in the frame before."""
    if task.before is None or (task.before.disk.mask & task.frame.disk.mask).any():
        return ""
    return f"the cell does not touch its place in frame {task.before.time}: it moved far, or is another one"


def frame_row(place: tuple[int, int, float | None], label: int) -> dict[str, Any]:
    """Start of a frame's row: cell, frame, its time in seconds, label."""
    cell, time, time_s = place
    return {"cell": cell, "frame": time, "time_s": time_s, "label": label}


def unmapped_row(
    place: tuple[int, int, float | None], label: int, fault: CytodiskError, seconds: float
) -> dict[str, Any]:
    """Row of a frame without a map.

    Parameters
    ----------
    place : (int, int, float or None)
        Cell, frame, and its time in seconds.
    label : int
    fault : CytodiskError
    seconds : float

    Returns
    -------
    dict
    """
    status = "missing" if isinstance(fault, MissingLabel) else status_of(fault)
    return frame_row(place, label) | {"status": status, "reason": str(fault), "seconds": seconds}


def edge_columns(
    place: tuple[int, int, float | None],
    sectors: int,
    scale: Scale,
    motion: EdgeMotion | None,
    in_cell_frame: Any,
    status: str,
) -> dict[str, Any]:
    """Columns of the edge table for one frame.

    Parameters
    ----------
    place : (int, int, float or None)
        Cell, frame, and its time in seconds.
    sectors : int
    scale : Scale
    motion : EdgeMotion or None
        To the next frame, in the lab's frame; None if there is none.
    in_cell_frame : ndarray of shape (S,), or None
        Displacement after registration, in pixels.
    status : str
        Of sectors with a velocity "ok", otherwise why there is none.

    Returns
    -------
    dict of str to array
    """
    nothing = np.full(sectors, np.nan)
    cell, time, time_s = place
    states = np.full(sectors, status, dtype=object)
    columns: dict[str, Any] = {
        "cell": np.full(sectors, cell),
        "frame": np.full(sectors, time),
        "time_s": [time_s] * sectors,
        "sector": np.arange(sectors),
    }
    if motion is None:
        names = ("velocity", "velocity_cell_frame", "velocity_error", "protruded_area", "retracted_area")
        return columns | dict.fromkeys((*names, "edge_length"), nothing) | {"status": states}
    states[np.isnan(motion.displacement_px)] = "on the image's border"
    return columns | {
        "velocity": scale.velocity(motion.displacement_px),
        "velocity_cell_frame": scale.velocity(in_cell_frame),
        "velocity_error": scale.velocity(motion.error_px),
        "protruded_area": scale.area(motion.protruded_px2),
        "retracted_area": scale.area(motion.retracted_px2),
        "edge_length": scale.length(motion.length_px),
        "status": states,
    }


def _edge_before(task: FrameTask, before: MappedFrame) -> dict[str, Any]:
    here, there, sectors = before.boundary, task.frame.boundary, task.parameters.sectors
    place = task.cell, before.time, task.scale.seconds(before.time)
    if there.restarted:
        return edge_columns(place, sectors, task.scale, None, None, "tracking starts anew in the next frame")
    motion = edge_motion(
        here,
        there,
        before.disk,
        task.frame.disk,
        sectors,
        jitter=task.parameters,
    )
    shape = before.disk.mask.shape
    in_cell_frame = mean_by_sector(
        normal_displacement(here, there, "cell"), here, there, (shape[0], shape[1]), sectors
    )
    return edge_columns(place, sectors, task.scale, motion, in_cell_frame, "ok")


def _track_columns(frame: MappedFrame, scale: Scale) -> dict[str, Any]:
    boundary, transform = frame.boundary, frame.boundary.transform
    return {
        "restarted": boundary.restarted,
        "tracking_residual": scale.length(boundary.residual_px),
        "order_violations": boundary.order_violations,
        "registration_angle": float(np.degrees(transform.angle)),
        "registration_shift_y": transform.shift_y,
        "registration_shift_x": transform.shift_x,
    }
