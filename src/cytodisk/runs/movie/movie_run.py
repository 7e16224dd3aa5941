"""A run over a mask movie: `cytodisk movie` and the same from Python."""

from __future__ import annotations

import os
import time as clock
from collections.abc import Iterator
from concurrent.futures import Future
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.errors import MaskError, ReadError, as_data
from cytodisk.images.frames import FrameFile
from cytodisk.images.tracks import CellTrack, read_frame
from cytodisk.motion.frame_file import load_frame
from cytodisk.motion.map_movie import FrameResult, map_one
from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.runs.executor import Executor, finished
from cytodisk.runs.movie.frame_rows import FrameRows, FrameTask, measure_frame, unmapped_row
from cytodisk.runs.movie.movie_inputs import MovieInputs
from cytodisk.runs.movie.movie_tables import finish_tables
from cytodisk.runs.parameters_file import write_parameters
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import RunOptions
from cytodisk.runs.steps import Progress, finish_run, silent
from cytodisk.scale import Scale
from cytodisk.store.study import Study, open_study
from cytodisk.store.study_folder import MOVIE_TABLES, PARAMETERS, StudyFolder, alone_in, part_key
from cytodisk.taking import takes


@takes(RunOptions)
def movie_study(
    inputs: MovieInputs,
    out: str | os.PathLike[str],
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> Study:
    """Map, sample and measure every frame of every cell, and write a study.

    Parameters
    ----------
    inputs : MovieInputs
        As `open_movie` returns it.
    out : path-like
        Folder of the study.
    progress : callable, optional
        Called with (frames done, frames in all), counted over all cells.
    **settings
        See `RunOptions`.

    Returns
    -------
    Study
        Complete; a frame that could not be mapped has a row with the reason.

    Raises
    ------
    ParameterError
        `workers` is below 1, or both `resume` and `overwrite` are set.
    StudyError
        The folder cannot be used.
    """
    options = RunOptions.of(**settings)
    paths = {"masks": inputs.masks.path} | ({"signal": inputs.signal.path} if inputs.signal else {})
    provenance = describe_run(
        paths, inputs.parameters, inputs.understood, inputs.scale.pixel_size_um, inputs.scale.frame_interval_s
    )
    provenance |= {
        "run": "movie",
        "layers": inputs.grid.layers,
        "image_shape": list(inputs.masks.image_shape),
    }
    with alone_in(out):
        if options.resume and StudyFolder.is_complete(out, provenance):
            return open_study(out)
        folder = StudyFolder.start(out, provenance, MOVIE_TABLES, **options.again)
        write_parameters(inputs.parameters, folder.path / PARAMETERS)
        with Executor(options.workers) as executor:
            _Run(inputs, folder, executor, progress).all_frames()
        channels = inputs.signal.channels if inputs.signal else ()
        finish_tables(folder, inputs.tracks, inputs.grid, inputs.scale, channels)
        rows = folder.rows()
        finish_run(folder, inputs.keys, [_warning(row) for row in rows if _warning(row)])
        return open_study(folder.path)


class _Run:
    """Frame after frame, all cells of a frame side by side.

    A frame is mapped when the one before is; measuring it runs beside the mapping of the next one.
    """

    def __init__(
        self, inputs: MovieInputs, folder: StudyFolder, executor: Executor, progress: Progress | None
    ):
        self._inputs = inputs
        self._folder = folder
        self._executor = executor
        self._settings = inputs.parameters.part(MovieSettings)
        self._last: dict[int, MappedFrame] = {}
        self._report = progress or silent

    def all_frames(self) -> None:
        """Do what is not done yet."""
        done, total = sum(self._folder.has(key) for key in self._inputs.keys), self._inputs.n_frames
        self._report(done, total)
        for rows in self._executor.results(self._frames()):
            if rows.edge_before is not None:
                self._folder.add_table(part_key(rows.cell, rows.frame - 1), "edge", rows.edge_before)
            self._folder.add(part_key(rows.cell, rows.frame), rows.row, rows.tables)
            done += 1
            self._report(done, total)

    def _frames(self) -> Iterator[Future[FrameRows]]:
        """Frames on their way to be measured."""
        for time in range(self._inputs.masks.n_frames):
            present = [track for track in self._inputs.tracks if time in track.times]
            pending = [track for track in present if not self._folder.has(part_key(track.cell, time))]
            if pending:
                yield from self._one_time(time, pending)
            for track in present:
                if time == track.last:
                    self._last.pop(track.cell, None)

    def _one_time(self, time: int, tracks: list[CellTrack]) -> Iterator[Future[FrameRows]]:
        frame = read_frame(self._inputs.masks, time)
        signal = _signal_at(self._inputs.signal, time)
        mapping = []
        for track in tracks:
            if track.cell not in self._last:
                self._resume_from(track, time)
            mask = signal if isinstance(signal, ReadError) else track.mask_in(frame, time)
            last = self._last.get(track.cell)
            task = time, mask, last, self._settings, self._inputs.scale
            mapping.append((track, self._executor.submit(_map_timed, *task)))
        for track, future in mapping:
            yield self._measured(track, time, *future.result(), signal)

    def _measured(
        self, track: CellTrack, time: int, result: FrameResult, seconds: float, signal: xr.DataArray | None
    ) -> Future[FrameRows]:
        if result.mapped is None:
            fault = result.fault or MaskError("no map")
            place = track.cell, time, self._inputs.scale.seconds(time)
            return finished(FrameRows(unmapped_row(place, track.label, fault, seconds), {}, None))
        last = self._last.get(track.cell)
        task = FrameTask(
            track.cell,
            track.label,
            result.mapped,
            last if last is not None and last.time == time - 1 else None,
            signal,
            self._inputs.grid,
            self._inputs.parameters,
            self._inputs.scale,
            self._folder.map_path(part_key(track.cell, time)),
            seconds,
        )
        self._last[track.cell] = result.mapped
        return self._executor.submit(measure_frame, task)

    def _resume_from(self, track: CellTrack, time: int) -> None:
        """Read the last frame that has a map back, if an earlier run left any."""
        done = [t for t in range(track.first, time) if self._folder.has(part_key(track.cell, t))]
        paths = {t: self._folder.map_path(part_key(track.cell, t)) for t in done}
        mapped = {t: path for t, path in paths.items() if path.exists()}
        if mapped:
            self._last[track.cell] = load_frame(mapped[max(mapped)], mapped)


def _map_timed(
    time: int, mask: Any, last: MappedFrame | None, settings: MovieSettings, scale: Scale
) -> tuple[FrameResult, float]:
    started = clock.perf_counter()
    return map_one(time, mask, last, settings, scale), clock.perf_counter() - started


def _signal_at(signal: FrameFile | None, time: int) -> Any:
    if signal is None:
        return None
    try:
        values = signal.frame(time)
    except ReadError as error:
        return as_data(error)
    coords = {"channel": list(signal.channels)}
    return xr.DataArray(values.astype(np.float64), dims=("channel", "y", "x"), coords=coords)


def _warning(row: dict[str, Any]) -> str:
    remarks = [row.get(name) for name in ("reason", "qc_flags", "restarted")]
    words = "; ".join(str(remark) for remark in remarks if remark)
    return f"cell {row['cell']}, frame {row['frame']}: {words}" if words else ""
