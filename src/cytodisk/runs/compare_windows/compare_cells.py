"""Compare windows on the cells of a mask file or folder: `cytodisk compare-windows`."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.geometry.mask import FilledMask, MaskReport
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_parts import CellTask, Rows
from cytodisk.runs.compare_windows.compare_parameters import CompareWindowsParameters
from cytodisk.runs.compare_windows.compare_tables import COMPARED_CELLS
from cytodisk.runs.compare_windows.compared_cells import compare_every_cell
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.runs.compare_windows.measured_methods import CellMethods, measured_rows, windows_files
from cytodisk.runs.run_options import Progress, RunOptions
from cytodisk.taking import takes
from cytodisk.windows.edge_windows import edge_windows
from cytodisk.windows.grid_parameters import EdgeWindowParameters, RingWindowParameters
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.polar_windows import polar_windows
from cytodisk.windows.ring_windows import ring_windows
from cytodisk.windows.springs.spring_parameters import SpringWindowParameters
from cytodisk.windows.springs.spring_windows import spring_windows


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
    return compare_every_cell(inputs, out, COMPARED_CELLS, compare_cell, parameters, options, progress)


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
        if method == "springs":
            return spring_windows(mask, **dict(chosen.part(SpringWindowParameters))), None
        if method == "rings":
            return ring_windows(mask, **dict(chosen.part(RingWindowParameters))), None
        disk = map_to_disk(mask, method=method, **dict(chosen.part(MeshParameters)))
        return polar_windows(chosen.layers, chosen.sectors, chosen.spacing).on(disk), disk
