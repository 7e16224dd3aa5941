"""One cell by every method of a comparison: its windows, laid, timed, measured and kept."""

from __future__ import annotations

import time as clock
from abc import ABC, abstractmethod
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from cytodisk.analysis.window_measures import measures_by_layer
from cytodisk.arrays import BoolArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.errors import CytodiskError
from cytodisk.files import replacing
from cytodisk.geometry.mask import MaskReport
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_parts import CellTask, Rows
from cytodisk.runs.compare_windows.compare_tables import layer_columns, method_status, windows_row
from cytodisk.runs.frame_rows import FramePlace
from cytodisk.store.study_folder import part_key
from cytodisk.store.study_kind import MAPS
from cytodisk.windows.on_cell import WindowsOnCell
from cytodisk.windows.pixel_shares.shares import PER_SIDE

_SMALL_PX = 4000  # cells up to here are drawn by parts of pixels


class CellMethods(ABC):
    """What a comparison does with one cell."""

    @abstractmethod
    def lay(self, method: str) -> tuple[WindowsOnCell, DiskMap | None]:
        """Windows of a method, with the map they are on, if any; raises where the cell gives none."""

    @abstractmethod
    def report(self) -> tuple[MaskReport, tuple[str, ...]]:
        """What the mask was changed by, and what else there is to note."""

    def row(self, windows: WindowsOnCell, disk: DiskMap | None) -> dict[str, Any]:
        """What the table of cells says of windows."""
        return windows_row(windows, disk)

    def layers(self, windows: WindowsOnCell, measures: xr.Dataset) -> dict[str, Any]:
        """More columns of the table of layers."""
        return {}

    def drawn(self) -> dict[str, BoolArray]:
        """What is kept beside the windows to draw them, each of the shape of the mask."""
        return {}


def measured_rows(found: SourceCell, names: Sequence[str], methods: CellMethods, path: Path) -> Rows:
    """Measure one cell's windows by each method; a fault becomes a row with the reason.

    Parameters
    ----------
    found : SourceCell
    names : sequence of str
        Of the methods.
    methods : CellMethods
    path : Path
        Which pixel is in which window is written there.

    Returns
    -------
    list of (row, tables)
        One a method.
    """
    rows: Rows = []
    kept: dict[str, Any] = {}
    for name in names:
        place = FramePlace(found.cell, found.frame, found.label, source=found.source)
        row = place.row | {"method": name, "frames": 1}
        started = clock.perf_counter()
        try:
            windows, disk = methods.lay(name)
            _ = windows.weights  # belongs to the time it takes
        except CytodiskError as fault:
            seconds = clock.perf_counter() - started
            gone = {"status": method_status(fault), "reason": str(fault), "mapped": 0, "seconds": seconds}
            rows.append((row | gone, {}))
            continue
        seconds = clock.perf_counter() - started
        report, notes = methods.report()
        row |= methods.row(windows, disk) | {"status": "ok", "reason": "", "mapped": 1, "seconds": seconds}
        row |= {"notes": "; ".join((*report.notes, *notes)), "qc_flags": "; ".join(report.qc_flags)}
        measures = measures_by_layer(windows)
        layers = layer_columns(found.cell, found.frame, name, measures) | methods.layers(windows, measures)
        rows.append((row, {"layers": layers}))
        per_side = PER_SIDE if report.area_px <= _SMALL_PX else 1
        kept[name] = (windows.labels if per_side == 1 else windows.subpixel_labels).astype(np.int32)
        for key, mask in ({"mask": windows.mask_without_holes} | methods.drawn()).items():
            kept[key] = mask.repeat(per_side, axis=0).repeat(per_side, axis=1)
    if kept:
        with replacing(path) as temporary:
            np.savez_compressed(temporary, **kept)
    return rows


def windows_files(task: CellTask, folder: Path) -> list[Path]:
    """The file that says which pixel of a cell is in which window."""
    return [folder / MAPS / f"windows_{part_key(task.found.cell)}.npz"]
