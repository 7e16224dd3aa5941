"""A run over all cells of a mask file, or of a folder of them: `cytodisk map` and the same from Python."""

from __future__ import annotations

import os
import sys
from functools import partial
from typing import Any

from cytodisk.images.mask_names import without_name
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_parts import CellRun
from cytodisk.runs.cells.nucleus_rows import nuclei_warnings
from cytodisk.runs.depth_layers import check_depths
from cytodisk.runs.flagged_cells import fill_cells
from cytodisk.runs.map.map_kind import MAP
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.map.map_work import DrawCell, MapWork
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import MapOptions, Progress, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.store.study import Study, open_study
from cytodisk.store.study_folder import StudyFolder
from cytodisk.taking import takes
from cytodisk.windows.grid_parameters import PolarGridParameters
from cytodisk.windows.polar_windows import polar_grid

_CELLS_AT_ONCE = 8  # of one image, which go to a worker and into a file together


@takes(MapOptions)
def map_study(
    inputs: CellInputs,
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
    inputs : CellInputs
        As `open_inputs` returns it.
    out : path-like
        Folder of the study.
    draw : callable, optional
        Draws a cell's figures: (folder, name, windows, signal, heading) → paths.
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
    check_depths(polar_grid(inputs.parameters.part(PolarGridParameters)), inputs.scale)
    provenance = describe_run(
        inputs.paths, inputs.parameters, inputs.understood, inputs.scale, inputs.notes, inputs.given
    )

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        parameters = inputs.parameters.part(MapParameters)
        maker = MapWork(parameters, inputs.scale, folder.for_workers(), draw, options.maps, options.geojson)
        at_most = 0 if draw is None else sys.maxsize if draw_at_most is None else draw_at_most
        keys = CellRun(inputs, maker, _CELLS_AT_ONCE, at_most, maker.files).fill(
            folder, options.workers, progress or silent
        )
        rows = folder.read_rows(keys)
        warnings = [words for row in rows if (words := _warning(row, inputs.is_folder))]
        return keys, [*inputs.remarks, *nuclei_warnings(folder, keys), *warnings]

    kind = MAP.with_nuclei.with_channels(inputs.channels) if inputs.nuclei else MAP
    kind = kind if inputs.groups is None else inputs.groups.kind(kind)
    run = StudyRun(kind, provenance, inputs.parameters, options, options.writes)
    return run.into(out, work, open_study, partial(fill_cells, groups=inputs.groups))


def _warning(row: dict[str, Any], of_many: bool) -> str:
    words = row["reason"] or row.get("mask_remarks")
    if not words:
        return ""
    if not of_many:
        return f"cell {row['cell']}: {words}"
    place = f"cell {row['cell']} of {row['source']}" if row["label"] else row["source"]
    return f"{place}: {without_name(words, row['source'])}"
