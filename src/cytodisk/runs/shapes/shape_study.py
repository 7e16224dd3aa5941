"""A run over the shapes of all cells of a mask file or folder: `cytodisk shapes` and the same from Python."""

from __future__ import annotations

import os
from collections.abc import Collection
from functools import partial
from typing import Any

import pandas as pd

from cytodisk.analysis.shape.complexity import why_unscored
from cytodisk.analysis.shape.features import TOO_SMALL, shape_row, split_qc_flags
from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.arrays import BoolArray
from cytodisk.errors import ReadError
from cytodisk.geometry.mask import clean_mask
from cytodisk.geometry.mask_parameters import Holes
from cytodisk.images.mask_files import list_images
from cytodisk.runs.cells.cell_groups import with_groups
from cytodisk.runs.cells.cell_inputs import CellInputs, open_inputs
from cytodisk.runs.cells.cell_parameters import FileParameters
from cytodisk.runs.cells.cell_parts import CellRun, CellTask, Rows
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import Progress, RunOptions, silent
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.shapes.shape_tables import (
    SHAPE_NAMES,
    SHAPE_STUDY,
    open_shapes,
    shape_table,
    with_own,
    write_shape_texts,
    write_shapes,
)
from cytodisk.runs.study_run import StudyRun
from cytodisk.runs.versions import installed
from cytodisk.scale import Scale
from cytodisk.store.study_folder import StudyFolder
from cytodisk.taking import takes

CELLS_AT_ONCE = 32  # of one image, which go to a worker and into a file together: about a second's work
_LAYOUT = (
    "umap-learn",
    "scikit-learn",
    "pynndescent",
)  # packages that the score depends on beside the others


def open_shape_inputs(
    masks: str | os.PathLike[str],
    parameters: ShapeParameters,
    groups: str | os.PathLike[str] | None = None,
) -> CellInputs:
    """Open the files of a run.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks or a label image, or a folder of those; see `open_mask_files`.
    parameters : ShapeParameters
    groups : path-like, optional
        What was done to which cell; see `read_groups`.

    Returns
    -------
    CellInputs
        In a folder, a file that cannot be used is kept with its fault.

    Raises
    ------
    ReadError, MaskError, ParameterError
        The masks cannot be used at all, or the table of groups cannot.
    """
    inputs = with_groups(open_inputs(masks, None, parameters.part(FileParameters)), groups)
    if inputs.groups is not None:
        inputs.groups.refuse(SHAPE_NAMES)
    return inputs


@takes(RunOptions)
def shape_study(
    inputs: CellInputs,
    out: str | os.PathLike[str],
    parameters: ShapeParameters | None = None,
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> pd.DataFrame:
    """Measure the shape of every cell, score its complexity, and write a study.

    Parameters
    ----------
    inputs : CellInputs
        As `open_shape_inputs` returns it.
    out : path-like
        Folder for the results.
    parameters : ShapeParameters, optional
    progress : callable, optional
        Called with (cells done, cells in all) at the start and after every few cells.
    **settings
        See `RunOptions`.

    Returns
    -------
    DataFrame
        The content of `shapes.parquet`. A cell that could not be measured has a row with the reason. Without
        umap-learn the features are there and the complexity is NaN.

    Raises
    ------
    ParameterError
        `workers` is below 1, or both `resume` and `overwrite` are set.
    StudyError
        The folder cannot be used.
    """
    options = RunOptions.of(**settings)
    parameters = ShapeParameters() if parameters is None else parameters

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        measure = partial(measure_shape, scale=inputs.scale, holes=parameters.holes)
        keys = CellRun(inputs, measure, CELLS_AT_ONCE).fill(folder, options.workers, progress or silent)
        table = shape_table(folder.read_rows(keys), inputs.scale, parameters.part(ScoreParameters))
        write_shapes(with_own(table, inputs.groups), folder.path)
        return keys, [*inputs.remarks, *_warnings(table)]

    kind = SHAPE_STUDY if inputs.groups is None else inputs.groups.kind(SHAPE_STUDY)
    run = StudyRun(kind, _describe(inputs, parameters), parameters, options)
    return run.into(out, work, open_shapes, partial(write_shape_texts, groups=inputs.groups))


def _describe(inputs: CellInputs, parameters: ShapeParameters) -> dict[str, Any]:
    provenance = describe_run(inputs.paths, parameters, inputs.understood, inputs.scale, inputs.notes)
    packages = installed(_LAYOUT)
    provenance["fingerprint"] |= {"run": "shapes"}
    provenance["fingerprint"]["packages"] |= packages
    provenance["versions"] |= packages
    return provenance


def measure_shape(task: CellTask, scale: Scale, holes: Holes = "fill") -> Rows:
    """Measure the shape of a cell.

    Parameters
    ----------
    task : CellTask
    scale : Scale
    holes : {"fill", "exclude", "error"}
        See `shape_features`.

    Returns
    -------
    list of (row, tables)
        One row: where the cell comes from, its status and its features.
    """
    found = task.found
    place = {"cell": found.cell, "source": found.source, "frame": found.frame, "label": found.label}
    if found.fault is None:
        return [(place | shape_row(found.mask, scale, holes), {})]
    status = "unreadable" if isinstance(found.fault, ReadError) else "refused"
    words = {"status": status, "reason": str(found.fault), "notes": "", "qc_flags": ""}
    return [(place | words | {"touches_border": False}, {})]


def _warnings(table: pd.DataFrame) -> list[str]:
    small, qc_flags = split_qc_flags(table["qc_flags"])
    words = table["reason"].where(table["reason"] != "", qc_flags)
    warnings = [
        f"cell {cell} of {source}: {text}"
        for cell, source, text in zip(table["cell"], table["source"], words, strict=True)
        if text
    ]
    if small.any():
        warnings.append(f"{small.sum()} of {len(table)} cells are {TOO_SMALL}: see their QC flags")
    if reason := why_unscored(table):
        warnings.append(f"no complexity: {reason}")
    return warnings


def cleaned_masks(inputs: CellInputs, cells: Collection[int]) -> dict[int, BoolArray]:
    """The cleaned masks of some cells, each in its crop, such as for pictures.

    Parameters
    ----------
    inputs : CellInputs
    cells : collection of int
        Cells that could be measured.

    Returns
    -------
    dict of int to ndarray of shape (h, w) and dtype bool
    """
    wanted = set(cells)
    images = (
        image
        for image in list_images(inputs.sources)
        if not wanted.isdisjoint(range(image.first_cell, image.first_cell + image.n_cells))
    )
    return {
        found.cell: clean_mask(found.mask)[0]
        for image in images
        for found in image.cells()
        if found.cell in wanted
    }
