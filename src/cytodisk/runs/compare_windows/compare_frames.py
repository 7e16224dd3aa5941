"""Windows of one method through the frames of a movie, measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.activity import Grid, activity_dataset
from cytodisk.analysis.consistency import centroid_displacement, consecutive_correlation
from cytodisk.analysis.window_measures import measures_by_layer
from cytodisk.errors import MaskError, ReadError
from cytodisk.geometry.mask import clean_mask
from cytodisk.images.frames import FrameFile
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.runs.compare_windows.compare_parameters import ON_A_MAP, CompareMovieParameters
from cytodisk.runs.compare_windows.compare_tables import layer_columns, windows_row
from cytodisk.windows.edge_windows import CellEdge, EdgeGrid
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.ring_windows import RingGrid
from cytodisk.windows.sample import sample

_SUMMED = ("invalid_maps", "flipped", "lost_px", "empty_windows")
_MIDDLE = ("area_px", "area_distortion", "angle_distortion", "coverage")


@dataclass(frozen=True, eq=False)
class FollowedCell:
    """One cell of a movie with its maps, and the method whose windows are to be measured.

    Attributes
    ----------
    cell : int
    first : int
        Number of the first frame.
    method : str
    movie : DiskMovie
    signal : FrameFile or None
        Signal of the whole file that the masks are from.
    parameters : CompareMovieParameters
    """

    cell: int
    first: int
    method: str
    movie: DiskMovie
    signal: FrameFile | None
    parameters: CompareMovieParameters


@dataclass(frozen=True, eq=False)
class MeasuredCell:
    """What was measured: the cell's row, rows of the tables, and the activity."""

    row: dict[str, Any]
    tables: dict[str, dict[str, Any]]
    activity: xr.Dataset


def measure_frames(followed: FollowedCell) -> MeasuredCell:
    """Lay windows on every frame, sample the signal, and measure both.

    Parameters
    ----------
    followed : FollowedCell

    Returns
    -------
    MeasuredCell
        In the row, counts are summed over frames, other measures are medians.
    """
    grid = window_grid(followed)
    activity, frames, layers = _sample_frames(followed, grid)
    row: dict[str, Any] = {
        "mapped": len(frames),
        "depth_px": grid.depth_px if isinstance(grid, EdgeGrid) else None,
    }
    if followed.method in ON_A_MAP:
        row["certificate_valid"] = all(frame["certificate_valid"] for frame in frames)
    row |= {name: float(np.median(found)) for name in _MIDDLE if (found := _known(frames, name))}
    row |= {name: sum(found) for name in _SUMMED if (found := _known(frames, name))}
    tables = {"layers": _stacked(layers), "consistency": _consistency(followed, activity, layers)}
    return MeasuredCell(row, tables, activity)


def window_grid(followed: FollowedCell) -> Grid:
    """The grid of a method; edge-based layers are by default as deep as the first map's cell allows.

    Parameters
    ----------
    followed : FollowedCell

    Returns
    -------
    PolarGrid, EdgeGrid or RingGrid
    """
    parameters, movie = followed.parameters, followed.movie
    layers, sectors = parameters.layers, parameters.sectors
    if followed.method == "rings":
        return RingGrid(layers, sectors)
    if followed.method != "edge":
        return polar_windows(layers, sectors, parameters.spacing)
    depth = parameters.depth_px
    if depth is None:
        depth = CellEdge.of(movie[int(np.argmax(movie.mapped))]).greatest_depth / layers
    return EdgeGrid(layers, sectors, depth)


def usable(masks: Sequence[Any]) -> int:
    """How many masks are those of a cell; a map of the others cannot be asked for.

    Parameters
    ----------
    masks : sequence of ndarray of shape (H, W), or CytodiskError

    Returns
    -------
    int
    """
    count = 0
    for mask in masks:
        if not isinstance(mask, Exception):
            try:
                clean_mask(mask)
            except MaskError:
                continue
            count += 1
    return count


def _sample_frames(
    followed: FollowedCell, grid: Grid
) -> tuple[xr.Dataset, list[dict[str, Any]], list[dict[str, Any]]]:
    """The activity, and by mapped frame what windows are like: for the row, and by layer."""
    movie, signal = followed.movie, followed.signal
    channels = [""] if signal is None else list(signal.channels)
    shape = (len(movie), grid.layers, grid.sectors)
    area, y, x = (np.full(shape, np.nan) for _ in range(3))
    mean = np.full((shape[0], len(channels), *shape[1:]), np.nan)
    frames, layers = [], []
    for time in np.flatnonzero(movie.mapped).tolist():
        disk = movie[time]
        windows = grid.on(disk)
        area[time] = windows.areas
        y[time], x[time] = np.moveaxis(windows.centroids_yx, -1, 0)
        image = _image(signal, followed.first + time)
        if image is not None:
            mean[time] = sample(windows, image, nan=followed.parameters.nan)["mean"].to_numpy()
        frames.append(windows_row(windows, disk if followed.method in ON_A_MAP else None))
        measures = measures_by_layer(windows)
        layers.append(layer_columns(followed.cell, followed.first + time, followed.method, measures))
    activity = activity_dataset(
        {"mean": mean, "area": area, "centroid_y": y, "centroid_x": x},
        channels,
        movie.status,
        [record.reason for record in movie.records],
        movie.scale,
        first_frame=followed.first,
    )
    return activity, frames, layers


def _image(signal: FrameFile | None, time: int) -> Any:
    """A frame of the signal, (channel, y, x); None where there is none or it is damaged."""
    if signal is None:
        return None
    try:
        return signal.frame(time)
    except ReadError:
        return None


def _consistency(
    followed: FollowedCell, activity: xr.Dataset, layers: list[dict[str, Any]]
) -> dict[str, Any]:
    """Rows of the table of consistency: by frame with a map, channel and layer."""
    correlation = consecutive_correlation(activity["mean"]).to_numpy()
    moved = centroid_displacement(followed.movie, activity).mean("sector").to_numpy()
    interval = followed.movie.scale.frame_interval_s
    columns: list[dict[str, Any]] = []
    for found in layers:
        time, count = int(found["frame"][0]), len(found["layer"])
        for number, channel in enumerate(activity["channel"].to_numpy()):
            columns.append(
                {
                    **{name: found[name] for name in ("cell", "method", "frame", "layer", "completeness")},
                    "time_s": [None if interval is None else time * interval] * count,
                    "channel": [str(channel) or None] * count,
                    "correlation": correlation[time - followed.first, number],
                    "centroid_displacement": moved[time - followed.first],
                }
            )
    return _stacked(columns)


def _stacked(columns: list[dict[str, Any]]) -> dict[str, Any]:
    names = columns[0] if columns else {}
    return {name: [value for part in columns for value in part[name]] for name in names}


def _known(rows: list[dict[str, Any]], name: str) -> list[Any]:
    return [row[name] for row in rows if row.get(name) is not None]
