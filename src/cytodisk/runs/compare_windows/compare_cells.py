"""Compare windows on the cells of a mask file or folder: `cytodisk compare-windows`."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.geometry.mask import FilledMask, MaskReport
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_parts import CellRun, CellTask, Rows
from cytodisk.runs.compare_windows.compare_parameters import CompareWindowsParameters
from cytodisk.runs.compare_windows.compare_tables import COMPARED_CELLS
from cytodisk.runs.compare_windows.comparison import Comparison, open_comparison, write_summaries
from cytodisk.runs.compare_windows.measured_methods import CellMethods, measured_rows, windows_files
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import Progress, RunOptions, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.scale import UNKNOWN
from cytodisk.store.study_folder import StudyFolder
from cytodisk.taking import takes
from cytodisk.windows.edge_windows import edge_windows
from cytodisk.windows.grid_parameters import EdgeWindowParameters, RingWindowParameters
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.ring_windows import ring_windows

_CELLS_AT_ONCE = 1


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
        files = partial(windows_files, folder=folder.path)
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
    (path,) = windows_files(task, folder)
    return measured_rows(task.found, parameters.methods, _Methods(task.found, parameters), path)


@dataclass(frozen=True)
class _Methods(CellMethods):
    """The methods on one cell."""

    found: SourceCell
    parameters: CompareWindowsParameters

    def report(self) -> tuple[MaskReport, tuple[str, ...]]:
        return FilledMask.of(self.found.mask).under(self.parameters.holes).report, ()

    def lay(self, method: str) -> tuple[WindowsOnCell, DiskMap | None]:
        if self.found.fault is not None:
            raise self.found.fault
        mask, chosen = self.found.mask, self.parameters
        if method == "edge":
            return edge_windows(mask, **dict(chosen.part(EdgeWindowParameters))), None
        if method == "rings":
            return ring_windows(mask, **dict(chosen.part(RingWindowParameters))), None
        disk = map_to_disk(mask, method=method, **dict(chosen.part(MeshParameters)))
        return polar_windows(chosen.layers, chosen.sectors, chosen.spacing).on(disk), disk
