"""What a run of `cytodisk movie` does with a mapped frame: sample it, measure its edge, and write its map."""

from __future__ import annotations

import time as clock
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.arrays import FloatArray
from cytodisk.errors import CytodiskError, WindowError
from cytodisk.files import flushed_later
from cytodisk.images.sequences.file_sequence import MissingFrameError
from cytodisk.images.signal_files import SignalPiece
from cytodisk.images.tracks import MissingLabel
from cytodisk.motion.edge import EdgeMotion, displacement_by_sector, edge_motion
from cytodisk.motion.following import frame_status
from cytodisk.motion.frame_file import save_frame
from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.motion.tracking_parameters import InteriorParameters
from cytodisk.runs.cells.cell_nuclei import CellNucleus
from cytodisk.runs.cells.nucleus_rows import nuclei_table, nucleus_columns
from cytodisk.runs.frame_rows import FramePlace, measure_windows
from cytodisk.runs.movie.followed_nucleus import followed_nucleus_columns
from cytodisk.runs.movie.movie_parameters import FollowedCellParameters
from cytodisk.scale import Scale
from cytodisk.store.activity_reading import EDGE_VARIABLES
from cytodisk.windows.polar_windows import CellWindows, PolarGrid


@dataclass(frozen=True, eq=False)
class FrameTask:
    """Everything that a worker needs to measure a mapped frame.

    Attributes
    ----------
    place : FramePlace
    frame : MappedFrame
    before : MappedFrame or None
        The frame before, if that has a map.
    signal : SignalPiece or None
        Of the box of the frame's mask.
    grid : PolarGrid
    parameters : FollowedCellParameters
    map_path : Path
        Where the map is to stand.
    seconds : float
        That mapping took.
    nucleus : CellNucleus or None
        What the file of nuclei says of the cell, if there is one.
    """

    place: FramePlace
    frame: MappedFrame
    before: MappedFrame | None
    signal: SignalPiece | None
    grid: PolarGrid
    parameters: FollowedCellParameters
    map_path: Path
    seconds: float
    nucleus: CellNucleus | None = None


@dataclass(frozen=True)
class FrameRows:
    """Rows of a frame: its own, its windows', and the frame before's edge, by sector and short stretch."""

    row: dict[str, Any]
    tables: dict[str, dict[str, Any]]
    edge_before: dict[str, Any] | None
    stretches_before: FloatArray | None = None

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
    frame = task.frame
    try:
        windows = task.grid.on(frame.disk)
    except WindowError as fault:  # layers by depth, and no edge of the cell in the image
        seconds = task.seconds + clock.perf_counter() - started
        return unmapped_rows(task.place, fault, seconds, task.nucleus)
    row, columns = measure_windows(task.place, windows, task.signal, task.parameters.nan)
    row |= _track_columns(frame) | followed_nucleus_columns(task.nucleus, frame)
    row |= {"smallest_window_share": _smallest_share(windows, task.parameters)}
    row["notes"] = "; ".join(filter(None, [row["notes"], _interior_note(frame, task)]))
    row["mask_remarks"] = "; ".join(filter(None, [row["mask_remarks"], _jump(task)]))
    with flushed_later():
        save_frame(task.map_path, frame)
    motion = _motion_since(task)
    row["swept_area"] = np.nan if motion is None else frame.disk.scale.area(motion.swept_px2)
    edge = None if task.before is None else _edge_before(task, task.before, motion)
    row |= {"status": "ok", "reason": "", "seconds": task.seconds + clock.perf_counter() - started}
    tables = nuclei_table(task.place, task.nucleus) | {"windows": columns}
    return FrameRows(row, tables, edge, None if motion is None else motion.stretches_px)


def _smallest_share(windows: CellWindows, parameters: FollowedCellParameters) -> float:
    """Area of the smallest window over that in a map of equal areas; NaN unless the interior stands still."""
    if parameters.part(InteriorParameters).interior != "still":
        return np.nan
    return float(np.nanmin(windows.area_ratios))


def _interior_note(frame: MappedFrame, task: FrameTask) -> str:
    """Remark on an interior that stands still, but was not reached from the last map."""
    goes_on = (
        task.parameters.part(InteriorParameters).interior == "still" and frame.reference is not frame.boundary
    )
    return "interior relaxed from a harmonic map" if goes_on and frame.disk.start != "previous" else ""


def _jump(task: FrameTask) -> str:
    """Remark on a cell that is nowhere where it was in the frame before."""
    if task.before is None or task.before.disk.placed_mask.touches(task.frame.disk.placed_mask):
        return ""
    return f"the cell does not touch its place in frame {task.before.frame}: it moved far, or is another one"


def unmapped_rows(
    place: FramePlace, fault: CytodiskError, seconds: float, nucleus: CellNucleus | None = None
) -> FrameRows:
    """Row of a frame without a map.

    Parameters
    ----------
    place : FramePlace
    fault : CytodiskError
    seconds : float
        Spent on it.
    nucleus : CellNucleus, optional
        What the file of nuclei says of the cell.

    Returns
    -------
    FrameRows
    """
    status = "missing" if isinstance(fault, MissingLabel | MissingFrameError) else frame_status(fault)
    row = place.row | nucleus_columns(nucleus)
    row |= {"status": status, "reason": str(fault), "seconds": seconds}
    return FrameRows(row, nuclei_table(place, nucleus), None)


def edge_columns(
    place: FramePlace,
    sectors: int,
    scale: Scale,
    motion: EdgeMotion | None,
    in_cell_frame: Any,
    status: str,
) -> dict[str, Any]:
    """Columns of the edge table for one frame.

    Parameters
    ----------
    place : FramePlace
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
    states = np.full(sectors, status, dtype=object)
    columns = place.columns(sectors) | {"sector": np.arange(sectors)}
    if motion is None:
        return columns | dict.fromkeys(EDGE_VARIABLES, nothing) | {"status": states}
    states[np.isnan(motion.displacement_px)] = "on the image's border"
    return columns | {
        "velocity": scale.velocity(motion.displacement_px),
        "velocity_cell_frame": scale.velocity(in_cell_frame),
        "velocity_fastest": scale.velocity(motion.fastest_px),
        "velocity_error": nothing,  # told by the whole movie, at its end
        "protruded_area": scale.area(motion.protruded_px2),
        "retracted_area": scale.area(motion.retracted_px2),
        "edge_length": scale.length(motion.length_px),
        "status": states,
    }


def _motion_since(task: FrameTask) -> EdgeMotion | None:
    """Motion of the edge since the frame before; None where there is none, or tracking started anew."""
    before, here = task.before, task.frame
    if before is None or here.boundary.restarted:
        return None
    return edge_motion(
        before.boundary,
        here.boundary,
        before.disk,
        here.disk,
        task.parameters.sectors,
    )


def _edge_before(task: FrameTask, before: MappedFrame, motion: EdgeMotion | None) -> dict[str, Any]:
    here, there, sectors = before.boundary, task.frame.boundary, task.parameters.sectors
    scale = task.frame.disk.scale
    place = replace(task.place, frame=before.frame, time_s=scale.seconds(before.frame))
    if motion is None:
        return edge_columns(place, sectors, scale, None, None, "tracking starts anew in the next frame")
    in_cell_frame = displacement_by_sector(here, there, before.disk.placed_mask.image_shape, sectors, "cell")
    return edge_columns(place, sectors, scale, motion, in_cell_frame, "ok")


def _track_columns(frame: MappedFrame) -> dict[str, Any]:
    boundary, transform = frame.boundary, frame.boundary.transform
    return {
        "restarted": boundary.restarted,
        "interior_restarted": frame.interior_restarted,
        "tracking_residual": frame.disk.scale.length(boundary.residual_px),
        "order_violations": boundary.order_violations,
        "registration_angle": float(np.degrees(transform.angle)),
        "registration_shift_y": transform.shift_y,
        "registration_shift_x": transform.shift_x,
    }
