"""A run over all cells of a mask file: `cytodisk map` and the same from Python."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import xarray as xr

from cytodisk.errors import CytodiskError, ReadError, SignalError
from cytodisk.geometry.mask import clean_mask
from cytodisk.io.frames import FrameFile, open_frames
from cytodisk.io.masks import CellMask, Kind, read_cells, understood_as
from cytodisk.io.study import Study, open_study
from cytodisk.io.study_folder import PARAMETERS, StudyFolder, alone_in, part_key
from cytodisk.study.one_cell import CellResult, CellTask, DrawCell, measure_cell
from cytodisk.study.parameters import MapParameters, write_parameters
from cytodisk.study.provenance import describe_run
from cytodisk.study.run_steps import check_options, finish_run, input_paths, name_channels
from cytodisk.study.workers import worker_pool
from cytodisk.windows.grid import polar_windows

_MOST_UNNAMED = 10  # more planes than that are hardly channels

Progress: TypeAlias = Callable[[int, int], None]


@dataclass(frozen=True)
class MapInputs:
    """The files of a run, opened and checked against each other.

    Attributes
    ----------
    masks : FrameFile
    kind : {"mask", "stack", "labels"}
    signal : FrameFile or None
    parameters : MapParameters
        As given.
    pixel_size_um : float or None
        The given one, or else the files' own; None when nobody knows.
    """

    masks: FrameFile
    kind: Kind
    signal: FrameFile | None
    parameters: MapParameters
    pixel_size_um: float | None

    @property
    def understood(self) -> dict[str, str]:
        """What each file was read as, in words."""
        what = {"mask": "one mask", "stack": "a stack of masks", "labels": "a label image, one cell a label"}
        words = {"masks": f"{what[self.kind]}, {self.masks.axes} {self.masks.shape} {self.masks.dtype}"}
        if self.signal is not None:
            names = ", ".join(self.signal.channels)
            words["signal"] = f"channels {names}; {self.signal.axes} {self.signal.shape} {self.signal.dtype}"
            if self.signal.n_frames < self.masks.n_frames:
                words["signal"] += (
                    f"; the one image is used for all {self.masks.n_frames} frames of the masks"
                )
        return words


def open_inputs(
    masks: str | os.PathLike[str], signal: str | os.PathLike[str] | None, parameters: MapParameters
) -> MapInputs:
    """Open the files of a run and check that they fit.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks, or a label image (or a stack of those).
    signal : path-like, optional
        An image with the shape of the masks, with as many frames as they, or one.
    parameters : MapParameters

    Returns
    -------
    MapInputs

    Raises
    ------
    ReadError, MaskError, SignalError, ParameterError
        A file is missing, damaged, or does not fit.
    """
    mask_file = open_frames(masks, unnamed="T")
    kind = understood_as(mask_file, parameters.kind)
    signal_file = None
    if signal is not None:
        signal_file = open_frames(signal, unnamed="T" if mask_file.n_frames > 1 else "C")
    signal_file = name_channels(signal_file, parameters.channels)
    if signal_file is not None:
        check_signal(mask_file, signal_file)
    polar_windows(parameters.layers, parameters.sectors, parameters.spacing)  # raises if it makes no sense
    pixel_size_um = parameters.pixel_size_um or common_pixel_size(mask_file, signal_file)
    return MapInputs(mask_file, kind, signal_file, parameters, pixel_size_um)


def run_map(
    inputs: MapInputs,
    out: str | os.PathLike[str],
    *,
    workers: int = 1,
    resume: bool = False,
    overwrite: bool = False,
    draw: DrawCell | None = None,
    draw_at_most: int | None = None,
    geojson: bool = False,
    progress: Progress | None = None,
) -> Study:
    """Map and sample every cell, and write a study.

    Parameters
    ----------
    inputs : MapInputs
        As `open_inputs` returns it.
    out : path-like
        Folder of the study.
    workers : int
        Processes; with 1 everything runs in this one. The results do not depend on it.
    resume, overwrite : bool
        What to do with a study that is there; see `StudyFolder.start`.
    draw : callable, optional
        Draws a cell's figures: (folder, name, windows, signal, pixel_size_um) → paths.
    draw_at_most : int, optional
        How many cells, from the first, to draw.
    geojson : bool
        Write each cell's window outlines beside its map.
    progress : callable, optional
        Called with (cells done, cells in all) at the start and after each cell.

    Returns
    -------
    Study
        Complete; a cell that could not be mapped has a row with the reason.

    Raises
    ------
    ParameterError
        `workers` is below 1, or both `resume` and `overwrite` are set.
    StudyError
        The folder cannot be used.
    """
    check_options(workers, resume, overwrite)
    paths = input_paths(inputs.masks, inputs.signal)
    provenance = describe_run(paths, inputs.parameters, inputs.understood, inputs.pixel_size_um)
    with alone_in(out):
        if resume and StudyFolder.is_complete(out, provenance):
            return open_study(out)
        folder = StudyFolder.start(out, provenance, resume=resume, overwrite=overwrite)
        write_parameters(inputs.parameters, folder.path / PARAMETERS)
        cells = list_cells(inputs)
        pending = [cell for cell in cells if not folder.has(part_key(cell))]
        report = progress or _silent
        done = len(cells) - len(pending)
        report(done, len(cells))
        at_most = len(cells) if draw_at_most is None else draw_at_most
        tasks = _tasks(inputs, folder, set(pending), draw, at_most, geojson)
        for result in _results(tasks, min(workers, max(1, len(pending)))):
            folder.add(part_key(result.row["cell"]), result.row, result.tables)
            done += 1
            report(done, len(cells))
        rows = folder.rows()
        warnings = [
            f"cell {row['cell']}: {row['reason'] or row['doubts']}"
            for row in rows
            if row["reason"] or row["doubts"]
        ]
        finish_run(folder, [part_key(cell) for cell in cells], warnings)
        return open_study(folder.path)


def list_cells(inputs: MapInputs) -> list[int]:
    """Numbers of all cells in the masks, damaged frames included."""
    if inputs.kind != "labels":
        return list(range(inputs.masks.n_frames))
    return [found.cell for found in read_cells(inputs.masks, inputs.kind)]


def common_pixel_size(masks: FrameFile, signal: FrameFile | None) -> float | None:
    known = [file for file in (signal, masks) if file is not None and file.pixel_size_um is not None]
    sizes = [file.pixel_size_um for file in known if file.pixel_size_um is not None]
    if sizes and max(sizes) > 1.01 * min(sizes):
        raise SignalError(
            f"pixel sizes differ: {known[0].path} says {sizes[0]:g} µm, {known[1].path} {sizes[1]:g} µm: "
            "pass the right one, as --pixel-size"
        )
    return sizes[0] if sizes else None


def _silent(done: int, total: int) -> None:
    """Report nothing."""


def check_signal(masks: FrameFile, signal: FrameFile) -> None:
    if signal.image_shape != masks.image_shape:
        raise SignalError(
            f"signal {signal.path} has images of {signal.image_shape}, the masks of {masks.image_shape}: "
            "they must have the same height and width"
        )
    if signal.dtype.kind not in "biuf":
        raise SignalError(f"signal {signal.path} has dtype {signal.dtype}: it must be numbers")
    if len(signal.channels) > _MOST_UNNAMED and signal.channels[0] == "0":
        raise SignalError(
            f"signal {signal.path} has {len(signal.channels)} planes without names, where one image is due: "
            "pass one frame, or name its axes in the file, and its channels there or with --channels"
        )
    if signal.n_frames not in (1, masks.n_frames):
        raise SignalError(
            f"signal {signal.path} has {signal.n_frames} frames, the masks {masks.n_frames}: "
            "pass as many, or a single image"
        )


def _tasks(
    inputs: MapInputs,
    folder: StudyFolder,
    pending: set[int],
    draw: DrawCell | None,
    draw_at_most: int,
    geojson: bool,
) -> Iterator[CellTask]:
    frame, signal, fault = -1, None, None
    for found in read_cells(inputs.masks, inputs.kind):
        if found.cell not in pending:
            continue
        if found.frame != frame:
            frame = found.frame
            signal, fault = _signal_at(inputs, frame)
        wanted = draw if found.cell < draw_at_most else None
        yield CellTask(
            found,
            signal,
            fault,
            inputs.parameters,
            inputs.pixel_size_um,
            folder.map_path(part_key(found.cell)),
            folder.figures,
            wanted,
            geojson,
        )


def _signal_at(inputs: MapInputs, frame: int) -> tuple[xr.DataArray | None, CytodiskError | None]:
    if inputs.signal is None:
        return None, None
    try:
        values = inputs.signal.frame(min(frame, inputs.signal.n_frames - 1))
    except ReadError as error:
        return None, error
    coords = {"channel": list(inputs.signal.channels)}
    return xr.DataArray(values.astype(np.float64), dims=("channel", "y", "x"), coords=coords), None


def _results(tasks: Iterator[CellTask], workers: int) -> Iterator[CellResult]:
    """Results in the order of tasks; at most two tasks a worker wait at a time, so memory is bounded."""
    waiting: deque[Future[CellResult]] = deque()
    with worker_pool(workers) as pool:
        for task in tasks:
            waiting.append(pool.submit(measure_cell, task))
            if workers == 1 or len(waiting) >= 2 * workers:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()


def check_cells(inputs: MapInputs) -> Iterator[tuple[CellMask, str, tuple[str, ...], tuple[str, ...]]]:
    """Look at every mask without mapping it.

    Parameters
    ----------
    inputs : MapInputs

    Yields
    ------
    found : CellMask
    reason : str
        Why it cannot be used; empty if it can.
    notes : tuple of str
        What cleaning would change.
    doubts : tuple of str
        What speaks against this being the mask of one cell.
    """
    for found in read_cells(inputs.masks, inputs.kind):
        if found.fault is not None:
            yield found, str(found.fault), (), ()
            continue
        try:
            _, report = clean_mask(found.mask)
        except CytodiskError as error:
            yield found, str(error), (), ()
            continue
        yield found, "", report.notes, report.doubts
