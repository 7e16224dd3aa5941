"""Compare windows on cells that are followed through time: `cytodisk compare-windows --movie`."""

from __future__ import annotations

import os
import shutil
import time as clock
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from cytodisk.errors import CytodiskError
from cytodisk.files import flushed_later, replacing, temporary_name, writing_to
from cytodisk.images.tracks import CellTrack, TrackMasks
from cytodisk.motion.demons import simple_itk
from cytodisk.motion.disk_movie import DiskMovie
from cytodisk.motion.map_movie import map_movie
from cytodisk.motion.tracking_parameters import FollowingParameters
from cytodisk.runs.compare_windows.compare_frames import FollowedCell, measure_frames, usable
from cytodisk.runs.compare_windows.compare_parameters import ON_A_MAP, OURS, CompareMovieParameters
from cytodisk.runs.compare_windows.compare_tables import COMPARED_MOVIE
from cytodisk.runs.compare_windows.comparison import Comparison, open_comparison, write_summaries
from cytodisk.runs.executor import Executor
from cytodisk.runs.movie.movie_inputs import MovieInputs
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import Progress, RunOptions, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_kind import MAPS
from cytodisk.taking import takes

_Measured: TypeAlias = tuple[dict[str, Any], dict[str, dict[str, Any]]]


@dataclass(frozen=True)
class _Part:
    """One cell followed by one method."""

    track: CellTrack
    method: str
    key: str


@takes(RunOptions)
def compare_opened_movie(
    inputs: MovieInputs,
    out: str | os.PathLike[str],
    parameters: CompareMovieParameters,
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> Comparison:
    """Follow each cell with the windows of several methods and measure how consistent they are.

    The edge is tracked in the same way for most: edge-based windows have the sectors of the polar ones. Those
    with springs follow the edge by line tension of their own, registered ones by the registration alone.

    Parameters
    ----------
    inputs : MovieInputs
        Opened with these parameters.
    out : path-like
        Folder for the results.
    parameters : CompareMovieParameters
    progress : callable, optional
        Called with (frames done, frames in all), over all methods.
    **settings
        See `RunOptions`; a process takes one cell by one method.

    Returns
    -------
    Comparison
        Complete; its `consistency` has the measures of the paper's Fig. 4.

    References
    ----------
    u-Unwrap, section 4.2 and Fig. 4.
    """
    options = RunOptions.of(**settings)
    parameters = parameters.in_pixels(inputs.scale)
    if "registered" in parameters.methods:
        simple_itk('method "registered"')

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        parts = _parts(inputs, parameters.methods)
        _compare_all(parts, inputs, parameters, folder, options.workers, progress or silent)
        keys = [part.key for part in parts]
        rows = folder.read_rows(keys)
        return keys, [
            f"cell {row['cell']}, {row['method']}: {row['reason']}" for row in rows if row["reason"]
        ]

    provenance = describe_run(inputs.paths, parameters, inputs.understood, inputs.scale, inputs.notes)
    run = StudyRun(COMPARED_MOVIE, provenance, parameters, options)
    return run.into(out, work, open_comparison, write_summaries)


def _compare_all(
    parts: list[_Part],
    inputs: MovieInputs,
    parameters: CompareMovieParameters,
    folder: StudyFolder,
    workers: int,
    progress: Progress,
) -> None:
    """Do the parts that are not there yet; progress is counted in frames of all parts."""
    folder.expect([part.key for part in parts])
    pending = [part for part in parts if not folder.has(part.key)]
    total = sum(len(part.track.frames) for part in parts)
    done = total - sum(len(part.track.frames) for part in pending)
    progress(done, total)

    def within(frames: int, _: int) -> None:
        progress(done + frames, total)

    report = within if workers == 1 else None  # no call reaches this process from another one
    with Executor(workers) as executor:

        def begun(part: _Part) -> Future[_Measured]:
            folder.begin(part.key, [_activity_path(part, folder.path)])
            return executor.submit(_compare, part, inputs, parameters, folder.path, report)

        for part, rows in zip(pending, executor.results(map(begun, pending)), strict=True):
            file = _activity_path(part, folder.path)
            folder.add(part.key, *rows, [file] if file.exists() else [])
            done += len(part.track.frames)
            progress(done, total)


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
    report: Progress | None,
) -> _Measured:
    """Row and tables of one cell by one method; a movie without any map has the reason in its row."""
    track, started = part.track, clock.perf_counter()
    masks = TrackMasks(inputs.masks, track)
    row: dict[str, Any] = {
        "cell": track.cell,
        "source": inputs.masks.path.name,
        "frame": track.first,
        "label": track.label,
        "method": part.method,
    }
    with _folder_for_maps(folder) as maps, flushed_later():
        try:
            movie = _map(part.method, masks, inputs, parameters, maps, report)
        except CytodiskError as fault:
            seconds = (clock.perf_counter() - started) / len(masks)
            gone = {"status": "no map", "reason": str(fault), "mapped": 0, "seconds": seconds}
            return row | {"frames": usable(masks, parameters.holes)} | gone, {}
        followed = FollowedCell(track.cell, track.first, part.method, movie, inputs.signal, parameters)
        measured = measure_frames(followed)
    seconds = (clock.perf_counter() - started) / len(masks)
    activity = measured.activity
    with flushed_later(), replacing(_activity_path(part, folder)) as temporary:
        channels = np.array(activity["channel"].to_numpy(), dtype=str)
        arrays: dict[str, Any] = {name: activity[name].to_numpy() for name in ("mean", "area", "frame")}
        np.savez_compressed(temporary, channel=channels, **arrays)
    reasons = [(track.first + frame, record.reason) for frame, record in enumerate(movie.records)]
    faults = "; ".join(f"frame {frame}: {reason}" for frame, reason in reasons if reason)
    outcome = {"status": "partly" if faults else "ok", "reason": faults, "seconds": seconds}
    # A frame with a map had a mask: only those of the others are looked at again.
    frames = int(movie.mapped.sum()) + usable(
        (masks[frame] for frame in np.flatnonzero(~movie.mapped).tolist()), parameters.holes
    )
    return row | {"frames": frames} | measured.row | outcome, measured.tables


@contextmanager
def _folder_for_maps(folder: Path) -> Iterator[str]:
    """A folder for the maps of one cell, which is removed."""
    maps = folder / temporary_name(".maps")
    try:
        with writing_to(maps):
            maps.mkdir()
        yield str(maps)
    finally:
        shutil.rmtree(maps, ignore_errors=True)


def _activity_path(part: _Part, folder: Path) -> Path:
    return folder / MAPS / f"activity_{part_key(part.track.cell)}_{part.method}.npz"


def _map(
    method: str,
    masks: TrackMasks,
    inputs: MovieInputs,
    parameters: CompareMovieParameters,
    folder: str,
    report: Progress | None,
) -> DiskMovie:
    return map_movie(
        masks,
        # Windows that are not on a map need its edge alone, which is the same for all methods; those that are
        # carried from the first frame need that frame's default map.
        method=method if method in ON_A_MAP else OURS if method == "registered" else "harmonic",
        pixel_size_um=inputs.scale.pixel_size_um,
        frame_interval_s=inputs.scale.frame_interval_s,
        folder=folder,
        progress=report,
        **dict(parameters.part(FollowingParameters)),
    )
