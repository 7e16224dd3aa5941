"""A run over a mask movie: `cytodisk movie` and the same from Python."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Future
from functools import partial
from typing import Any

from cytodisk.errors import MaskError, ReadError, as_data
from cytodisk.geometry.placed_mask import PlacedMask
from cytodisk.images.signal_files import SignalFrame, open_image
from cytodisk.images.tracks import CellTrack, open_cells
from cytodisk.motion.following import FollowedFrame, map_cells
from cytodisk.motion.frame_file import load_frame
from cytodisk.motion.mapped_frame import MappedFrame
from cytodisk.motion.tracking_parameters import MovieSettings
from cytodisk.runs.cells.cell_nuclei import CellNucleus
from cytodisk.runs.cells.nucleus_rows import nuclei_warnings
from cytodisk.runs.executor import Executor, finished
from cytodisk.runs.flagged_cells import fill_cells
from cytodisk.runs.frame_rows import FramePlace
from cytodisk.runs.movie.measured_frame import FrameRows, FrameTask, measure_frame, unmapped_rows
from cytodisk.runs.movie.movie_inputs import MovieInputs
from cytodisk.runs.movie.movie_kind import MOVIE
from cytodisk.runs.movie.movie_tables import MOTION_PART, STRETCHES_PART, finish_tables
from cytodisk.runs.movie.nuclei_of_movie import MovieNuclei, with_nucleus_of
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import Progress, RunOptions, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.store.study import Study, open_study
from cytodisk.store.study_folder import StudyFolder, part_key
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
    provenance = describe_run(inputs.paths, inputs.parameters, inputs.understood, inputs.scale, inputs.notes)
    provenance |= {"layers": inputs.grid.layers, "image_shape": list(inputs.masks.image_shape)}
    if inputs.parameters.tracks is not None:
        provenance["mothers"] = {str(label): mother for label, mother in sorted(inputs.mothers.items())}

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        with Executor(options.workers) as executor:
            _Run(inputs, folder, executor, progress or silent).all_frames()
        channels = inputs.signal.channels if inputs.signal else ()
        finish_tables(folder, inputs.tracks, inputs.grid, inputs.scale, channels)
        warnings = [words for row in folder.rows() if (words := _warning(row))]
        return inputs.keys, [*nuclei_warnings(folder, inputs.keys), *warnings]

    kind = MOVIE
    if inputs.nuclei is not None:
        kind = MOVIE.with_nuclei.with_channels(inputs.signal.channels if inputs.signal else ())
    kind = kind if inputs.groups is None else inputs.groups.kind(kind)
    fill = partial(fill_cells, groups=inputs.groups)
    return StudyRun(kind, provenance, inputs.parameters, options).into(out, work, open_study, fill)


class _Run:
    """Frame after frame, all cells of a frame side by side.

    A frame is mapped when the one before is; measuring it runs beside the mapping of the next one.
    """

    def __init__(self, inputs: MovieInputs, folder: StudyFolder, executor: Executor, report: Progress):
        self._inputs = inputs
        self._folder = folder
        self._executor = executor
        self._tracks = {track.cell: track for track in inputs.tracks}
        self._last: dict[int, MappedFrame] = {}
        self._signal: SignalFrame | ReadError | None = None  # of the frame that is being mapped
        self._nuclei: dict[int, CellNucleus] = {}  # of its cells
        self._report = report
        self._first_pending: dict[int, int] = {}

    def all_frames(self) -> None:
        """Do what is not done yet."""
        self._folder.expect(self._inputs.keys)
        self._first_pending = {track.cell: self._first_undone(track) for track in self._inputs.tracks}
        done = sum(self._first_pending[track.cell] - track.first for track in self._inputs.tracks)
        total = self._inputs.n_frames
        self._report(done, total)
        for rows in self._executor.results(self._frames()):
            self._add(rows)
            done += 1
            self._report(done, total)

    def _first_undone(self, track: CellTrack) -> int:
        """The first frame of a cell that is not done; those that follow go on from it, so are done anew."""
        keys = {frame: part_key(track.cell, frame) for frame in track.frames}
        return next((frame for frame, key in keys.items() if not self._folder.has(key)), track.last + 1)

    def _add(self, rows: FrameRows) -> None:
        """Write a frame, with the motion since the one before."""
        key, before = part_key(rows.cell, rows.frame), part_key(rows.cell, rows.frame - 1)
        files = []
        if rows.stretches_before is not None:
            files.append(self._folder.add_array(before, STRETCHES_PART, rows.stretches_before))
        if rows.edge_before is not None:
            files.append(self._folder.add_table(before, "edge", rows.edge_before, name=MOTION_PART))
        if rows.row["status"] == "ok":
            files.append(self._folder.map_path(key))
        self._folder.add(key, rows.row, rows.tables, files)

    def _frames(self) -> Iterator[Future[FrameRows]]:
        """Frames on their way to be measured."""
        settings, submit = self._inputs.parameters.part(MovieSettings), self._executor.submit
        masks, scale = self._pending_masks(), self._inputs.scale
        return map(self._measured, map_cells(masks, settings, scale, last=self._last, submit=submit))

    def _pending_masks(self) -> Iterator[tuple[int, Iterator[tuple[int, Any]]]]:
        """Each frame that is not done, with the masks of its cells that are not."""
        for frame in range(self._inputs.masks.n_frames):
            present = [track for track in self._inputs.tracks if frame in track.frames]
            pending = [track for track in present if frame >= self._first_pending[track.cell]]
            if pending:
                yield frame, self._read(frame, pending)
            for track in present:
                if frame == track.last:
                    self._last.pop(track.cell, None)

    def _read(self, frame: int, tracks: list[CellTrack]) -> Iterator[tuple[int, Any]]:
        """Cells with their masks; without the frame's signal there is none."""
        cells = open_cells(self._inputs.masks, frame, self._inputs.kind)
        signal = self._signal = open_image(self._inputs.signal, frame)
        nuclei = self._inputs.nuclei
        matches = None if nuclei is None else MovieNuclei(nuclei, self._inputs.kind).matches(cells, frame)
        self._nuclei = {}
        for track in tracks:
            if track.cell not in self._last:
                self._resume_from(track, frame)
            mask = signal if isinstance(signal, ReadError) else track.cut_from(cells, frame)
            mask = _without_damage(mask, signal)
            if matches is None or not isinstance(mask, PlacedMask):
                yield track.cell, mask
                continue
            label = None if track.labels is None else track.labels[frame]
            both, self._nuclei[track.cell] = with_nucleus_of(matches, label, mask, not self._nuclei)
            yield track.cell, both

    def _measured(self, found: FollowedFrame) -> Future[FrameRows]:
        result, last = found.result, found.last
        track, frame = self._tracks[found.cell], result.frame
        place = FramePlace(track.cell, frame, track.label, self._inputs.scale.seconds(frame))
        nucleus = self._nuclei.get(track.cell)
        if result.mapped is None:
            fault = result.fault or MaskError("no map")
            return finished(unmapped_rows(place, fault, found.seconds, nucleus))
        signal = None
        if isinstance(self._signal, SignalFrame):
            signal = self._signal.cut(*result.mapped.disk.placed_mask.slices)
        path = self._folder.map_path(part_key(track.cell, frame))
        self._folder.begin(part_key(track.cell, frame), [path])
        task = FrameTask(
            place,
            result.mapped,
            last if last is not None and last.frame == frame - 1 else None,
            signal,
            self._inputs.grid,
            self._inputs.parameters,
            path,
            found.seconds,
            nucleus,
        )
        return self._executor.submit(measure_frame, task)

    def _resume_from(self, track: CellTrack, frame: int) -> None:
        """Read the last frame that has a map back, if an earlier run left any."""
        keys = {t: part_key(track.cell, t) for t in range(track.first, frame)}
        paths = {t: self._folder.map_path(key) for t, key in keys.items()}
        mapped = {t: path for t, path in paths.items() if path in self._folder.files_of(keys[t])}
        if mapped:
            self._last[track.cell] = load_frame(mapped[max(mapped)], mapped)


def _without_damage(mask: Any, signal: SignalFrame | ReadError | None) -> Any:
    """A cell's mask, or the error of its signal where just that piece of a frame is damaged."""
    if isinstance(mask, PlacedMask) and isinstance(signal, SignalFrame) and not signal.pixels.is_whole:
        try:
            signal.pixels.cut(*mask.slices)
        except ReadError as fault:
            return as_data(fault)
    return mask


def _warning(row: dict[str, Any]) -> str:
    remarks = [row.get(name) for name in ("reason", "mask_remarks", "restarted")]
    if row.get("nucleus_held"):
        remarks.append(f"nucleus held from the frame before: {row['nucleus_held']}")
    words = "; ".join(str(remark) for remark in remarks if remark)
    return f"cell {row['cell']}, frame {row['frame']}: {words}" if words else ""
