"""Compare windows on the cells of a mask file or folder: `cytodisk compare-windows`."""

from __future__ import annotations

import os
import time as clock
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from cytodisk.analysis.window_measures import measures_by_layer
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.errors import CytodiskError
from cytodisk.files import replacing
from cytodisk.geometry.mask import FilledMask
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_parts import CellRun, CellTask, Rows
from cytodisk.runs.compare_windows.compare_parameters import CompareWindowsParameters
from cytodisk.runs.compare_windows.compare_tables import (
    COMPARED_CELLS,
    layer_columns,
    method_status,
    windows_row,
)
from cytodisk.runs.compare_windows.comparison import Comparison, open_comparison, write_summaries
from cytodisk.runs.frame_rows import FramePlace
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import Progress, RunOptions, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.scale import UNKNOWN
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_kind import MAPS
from cytodisk.taking import takes
from cytodisk.windows.edge_windows import edge_windows
from cytodisk.windows.grid_parameters import EdgeWindowParameters, RingWindowParameters
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.ring_windows import ring_windows
from cytodisk.windows.shares import PER_SIDE

_CELLS_AT_ONCE = 1
_SMALL_PX = 4000  # cells up to here are drawn by parts of pixels


@takes(RunOptions)
def compare_opened_cells(
    inputs: CellInputs,
    out: str | os.PathLike[str],
    parameters: CompareWindowsParameters,
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> Comparison:
    """Lay windows of several methods, with the same grid, on every cell and measure them.

    Parameters
    ----------
    inputs : CellInputs
        Opened with these parameters.
    out : path-like
        Folder for the results.
    parameters : CompareWindowsParameters
    progress : callable, optional
        Called with (cells done, cells in all).
    **settings
        See `RunOptions`.

    Returns
    -------
    Comparison
        Complete; a cell that a method cannot map has a row with the reason.

    References
    ----------
    u-Unwrap, section 4.1 and Fig. 3.
    """
    options = RunOptions.of(**settings)
    parameters = parameters.in_pixels(inputs.scale)

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        compare = partial(compare_cell, parameters=parameters, folder=folder.path)
        files = partial(_files, folder=folder.path)
        run = CellRun(inputs, compare, _CELLS_AT_ONCE, files=files)
        keys = run.fill(folder, options.workers, progress or silent)
        warnings = [
            f"cell {row['cell']}, {row['method']}: {words}"
            for row in folder.read_rows(keys)
            if (words := row["reason"] or row.get("qc_flags"))
        ]
        return keys, warnings

    provenance = describe_run(inputs.paths, parameters, inputs.understood, UNKNOWN, inputs.notes)
    run = StudyRun(COMPARED_CELLS, provenance, parameters, options)
    return run.into(out, work, open_comparison, write_summaries)


def compare_cell(task: CellTask, parameters: CompareWindowsParameters, folder: Path) -> Rows:
    """Measure one cell's windows by each method; a fault becomes a row with the reason.

    Parameters
    ----------
    task : CellTask
    parameters : CompareWindowsParameters
    folder : Path
        Of the study; which pixel is in which window is written there.

    Returns
    -------
    list of (row, tables)
        One a method.
    """
    found = task.found
    rows: Rows = []
    labels: dict[str, Any] = {}
    for method in parameters.methods:
        place = FramePlace(found.cell, found.frame, found.label, source=found.source)
        row = place.row | {"method": method, "frames": 1}
        started = clock.perf_counter()
        try:
            windows, disk = _lay(method, found, parameters)
        except CytodiskError as fault:
            seconds = clock.perf_counter() - started
            gone = {"status": method_status(fault), "reason": str(fault), "mapped": 0, "seconds": seconds}
            rows.append((row | gone, {}))
            continue
        seconds = clock.perf_counter() - started
        report = FilledMask.of(found.mask).under(parameters.holes).report
        row |= windows_row(windows, disk) | {"status": "ok", "reason": "", "mapped": 1, "seconds": seconds}
        row |= {"notes": "; ".join(report.notes), "qc_flags": "; ".join(report.qc_flags)}
        measures = measures_by_layer(windows)
        rows.append((row, {"layers": layer_columns(found.cell, found.frame, method, measures)}))
        per_side = PER_SIDE if report.area_px <= _SMALL_PX else 1
        labels[method] = (windows.labels if per_side == 1 else windows.subpixel_labels).astype(np.int32)
        labels["mask"] = windows.mask_without_holes.repeat(per_side, axis=0).repeat(per_side, axis=1)
    if labels:
        with replacing(*_files(task, folder)) as temporary:
            np.savez_compressed(temporary, **labels)
    return rows


def _files(task: CellTask, folder: Path) -> list[Path]:
    """The file that says which pixel of a cell is in which window."""
    return [folder / MAPS / f"windows_{part_key(task.found.cell)}.npz"]


def _lay(
    method: str, found: SourceCell, parameters: CompareWindowsParameters
) -> tuple[WindowsOnCell, DiskMap | None]:
    """Windows of one method with their weights, and the map they are on, if any."""
    if found.fault is not None:
        raise found.fault
    mask = found.mask
    disk: DiskMap | None = None
    windows: WindowsOnCell
    if method == "edge":
        windows = edge_windows(mask, **dict(parameters.part(EdgeWindowParameters)))
    elif method == "rings":
        windows = ring_windows(mask, **dict(parameters.part(RingWindowParameters)))
    else:
        disk = map_to_disk(mask, method=method, **dict(parameters.part(MeshParameters)))
        windows = polar_windows(parameters.layers, parameters.sectors, parameters.spacing).on(disk)
    _ = windows.weights  # belongs to the time it takes
    return windows, disk
