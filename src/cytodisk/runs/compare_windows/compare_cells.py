"""Compare windows on the cells of a mask file or folder: `cytodisk compare-windows`."""

from __future__ import annotations

import os
import time as clock
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from cytodisk.analysis.window_measures import measures_by_layer
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.errors import CytodiskError
from cytodisk.files import replacing
from cytodisk.geometry.mask import clean_mask
from cytodisk.images.mask_files import SourceCell, read_source_cells
from cytodisk.runs.compare_windows.compare_parameters import CompareWindowsParameters
from cytodisk.runs.compare_windows.compare_tables import COMPARED_CELLS, layer_columns, status_of, windows_row
from cytodisk.runs.compare_windows.comparison import Comparison, open_comparison, write_summaries
from cytodisk.runs.executor import Executor
from cytodisk.runs.map.map_inputs import MapInputs
from cytodisk.runs.parameters_file import write_parameters
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import RunOptions
from cytodisk.runs.steps import Progress, finish_run, silent
from cytodisk.scale import Scale
from cytodisk.store.study_folder import PARAMETERS, StudyFolder, alone_in, part_key
from cytodisk.taking import takes
from cytodisk.windows.edge_windows import edge_windows
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.ring_windows import ring_windows
from cytodisk.windows.shares import PER_SIDE

_SMALL_PX = 4000  # cells up to here are drawn by parts of pixels

Rows: TypeAlias = list[tuple[dict[str, Any], dict[str, dict[str, Any]]]]


@dataclass(frozen=True)
class CompareTask:
    """Everything a worker needs to compare windows on one cell."""

    found: SourceCell
    parameters: CompareWindowsParameters
    path: Path


@takes(RunOptions)
def compare_opened_cells(
    inputs: MapInputs,
    out: str | os.PathLike[str],
    parameters: CompareWindowsParameters,
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> Comparison:
    """Lay windows of several methods, with the same grid, on every cell and measure them.

    Parameters
    ----------
    inputs : MapInputs
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
    parameters = parameters.in_pixels(Scale(inputs.pixel_size_um))
    provenance = describe_run(inputs.paths, parameters, inputs.understood, None) | {"run": "comparison"}
    with alone_in(out):
        if options.resume and StudyFolder.is_complete(out, provenance):
            write_summaries(Path(out))  # in case it was stopped just before
            return open_comparison(out)
        folder = StudyFolder.start(out, provenance, COMPARED_CELLS, **options.again)
        write_parameters(parameters, folder.path / PARAMETERS)
        cells = [found.cell for found in read_source_cells(inputs.sources)]
        pending = {cell for cell in cells if not folder.has(part_key(cell))}
        done = len(cells) - len(pending)
        report = progress or silent
        report(done, len(cells))
        tasks = (
            CompareTask(found, parameters, folder.path)
            for found in read_source_cells(inputs.sources)
            if found.cell in pending
        )
        with Executor(min(options.workers, max(1, len(pending)))) as executor:
            for rows in executor.each(compare_cell, tasks):
                folder.add_cells(part_key(rows[0][0]["cell"]), rows)
                done += 1
                report(done, len(cells))
        keys = [part_key(cell) for cell in cells]
        warnings = [
            f"cell {row['cell']}, {row['method']}: {words}"
            for row in folder.read_rows(keys)
            if (words := row["reason"] or row.get("qc_flags"))
        ]
        finish_run(folder, keys, warnings)
        write_summaries(folder.path)
        return open_comparison(folder.path)


def compare_cell(task: CompareTask) -> Rows:
    """Measure one cell's windows by each method; a fault becomes a row with the reason.

    Parameters
    ----------
    task : CompareTask

    Returns
    -------
    list of (row, tables)
        One a method, for `StudyFolder.add_cells`. Which pixel is in which window is written to the folder.
    """
    rows: Rows = []
    labels: dict[str, Any] = {}
    for method in task.parameters.methods:
        row = {
            "cell": task.found.cell,
            "source": task.found.source,
            "frame": task.found.frame,
            "label": task.found.label,
            "method": method,
            "frames": 1,
        }
        started = clock.perf_counter()
        try:
            windows, disk = _lay(method, task)
        except CytodiskError as fault:
            seconds = clock.perf_counter() - started
            gone = {"status": status_of(fault), "reason": str(fault), "mapped": 0, "seconds": seconds}
            rows.append((row | gone, {}))
            continue
        seconds = clock.perf_counter() - started
        _, report = clean_mask(task.found.mask)
        row |= windows_row(windows, disk) | {"status": "ok", "reason": "", "mapped": 1, "seconds": seconds}
        row |= {"notes": "; ".join(report.notes), "qc_flags": "; ".join(report.qc_flags)}
        measures = measures_by_layer(windows)
        rows.append((row, {"layers": layer_columns(task.found.cell, task.found.frame, method, measures)}))
        per_side = PER_SIDE if report.area_px <= _SMALL_PX else 1
        labels[method] = (windows.labels if per_side == 1 else windows.subpixel_labels).astype(np.int32)
        labels["mask"] = windows.mask.repeat(per_side, axis=0).repeat(per_side, axis=1)
    if labels:
        with replacing(task.path / "maps" / f"windows_{part_key(task.found.cell)}.npz") as temporary:
            np.savez_compressed(temporary, **labels)
    return rows


def _lay(method: str, task: CompareTask) -> tuple[WindowsOnCell, DiskMap | None]:
    """Windows of one method with their weights, and the map they are on, if any."""
    if task.found.fault is not None:
        raise task.found.fault
    parameters, mask = task.parameters, task.found.mask
    disk: DiskMap | None = None
    windows: WindowsOnCell
    if method == "edge":
        windows = edge_windows(mask, parameters.layers, parameters.sectors, parameters.depth_px)
    elif method == "rings":
        windows = ring_windows(mask, parameters.layers, parameters.sectors)
    else:
        disk = map_to_disk(mask, method=method, **dict(parameters.part(MeshParameters)))
        windows = polar_windows(parameters.layers, parameters.sectors, parameters.spacing).on(disk)
    _ = windows.weights  # belongs to the time it takes
    return windows, disk
