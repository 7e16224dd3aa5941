"""A run over all cells of a mask file, or of a folder of them: `cytodisk map` and the same from Python."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import xarray as xr

from cytodisk.errors import CytodiskError, ReadError, as_data
from cytodisk.geometry.mask import MaskReport, clean_mask
from cytodisk.images.mask_files import SourceCell, read_source_cells
from cytodisk.images.mask_names import without_name
from cytodisk.runs.cell_rows import CellSettings, CellTask, DrawCell, measure_part, status_of
from cytodisk.runs.executor import Executor
from cytodisk.runs.map.map_inputs import MapInputs
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.parameters_file import write_parameters
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import MapOptions
from cytodisk.runs.steps import Progress, finish_run, silent
from cytodisk.store.study import Study, open_study
from cytodisk.store.study_folder import MAP_TABLES, PARAMETERS, StudyFolder, alone_in, part_key
from cytodisk.taking import takes

_CELLS_PER_PART = 8  # of one image, which go to a worker and into a file together


@takes(MapOptions)
def map_study(
    inputs: MapInputs,
    out: str | os.PathLike[str],
    *,
    draw: DrawCell | None = None,
    draw_at_most: int | None = None,
    progress: Progress | None = None,
    **settings: Any,
) -> Study:
    """Map and sample every cell, and write a study.

    Parameters
    ----------
    inputs : MapInputs
        As `open_inputs` returns it.
    out : path-like
        Folder of the study.
    draw : callable, optional
        Draws a cell's figures: (folder, name, windows, signal, scale) → paths.
    draw_at_most : int, optional
        How many cells, from the first, to draw.
    progress : callable, optional
        Called with (cells done, cells in all) at the start and after every few cells.
    **settings
        See `MapOptions`.

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
    options = MapOptions.of(**settings)
    provenance = describe_run(inputs.paths, inputs.parameters, inputs.understood, inputs.pixel_size_um)
    with alone_in(out):
        if options.resume and StudyFolder.is_complete(out, provenance):
            return open_study(out)
        folder = StudyFolder.start(out, provenance, MAP_TABLES, **options.again)
        write_parameters(inputs.parameters, folder.path / PARAMETERS)
        parts = {_key(part): len(part) for part in _parts(read_source_cells(inputs.sources))}
        pending = {key for key in parts if not folder.has(key)}
        at_most = 0 if draw is None else sum(parts.values()) if draw_at_most is None else draw_at_most
        how = CellSettings(
            inputs.parameters.part(MapParameters),
            inputs.pixel_size_um,
            folder.for_workers(),
            draw,
            options.maps,
            options.geojson,
        )
        report = progress or silent
        done = sum(size for key, size in parts.items() if key not in pending)
        report(done, sum(parts.values()))
        tasks = _tasks(inputs, pending, at_most)
        measure = partial(measure_part, settings=how)
        with Executor(min(options.workers, max(1, len(pending)))) as executor:
            for size in executor.each(measure, tasks):
                done += size
                report(done, sum(parts.values()))
        warnings = [*inputs.remarks]
        warnings += [words for row in folder.read_rows(parts) if (words := _warning(row, inputs.is_folder))]
        finish_run(folder, list(parts), warnings)
        return open_study(folder.path)


def _warning(row: dict[str, Any], of_many: bool) -> str:
    words = row["reason"] or row.get("qc_flags")
    if not words:
        return ""
    if not of_many:
        return f"cell {row['cell']}: {words}"
    place = f"cell {row['cell']} of {row['source']}" if row["label"] else row["source"]
    return f"{place}: {without_name(words, row['source'])}"


def _parts(cells: Iterable[SourceCell]) -> Iterator[list[SourceCell]]:
    """Cells of one image, a few at a time: always the same ones, so that a stopped run can go on."""
    part: list[SourceCell] = []
    for found in cells:
        other_image = part and (part[0].source, part[0].frame) != (found.source, found.frame)
        if other_image or len(part) == _CELLS_PER_PART:
            yield part
            part = []
        part.append(found)
    if part:
        yield part


def _key(part: Sequence[SourceCell]) -> str:
    return part_key(part[0].cell)


def _tasks(inputs: MapInputs, pending: set[str], draw_at_most: int) -> Iterator[list[CellTask]]:
    image, fault, shown = None, None, ("", -1)
    for part in _parts(read_source_cells(inputs.sources)):
        if _key(part) not in pending:
            continue
        if shown != (part[0].source, part[0].frame):
            shown = part[0].source, part[0].frame
            image, fault = _signal_at(inputs, *shown)
        yield [_task(found, image, fault, found.cell < draw_at_most) for found in part]


def _task(
    found: SourceCell, image: xr.DataArray | None, fault: CytodiskError | None, drawn: bool
) -> CellTask:
    if image is None or found.mask is None:
        return CellTask(found, None, fault, None, drawn)
    (y, x), (height, width) = found.corner, found.mask.shape
    # A copy, so that a waiting cell does not hold its whole image.
    signal = image[:, y : y + height, x : x + width].copy()
    return CellTask(found, signal, fault, image if drawn else None, drawn)


def _signal_at(
    inputs: MapInputs, source: str, frame: int
) -> tuple[xr.DataArray | None, CytodiskError | None]:
    signal = inputs.signals[source]
    if signal.file is None:
        return None, signal.fault
    try:
        values = signal.file.frame(min(frame, signal.file.n_frames - 1))
    except ReadError as error:
        return None, as_data(error)
    coords = {"channel": list(signal.file.channels)}
    return xr.DataArray(values, dims=("channel", "y", "x"), coords=coords), None


@dataclass(frozen=True)
class CheckedCell:
    """What a look at a mask says.

    Attributes
    ----------
    found : SourceCell
    status : str
        "ok", or as `status_of` calls the fault.
    reason : str
        Why it cannot be used; empty if it can.
    report : MaskReport or None
        What cleaning would change, and what speaks against this being the mask of one cell.
    """

    found: SourceCell
    status: str
    reason: str
    report: MaskReport | None


def check_cells(inputs: MapInputs) -> Iterator[CheckedCell]:
    """Look at every mask without mapping it.

    Parameters
    ----------
    inputs : MapInputs

    Yields
    ------
    CheckedCell
    """
    for found in read_source_cells(inputs.sources):
        fault = found.fault or inputs.signals[found.source].fault
        if fault is None:
            try:
                _, report = clean_mask(found.mask)
                yield CheckedCell(replace(found, mask=None), "ok", "", report)
                continue
            except CytodiskError as error:
                fault = error
        yield CheckedCell(replace(found, mask=None), status_of(fault), str(fault), None)
