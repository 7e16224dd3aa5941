"""What a run of `cytodisk map` does with one cell: map it, sample it, and write its map."""

from __future__ import annotations

import json
import math
import time as clock
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import xarray as xr

from cytodisk.arrays import FloatArray
from cytodisk.disk.disk_map import DiskMap
from cytodisk.disk.mapping import map_cell
from cytodisk.disk.mapping_parameters import MappingParameters
from cytodisk.disk.nucleus.nucleus_parameters import NucleusParameters
from cytodisk.errors import CytodiskError
from cytodisk.files import replacing, writing_to
from cytodisk.images.frame_pixels import WHOLE_BYTES
from cytodisk.images.mask_files import SourceCell
from cytodisk.runs.cells.cell_nuclei import CellNucleus
from cytodisk.runs.cells.cell_parts import CellTask, Rows
from cytodisk.runs.cells.nucleus_rows import nuclei_table, nucleus_columns
from cytodisk.runs.cells.plain_rows import with_nucleus_rows
from cytodisk.runs.frame_rows import FramePlace, cell_status, measure_windows
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.scale import Scale
from cytodisk.store.study_folder import StudyFolder, part_key
from cytodisk.store.study_kind import FIGURES
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.polar_windows import CellWindows, PolarGrid, polar_grid

DrawCell: TypeAlias = Callable[[Path, str, CellWindows, xr.DataArray | None, str], list[Path]]


@dataclass(frozen=True)
class MapWork:
    """Maps and samples a cell; the same for all cells of a run.

    Attributes
    ----------
    parameters : MapParameters
    scale : Scale
    folder : StudyFolder
        Where maps go.
    draw : callable, optional
        As `run_map` takes it; its attribute `formats`, if it has one, tells the endings of its figures, which
        else is png.
    maps, geojson : bool
        Whether maps, and outlines of windows, are written.
    """

    parameters: MapParameters
    scale: Scale
    folder: StudyFolder
    draw: DrawCell | None
    maps: bool
    geojson: bool

    def __call__(self, task: CellTask) -> Rows:
        """Rows of one cell; a fault of its input becomes a row with the reason."""
        started = clock.perf_counter()
        found = task.found
        place = FramePlace(found.cell, found.frame, found.label, source=found.source)
        nucleus, tables = task.nucleus, nuclei_table(found, task.nucleus)
        fault = found.fault or task.fault
        if fault is None and nucleus is not None:
            fault = nucleus.refusal(self.parameters.missing)
        if fault is None:
            try:
                disk = self._map(found, nucleus)
                windows = (self._plain_grid if disk.nucleus is None else self._grid).on(disk)
            except CytodiskError as error:
                fault = error
        if fault is not None:
            row = place.row | nucleus_columns(nucleus)
            row |= {"status": cell_status(fault), "reason": str(fault)} | _seconds(started)
            return [(row, tables)]
        row, columns = measure_windows(place, windows, task.signal, self.parameters.nan, found.corner)
        self._write(found, windows, columns)
        row |= nucleus_columns(nucleus, None if disk.nucleus is None else disk.nucleus.report)
        row |= {"status": "ok", "reason": ""} | _seconds(started)
        if task.drawn and self.draw is not None:
            self._draw(self.draw, task, windows)
        if nucleus is not None and disk.nucleus is None:
            columns = with_nucleus_rows(columns, self._grid)
        return [(row, tables | {"windows": columns})]

    def files(self, task: CellTask) -> list[Path]:
        """Files that a cell may have: its map, outlines of windows, its figure."""
        path = self.folder.map_path(part_key(task.found.cell))
        wanted = {path: self.maps, path.with_suffix(".geojson"): self.geojson}
        for kind in getattr(self.draw, "formats", ("png",)):
            figure = self.folder.path / FIGURES / f"{path.stem}.{kind}"
            wanted[figure] = task.drawn and self.draw is not None
        return [file for file, is_wanted in wanted.items() if is_wanted]

    def _draw(self, draw: DrawCell, task: CellTask, windows: CellWindows) -> None:
        found, image, (y, x) = task.found, None, task.found.corner
        disk = windows.disk
        if task.image is not None:
            image = task.image.named.astype(np.float64)
            _, height, width = image.shape
            disk = disk.placed((y - task.image_corner[0], x - task.image_corner[1]), (height, width))
        elif math.prod(found.image_shape) <= WHOLE_BYTES:
            disk = disk.placed((y, x), found.image_shape)
        placed = CellWindows(windows.grid, disk)
        folder = self.folder.path / FIGURES
        with writing_to(folder):
            folder.mkdir(exist_ok=True)
        where = [found.source, *([f"frame {found.frame}"] if found.frame else []), f"label {found.label}"]
        draw(folder, f"cell_{found.cell:05d}", placed, image, f"{', '.join(where)} (cell {found.cell})")

    def _map(self, found: SourceCell, nucleus: CellNucleus | None) -> DiskMap:
        mapping = self._mapping
        if isinstance(mapping.align, tuple):  # a place in the image
            (y, x), (row, column) = mapping.align, found.corner
            mapping = mapping.changed(align=(y - row, x - column))
        labels = None if nucleus is None else nucleus.labels
        scale = Scale(self.scale.pixel_size_um)
        return map_cell(found.mask, mapping, scale, labels, self._of_nucleus)

    @cached_property
    def _mapping(self) -> MappingParameters:
        return self.parameters.part(MappingParameters)

    @cached_property
    def _of_nucleus(self) -> NucleusParameters:
        return self.parameters.part(NucleusParameters)

    @cached_property
    def _grid(self) -> PolarGrid:
        return polar_grid(self.parameters.part(PolarGridParameters))

    @cached_property
    def _plain_grid(self) -> PolarGrid:
        """For cells that are mapped without a nucleus."""
        return polar_grid(self.parameters.part(PolarGridParameters).changed(nucleus_layers=None))

    def _write(self, found: SourceCell, windows: CellWindows, columns: dict[str, Any]) -> None:
        """Write the map and the outlines, in pixels of the whole image."""
        path = self.folder.map_path(part_key(found.cell))
        if self.maps:
            windows.disk.placed(found.corner, found.image_shape).save(path)
        if self.geojson:
            means = _means(columns, windows)
            outlines = windows.geojson(means, cell=f"cell {found.cell}", corner=found.corner)
            with replacing(path.with_suffix(".geojson")) as temporary:
                temporary.write_text(json.dumps(outlines, ensure_ascii=False), encoding="utf-8")


def _means(columns: dict[str, Any], windows: CellWindows) -> dict[str, FloatArray]:
    """The mean of each channel in the windows, with its unit, from columns of the table of windows."""
    channels = [name for name in dict.fromkeys(columns["channel"]) if name is not None]
    means = np.reshape(columns["mean"], (-1, *windows.areas.shape))
    return {f"mean {name} a.u.": mean for name, mean in zip(channels, means, strict=False)}


def _seconds(started: float) -> dict[str, Any]:
    return {"seconds": clock.perf_counter() - started}
