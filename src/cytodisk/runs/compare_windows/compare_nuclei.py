"""Compare windows on cells with their nuclei: `cytodisk compare-windows --nuclei`."""

from __future__ import annotations

import os
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.compartment_measures import compartment_measures, nearness, outer_fifth
from cytodisk.arrays import BoolArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_to_disk
from cytodisk.disk.mapping_parameters import MeshParameters
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.errors import CytodiskError
from cytodisk.geometry.mask import FilledMask, MaskReport
from cytodisk.geometry.nucleus_mask import fit_nucleus
from cytodisk.geometry.nucleus_report import NucleusReport
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_parts import CellTask, Rows
from cytodisk.runs.compare_windows.compare_parameters import CompareNucleiParameters
from cytodisk.runs.compare_windows.compare_tables import COMPARED_NUCLEI, windows_row
from cytodisk.runs.compare_windows.compared_cells import compare_every_cell
from cytodisk.runs.compare_windows.comparison import Comparison
from cytodisk.runs.compare_windows.measured_methods import CellMethods, measured_rows, windows_files
from cytodisk.runs.run_options import Progress, RunOptions
from cytodisk.taking import takes
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.polar_windows import CellWindows, polar_windows
from cytodisk.windows.rings.interpolated_rings import InterpolatedRingWindows, interpolated_ring_windows
from cytodisk.windows.rings.nucleus_edges import NucleusEdges
from cytodisk.windows.rings.nucleus_ring_parameters import NucleusRingWindowParameters
from cytodisk.windows.rings.nucleus_rings import NucleusRingWindows, nucleus_ring_windows

NucleusWindows = CellWindows | NucleusRingWindows | InterpolatedRingWindows


@dataclass(frozen=True, eq=False)
class NucleusMethods(CellMethods):
    """The methods on one cell with its nucleus.

    Attributes
    ----------
    found : SourceCell
    nucleus : ndarray of shape (h, w) or None
        Labels of its nuclei, cut out as its mask is; None with a fault.
    fault : CytodiskError or None
        Why it cannot be used.
    parameters : CompareNucleiParameters
    """

    found: SourceCell
    nucleus: Any
    fault: CytodiskError | None
    parameters: CompareNucleiParameters

    @cached_property
    def _fitted(self) -> tuple[MaskReport, BoolArray, NucleusReport]:
        """What was changed in the mask, the fitted nucleus, and what was changed in it."""
        fault = self.found.fault or self.fault
        if fault is not None:
            raise fault
        found = FilledMask.of(self.found.mask)
        nucleus, changed = fit_nucleus(found.filled, self.nucleus, several=self.parameters.several)
        return found.under(self.parameters.holes, nucleus).report, nucleus, changed

    @cached_property
    def _edges(self) -> NucleusEdges:
        return NucleusEdges.of(self.found.mask, self._fitted[1], self.parameters.holes)

    def report(self) -> tuple[MaskReport, tuple[str, ...]]:
        report, _, changed = self._fitted
        return report, changed.notes

    def drawn(self) -> dict[str, BoolArray]:
        return {"nucleus": self._fitted[1]}

    def lay(self, method: str) -> tuple[NucleusWindows, DiskMap | None]:
        _, nucleus, _ = self._fitted
        mask, chosen = self.found.mask, self.parameters
        rings = dict(chosen.part(NucleusRingWindowParameters))
        if method == "nucleus-rings":
            return nucleus_ring_windows(mask, nucleus, **rings), None
        if method == "interpolated-rings":
            more = {"points": chosen.points, "harmonics": chosen.harmonics}
            return interpolated_ring_windows(mask, nucleus, **rings, **more), None
        settings = dict(chosen.part(MeshParameters)) | dict(chosen.part(NucleusParameters))
        disk = map_to_disk(mask, nucleus=nucleus, **settings)
        grid = polar_windows(chosen.layers, chosen.sectors, nucleus_layers=chosen.nucleus_layers)
        return grid.on(disk), disk

    def row(self, windows: WindowsOnCell, disk: DiskMap | None) -> dict[str, Any]:
        row = windows_row(windows, disk) | {"nucleus_area": float(self._fitted[1].sum())}
        if isinstance(windows, InterpolatedRingWindows):
            turned = windows.n_turned_over
            row |= {"flipped": turned, "invalid_maps": int(turned > 0)}
            row |= {"outside": windows.outside, "overlap": windows.overlap}
        names = _compartments(windows)
        row |= compartment_measures(windows, names) | {"outer_fifth": outer_fifth(windows)}
        return row | {"nearness": nearness(windows, names, self._edges)}

    def layers(self, windows: WindowsOnCell, measures: xr.Dataset) -> dict[str, Any]:
        names = _compartments(windows)
        by_layer = windows.areas.mean(axis=1)
        means = np.array([by_layer[names == name].mean() for name in names])
        return {"compartment": names.tolist(), "relative_area": by_layer / means}


def _compartments(windows: Any) -> np.ndarray[Any, Any]:
    return np.asarray(windows.grid.compartments)


@takes(RunOptions)
def compare_opened_nuclei(
    inputs: CellInputs,
    out: str | os.PathLike[str],
    parameters: CompareNucleiParameters,
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> Comparison:
    """Lay windows of several methods that know the nucleus on every cell and measure them.

    Parameters
    ----------
    inputs : CellInputs
        Opened with these parameters, with nuclei.
    out : path-like
        Folder for the results.
    parameters : CompareNucleiParameters
    progress : callable, optional
        Called with (cells done, cells in all).
    **settings
        See `RunOptions`.

    Returns
    -------
    Comparison
        Complete; a cell without a nucleus, or that a method cannot map, has a row with the reason.
    """
    options = RunOptions.of(**settings)
    return compare_every_cell(inputs, out, COMPARED_NUCLEI, compare_nucleus, parameters, options, progress)


def compare_nucleus(task: CellTask, parameters: CompareNucleiParameters, folder: Path) -> Rows:
    """Measure one cell's windows by each method; a fault becomes a row with the reason.

    Parameters
    ----------
    task : CellTask
        With its nucleus.
    parameters : CompareNucleiParameters
    folder : Path
        Of the study; which pixel is in which window is written there.

    Returns
    -------
    list of (row, tables)
        One a method.
    """
    (path,) = windows_files(task, folder)
    nucleus = task.nucleus
    assert nucleus is not None  # these inputs were opened with nuclei
    methods = NucleusMethods(task.found, nucleus.labels, nucleus.refusal("no choice"), parameters)
    return measured_rows(task.found, parameters.methods, methods, path)
