"""Windows of one method through the frames of a movie, measured."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.activity import ActivityTables, Grid, window_arrays
from cytodisk.analysis.consistency import centroid_displacement, consecutive_correlation
from cytodisk.analysis.window_measures import measures_by_layer
from cytodisk.errors import MaskError, ReadError
from cytodisk.geometry.mask import FilledMask
from cytodisk.geometry.mask_parameters import Holes
from cytodisk.images.frame_file import FrameFile
from cytodisk.images.signal_files import load_image
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.runs.compare_windows.compare_parameters import ON_A_MAP, CompareMovieParameters
from cytodisk.runs.compare_windows.compare_tables import layer_columns, windows_row
from cytodisk.runs.compare_windows.laid_frames import lay_frames
from cytodisk.windows.edge_windows import CellEdge, EdgeGrid
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.ring_windows import RingGrid
from cytodisk.windows.springs.spring_parameters import LineTensionParameters
from cytodisk.windows.springs.spring_windows import SpringGrid

_SUMMED = ("invalid_maps", "flipped", "lost_px", "empty_windows")
_MIDDLE = ("area_px", "area_distortion", "angle_distortion", "coverage", "folded", "carried_outside")


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
    PolarGrid, EdgeGrid, SpringGrid or RingGrid
    """
    parameters, movie = followed.parameters, followed.movie
    layers, sectors = parameters.layers, parameters.sectors
    if followed.method == "rings":
        return RingGrid(layers, sectors)
    if followed.method not in ("edge", "springs"):
        return polar_windows(layers, sectors, parameters.spacing)
    depth = parameters.depth_px
    if depth is None:
        depth = CellEdge.of(movie[int(np.argmax(movie.mapped))]).greatest_depth / layers
    if followed.method == "springs":
        return SpringGrid(layers, sectors, depth, parameters.evenness)
    return EdgeGrid(layers, sectors, depth)


def usable(masks: Iterable[Any], holes: Holes = "fill") -> int:
    """How many masks are those of a cell; a map of the others cannot be asked for.

    Parameters
    ----------
    masks : iterable of ndarray of shape (H, W), or CytodiskError
    holes : {"fill", "exclude", "error"}
        With "error", a mask with holes is that of no cell.

    Returns
    -------
    int
    """
    count = 0
    for mask in masks:
        if not isinstance(mask, Exception):
            try:
                FilledMask.of(mask).under(holes)
            except MaskError:
                continue
            count += 1
    return count


def _sample_frames(
    followed: FollowedCell, grid: Grid
) -> tuple[xr.Dataset, list[dict[str, Any]], list[dict[str, Any]]]:
    """The activity, and by mapped frame what windows are like: for the row, and by layer."""
    movie, signal, first = followed.movie, followed.signal, followed.first
    channels = [""] if signal is None else list(signal.channels)
    tables = ActivityTables(len(movie), channels, grid, ("mean",))
    frames, layers = [], []

    def image(frame: int) -> Any:
        known = load_image(signal, first + frame)
        return None if isinstance(known, ReadError) else known

    springs = dict(followed.parameters.part(LineTensionParameters))
    for laid in lay_frames(followed.method, movie, grid, **springs):
        tables.put(laid.frame, window_arrays(laid.windows, image(laid.frame), nan=followed.parameters.nan))
        disk = laid.disk if followed.method in ON_A_MAP else None
        frames.append(windows_row(laid.windows, disk) | laid.shares)
        measures = measures_by_layer(laid.windows)
        layers.append(layer_columns(followed.cell, first + laid.frame, followed.method, measures))
    return tables.dataset(movie, first), frames, layers


def _consistency(
    followed: FollowedCell, activity: xr.Dataset, layers: list[dict[str, Any]]
) -> dict[str, Any]:
    """Rows of the table of consistency: by frame with a map, channel and layer."""
    correlation = consecutive_correlation(activity["mean"]).to_numpy()
    moved = centroid_displacement(followed.movie, activity).mean("sector").to_numpy()
    columns: list[dict[str, Any]] = []
    for found in layers:
        frame, count = int(found["frame"][0]), len(found["layer"])
        for number, channel in enumerate(activity["channel"].to_numpy()):
            columns.append(
                {
                    **{name: found[name] for name in ("cell", "method", "frame", "layer", "completeness")},
                    "time_s": [followed.movie.scale.seconds(frame)] * count,
                    "channel": [str(channel) or None] * count,
                    "correlation": correlation[frame - followed.first, number],
                    "centroid_displacement": moved[frame - followed.first],
                }
            )
    return _stacked(columns)


def _stacked(columns: list[dict[str, Any]]) -> dict[str, Any]:
    names = columns[0] if columns else {}
    return {name: [value for part in columns for value in part[name]] for name in names}


def _known(rows: list[dict[str, Any]], name: str) -> list[Any]:
    return [row[name] for row in rows if row.get(name) is not None]
