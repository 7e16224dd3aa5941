"""Compare windows on cells that are followed through time: `cytodisk compare --movie`."""

from __future__ import annotations

import os
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.activity import Grid, activity_dataset
from cytodisk.analysis.consistency import centroid_displacement, consecutive_correlation
from cytodisk.analysis.window_measures import measures_by_layer
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError, ReadError
from cytodisk.files import replacing
from cytodisk.io.frames import FrameFile
from cytodisk.io.study_folder import PARAMETERS, StudyFolder, alone_in, part_key
from cytodisk.io.tracks import CellTrack, read_frame
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.map_movie import map_movie
from cytodisk.study.compare_parameters import ON_A_MAP, CompareMovieParameters
from cytodisk.study.compare_tables import COMPARED_MOVIE, layer_columns, windows_row
from cytodisk.study.comparison import Comparison, open_comparison, write_summaries
from cytodisk.study.movie_inputs import MovieInputs, open_movie
from cytodisk.study.parameters import write_parameters
from cytodisk.study.provenance import describe_run
from cytodisk.study.run_steps import check_options, finish_run
from cytodisk.windows.edge_windows import CellEdge, EdgeGrid
from cytodisk.windows.grid import polar_windows
from cytodisk.windows.ring_windows import RingGrid
from cytodisk.windows.sample import sample

_SUMMED = ("invalid_maps", "flipped", "lost_px", "empty_windows")
_MIDDLE = ("area_px", "area_distortion", "angle_distortion", "coverage")


@dataclass(frozen=True)
class _Part:
    """One cell followed by one method."""

    track: CellTrack
    method: str
    key: str


def compare_movie(
    masks: str | os.PathLike[str],
    out: str | os.PathLike[str],
    parameters: CompareMovieParameters | None = None,
    *,
    signal: str | os.PathLike[str] | None = None,
    resume: bool = False,
    overwrite: bool = False,
    progress: Callable[[int, int], None] | None = None,
) -> Comparison:
    """Follow each cell with the windows of several methods and measure how consistent they are.

    The edge is tracked in the same way for all: edge-based windows have the sectors of the polar ones.

    Parameters
    ----------
    masks : path-like
        Masks of one cell by frame, or label images by frame.
    out : path-like
        Folder for the results.
    parameters : CompareMovieParameters, optional
    signal : path-like, optional
        As many images, of the same shape; without it there is no correlation of consecutive frames.
    resume, overwrite : bool
        Go on with the same run in this folder; replace the study that is there.
    progress : callable, optional
        Called with (frames done, frames in all), over all methods.

    Returns
    -------
    Comparison
        Complete; its `consistency` has the measures of the paper's Fig. 4.

    Raises
    ------
    ReadError, MaskError, SignalError, ParameterError
        A file is missing, damaged, or does not fit.
    StudyError
        The folder cannot be used.

    References
    ----------
    u-Unwrap, section 4.2 and Fig. 4.
    """
    check_options(1, resume, overwrite)
    parameters = CompareMovieParameters() if parameters is None else parameters
    inputs = open_movie(masks, signal, parameters)
    scale = inputs.scale.pixel_size_um, inputs.scale.frame_interval_s
    paths = {"masks": inputs.masks.path} | ({"signal": inputs.signal.path} if inputs.signal else {})
    provenance = describe_run(paths, parameters, inputs.understood, *scale) | {"run": "movie comparison"}
    with alone_in(out):
        if resume and StudyFolder.is_complete(out, provenance):
            return open_comparison(out)
        folder = StudyFolder.start(out, provenance, COMPARED_MOVIE, resume=resume, overwrite=overwrite)
        write_parameters(parameters, folder.path / PARAMETERS)
        parts = _parts(inputs, parameters.methods)
        total, done = sum(len(part.track.times) for part in parts), 0
        for part in parts:
            at = done

            def report(frames: int, _: int, at: int = at) -> None:
                if progress is not None:
                    progress(at + frames, total)

            if not folder.has(part.key):
                row, tables = _compare(part, inputs, parameters, folder.path, report)
                folder.add(part.key, row, tables)
            done += len(part.track.times)
            report(len(part.track.times), 0)
        keys = [part.key for part in parts]
        rows = list(folder.read_rows(keys))
        finish_run(
            folder,
            keys,
            [f"cell {row['cell']}, {row['method']}: {row['reason']}" for row in rows if row["reason"]],
        )
        write_summaries(folder.path)
        return open_comparison(folder.path)


def _parts(inputs: MovieInputs, methods: tuple[str, ...]) -> list[_Part]:
    return [
        _Part(track, method, part_key(track.cell, number))
        for track in inputs.tracks
        for number, method in enumerate(methods)
    ]


def _compare(
    part: _Part,
    inputs: MovieInputs,
    parameters: CompareMovieParameters,
    folder: Path,
    report: Callable[[int, int], None],
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    """Row and tables of one cell by one method; a movie without any map has the reason in its row."""
    times = part.track.times
    row: dict[str, Any] = {
        "cell": part.track.cell,
        "source": inputs.masks.path.name,
        "time": times[0],
        "label": part.track.label,
        "method": part.method,
    }
    started = clock.perf_counter()
    masks = [part.track.mask_in(read_frame(inputs.masks, time), time) for time in times]
    with TemporaryDirectory(dir=folder, prefix=".", suffix=f".{os.getpid()}.tmp.maps") as maps:
        try:
            movie = map_movie(
                masks,
                tracker=parameters.tracker,
                register=parameters.registration,
                tension=parameters.tension,
                renew_every=parameters.renew_every,
                # Windows that are not on a map need its edge alone, which is the same for all methods.
                method=part.method if part.method in ON_A_MAP else "harmonic",  # type: ignore[arg-type]
                shape_weight=parameters.shape_weight,
                edge_length=parameters.edge_length,
                align=parameters.align,
                inertia=parameters.inertia,
                pixel_size_um=inputs.scale.pixel_size_um,
                frame_interval_s=inputs.scale.frame_interval_s,
                folder=maps,
                progress=report,
            )
        except CytodiskError as fault:
            seconds = clock.perf_counter() - started
            gone = {"status": "no map", "reason": str(fault), "frames": len(times), "mapped": 0}
            return row | gone | {"seconds": seconds}, {}
        measured, tables = _measure(part, movie, inputs, parameters, folder)
    seconds = (clock.perf_counter() - started) / len(times)
    return row | measured | {"seconds": seconds}, tables


def _measure(
    part: _Part, movie: DiskMovie, inputs: MovieInputs, parameters: CompareMovieParameters, folder: Path
) -> tuple[dict[str, Any], dict[str, dict[str, Any]]]:
    first = part.track.times[0]
    grid = _grid(part.method, movie, parameters)
    activity, rows, layers = _sample_frames(part, movie, grid, inputs.signal, parameters)
    faults = [(first + time, record.reason) for time, record in enumerate(movie.records) if record.reason]
    refused = sum(record.status in ("missing", "unreadable") for record in movie.records)
    row: dict[str, Any] = {
        "status": "partly" if faults else "ok",
        "reason": "; ".join(f"frame {time}: {reason}" for time, reason in faults),
        "frames": len(movie) - refused,
        "mapped": len(rows),
        "depth_px": grid.depth_px if isinstance(grid, EdgeGrid) else None,
    }
    if part.method in ON_A_MAP:
        row["certificate_valid"] = all(frame["certificate_valid"] for frame in rows)
    row |= {name: float(np.median(found)) for name in _MIDDLE if (found := _known(rows, name))}
    row |= {name: sum(found) for name in _SUMMED if (found := _known(rows, name))}
    with replacing(folder / "maps" / f"activity_{part_key(part.track.cell)}_{part.method}.npz") as temporary:
        channels = np.array(activity["channel"].to_numpy(), dtype=str)
        np.savez_compressed(
            temporary, mean=activity["mean"], time=activity["time"], channel=channels, area=activity["area"]
        )
    tables = {"layers": _stacked(layers), "consistency": _consistency(part, movie, activity, layers)}
    return row, tables


def _grid(method: str, movie: DiskMovie, parameters: CompareMovieParameters) -> Grid:
    layers, sectors = parameters.layers, parameters.sectors
    if method == "rings":
        return RingGrid(layers, sectors)
    if method != "edge":
        return polar_windows(layers, sectors, parameters.spacing)
    depth = parameters.depth_px
    if depth is None:
        depth = CellEdge.of(movie[int(np.argmax(movie.mapped))]).greatest_depth / layers
    return EdgeGrid(layers, sectors, depth)


def _sample_frames(
    part: _Part,
    movie: DiskMovie,
    grid: Grid,
    signal: FrameFile | None,
    parameters: CompareMovieParameters,
) -> tuple[xr.Dataset, list[dict[str, Any]], list[dict[str, Any]]]:
    """The activity, and by mapped frame what windows are like: for the row, and by layer."""
    first = part.track.times[0]
    channels = [""] if signal is None else list(signal.channels)
    shape = (len(movie), grid.layers, grid.sectors)
    area, y, x = (np.full(shape, np.nan) for _ in range(3))
    mean = np.full((shape[0], len(channels), *shape[1:]), np.nan)
    rows, layers = [], []
    for time, record in enumerate(movie.records):
        if not record.has_map:
            continue
        disk: DiskMap = movie[time]
        windows = grid.on(disk)
        area[time] = windows.areas
        y[time], x[time] = np.moveaxis(windows.centroids_yx, -1, 0)
        image = _image(signal, first + time)
        if image is not None:
            mean[time] = sample(windows, image, nan=parameters.nan)["mean"].to_numpy()
        rows.append(windows_row(windows, disk if part.method in ON_A_MAP else None))
        layers.append(layer_columns(part.track.cell, first + time, part.method, measures_by_layer(windows)))
    tables = {"mean": mean, "area": area, "centroid_y": y, "centroid_x": x}
    reasons = [record.reason for record in movie.records]
    scale = movie.pixel_size_um, movie.frame_interval_s
    activity = activity_dataset(tables, channels, movie.status, reasons, *scale, first_time=first)
    return activity, rows, layers


def _image(signal: FrameFile | None, time: int) -> Any:
    """A frame of the signal, (channel, y, x); None where there is none or it is damaged."""
    if signal is None:
        return None
    try:
        return signal.frame(time)
    except ReadError:
        return None


def _consistency(
    part: _Part, movie: DiskMovie, activity: xr.Dataset, layers: list[dict[str, Any]]
) -> dict[str, Any]:
    """Rows of the table of consistency: by frame with a map, channel and layer."""
    correlation = consecutive_correlation(activity["mean"]).to_numpy()
    moved = centroid_displacement(movie, activity).mean("sector").to_numpy()
    columns: list[dict[str, Any]] = []
    for found in layers:
        time = int(found["time"][0]) - part.track.times[0]
        for number, channel in enumerate(activity["channel"].to_numpy()):
            count = len(found["layer"])
            interval = movie.frame_interval_s
            columns.append(
                {
                    "cell": found["cell"],
                    "method": found["method"],
                    "time": found["time"],
                    "time_s": [None if interval is None else int(found["time"][0]) * interval] * count,
                    "channel": [str(channel) or None] * count,
                    "layer": found["layer"],
                    "correlation": correlation[time, number],
                    "centroid_displacement": moved[time],
                    "completeness": found["completeness"],
                }
            )
    return _stacked(columns)


def _stacked(columns: list[dict[str, Any]]) -> dict[str, Any]:
    names = columns[0] if columns else {}
    return {name: [value for part in columns for value in part[name]] for name in names}


def _known(rows: list[dict[str, Any]], name: str) -> list[Any]:
    return [row[name] for row in rows if row.get(name) is not None]
