"""What a movie's run writes at its end: frames without a next one, consistency, and the activity store."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from cytodisk.analysis.activity import STATISTICS, geometry_of
from cytodisk.analysis.consistency import correlation_over_sectors, displacement_between
from cytodisk.images.tracks import CellTrack
from cytodisk.motion.edge import STRETCHES
from cytodisk.motion.registration import RigidTransform
from cytodisk.motion.velocity_error import velocity_error
from cytodisk.runs.frame_rows import FramePlace
from cytodisk.runs.movie.measured_frame import edge_columns
from cytodisk.scale import Scale
from cytodisk.store.activity_reading import EDGE_VARIABLES
from cytodisk.store.activity_store import ActivityStore
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_kind import ACTIVITY
from cytodisk.windows.polar_windows import PolarGrid

MOTION_PART = "motion"  # rows of the edge table as far as two frames tell them
STRETCHES_PART = "stretches"  # arrays of how short stretches of the edge moved, one a frame


def finish_tables(
    folder: StudyFolder,
    tracks: Sequence[CellTrack],
    grid: PolarGrid,
    scale: Scale,
    channels: Sequence[str],
) -> None:
    """Complete the parts of all cells and write the activity store, a few frames in memory at a time.

    Parameters
    ----------
    folder : StudyFolder
        All frames measured.
    tracks : sequence of CellTrack
    grid : PolarGrid
    scale : Scale
    channels : sequence of str
        Channels of the signal; empty if there is none.
    """
    rows = {(row["cell"], row["frame"]): row for row in folder.rows()}
    with ActivityStore.replacing(folder.path / ACTIVITY) as store:
        for track in tracks:
            _finish_track(folder, track, grid, scale, channels, rows, store)


def _finish_track(
    folder: StudyFolder,
    track: CellTrack,
    grid: PolarGrid,
    scale: Scale,
    channels: Sequence[str],
    rows: dict[tuple[int, int], dict[str, Any]],
    store: ActivityStore,
) -> None:
    before: dict[str, Any] | None = None
    _complete_edges(folder, track, grid.sectors, scale, rows)
    cell = store.cell(track.cell, track.label, grid, channels, scale)
    for frame in track.frames:
        key, row = part_key(track.cell, frame), rows[track.cell, frame]
        here = _frame_arrays(folder, key, grid, row, channels) if row["status"] == "ok" else None
        if here is not None:
            here |= _edge_arrays(folder, key)
        if before is not None:
            there = None if row.get("restarted") else here
            _add_consistency(folder, track.cell, frame - 1, scale, channels, before, there)
        cell.append(frame, here, row["status"], row["reason"])
        before = here
    if before is not None:
        _add_consistency(folder, track.cell, track.last, scale, channels, before, None)
    cell.close()


def _frame_arrays(
    folder: StudyFolder, key: str, grid: PolarGrid, row: dict[str, Any], channels: Sequence[str]
) -> dict[str, Any]:
    """A frame's windows as arrays: statistics (C, L, S), geometry (L, S), and its rigid motion."""
    part = folder.part_table(key, "windows")
    columns = {name: part.column(name).to_numpy(zero_copy_only=False) for name in geometry_of(grid)}
    shape = (-1, grid.layers, grid.sectors)
    arrays: dict[str, Any] = {name: values.reshape(shape)[0] for name, values in columns.items()}
    if channels:
        arrays |= {name: part.column(name).to_numpy().reshape(shape) for name in STATISTICS}
    arrays["transform"] = RigidTransform(
        np.radians(row["registration_angle"]), row["registration_shift_y"], row["registration_shift_x"]
    )
    return arrays


def _edge_arrays(folder: StudyFolder, key: str) -> dict[str, Any]:
    part = folder.part_table(key, "edge")
    return {name: part.column(name).to_numpy() for name in EDGE_VARIABLES}


def _complete_edges(
    folder: StudyFolder,
    track: CellTrack,
    sectors: int,
    scale: Scale,
    rows: dict[tuple[int, int], dict[str, Any]],
) -> None:
    """Rows of the edge table, with their error; frames without a next one get theirs, with the reason."""
    mapped = [frame for frame in track.frames if rows[track.cell, frame]["status"] == "ok"]
    for frame in mapped:
        key = part_key(track.cell, frame)
        if folder.has_table(key, MOTION_PART):
            continue
        following = rows.get((track.cell, frame + 1))
        status = "last frame" if following is None else f"the next frame has no map: {following['reason']}"
        place = FramePlace(track.cell, frame, track.label, scale.seconds(frame))
        columns = edge_columns(place, sectors, scale, None, None, status)
        folder.add_table(key, "edge", columns, name=MOTION_PART)
    parts = {frame: folder.part_table(part_key(track.cell, frame), MOTION_PART) for frame in mapped}
    displacement = np.full((len(track.frames), sectors), np.nan)
    length = displacement.copy()
    stretches = np.full((len(track.frames), 2, STRETCHES), np.nan)
    for frame, part in parts.items():
        found = folder.part_array(part_key(track.cell, frame), STRETCHES_PART)
        if found is not None:
            stretches[frame - track.first] = found
        displacement[frame - track.first] = part.column("velocity").to_numpy() / scale.velocity(1.0)
        length[frame - track.first] = part.column("edge_length").to_numpy() / scale.length(1.0)
    error = scale.velocity(velocity_error(displacement, length, stretches))
    for frame, part in parts.items():
        columns = {name: part.column(name) for name in part.column_names}
        columns["velocity_error"] = error[frame - track.first]
        folder.add_table(part_key(track.cell, frame), "edge", columns)


def _add_consistency(
    folder: StudyFolder,
    cell: int,
    frame: int,
    scale: Scale,
    names: Sequence[str],
    here: dict[str, Any],
    there: dict[str, Any] | None,
) -> None:
    layers = len(here["area"])
    channels: list[str | None] = [*names] or [None]
    moved = np.full(layers, np.nan)
    correlation = np.full((len(channels), layers), np.nan)
    if there is not None:
        places = np.stack([_registered(here), _registered(there)])
        moved = scale.length(displacement_between(places)[0].mean(axis=-1))
        if "mean" in here:
            correlation = correlation_over_sectors(here["mean"], there["mean"])
    rows = len(channels) * layers
    columns = FramePlace(cell, frame, 0, scale.seconds(frame)).columns(rows) | {
        "channel": [name for name in channels for _ in range(layers)],
        "layer": np.tile(np.arange(layers), len(channels)),
        "correlation": correlation.ravel(),
        "centroid_displacement": np.tile(moved, len(channels)),
        "completeness": np.tile(_completeness(here["area"]), len(channels)),
    }
    folder.add_table(part_key(cell, frame), "consistency", columns)


def _completeness(areas: Any) -> Any:
    """Share of windows with an area, by layer; NaN for a layer that is deeper than the cell: it has none."""
    held = areas > 0
    return np.where(held.any(axis=-1), held.mean(axis=-1), np.nan)


def _registered(arrays: dict[str, Any]) -> Any:
    return arrays["transform"](np.stack([arrays["centroid_y"], arrays["centroid_x"]], axis=-1))
