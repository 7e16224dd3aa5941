"""A run over the shapes of all cells of a mask file or folder: `cytodisk shapes` and the same from Python."""

from __future__ import annotations

import os
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import partial
from itertools import islice
from typing import Any

import pandas as pd

from cytodisk.analysis.shape.complexity import why_unscored
from cytodisk.analysis.shape.features import TOO_SMALL, shape_row, split_qc_flags
from cytodisk.analysis.shape.score_parameters import ScoreParameters
from cytodisk.arrays import BoolArray
from cytodisk.errors import ReadError
from cytodisk.geometry.mask import clean_mask
from cytodisk.images.mask_files import SourceCell, read_source_cells
from cytodisk.runs.executor import Executor
from cytodisk.runs.map.map_inputs import MapInputs, open_inputs
from cytodisk.runs.map.map_parameters import FileParameters
from cytodisk.runs.parameters_file import write_parameters
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import RunOptions
from cytodisk.runs.shapes.shape_parameters import ShapeParameters
from cytodisk.runs.shapes.shape_tables import SHAPE_TABLES, open_shapes, shape_table, write_shapes
from cytodisk.runs.steps import Progress, finish_run, silent
from cytodisk.runs.versions import installed
from cytodisk.store.study_folder import MAPS, PARAMETERS, StudyFolder, alone_in, part_key
from cytodisk.taking import takes

CELLS_PER_PART = 32  # which go to a worker and into a file together: about a second's work
_LAYOUT = (
    "umap-learn",
    "scikit-learn",
    "pynndescent",
)  # packages that the score depends on beside the others


def open_shape_inputs(masks: str | os.PathLike[str], parameters: ShapeParameters) -> MapInputs:
    """Open the files of a run.

    Parameters
    ----------
    masks : path-like
        One mask, a stack of masks or a label image, or a folder of those; see `open_mask_files`.
    parameters : ShapeParameters

    Returns
    -------
    MapInputs
        In a folder, a file that cannot be used is kept with its fault.

    Raises
    ------
    ReadError, MaskError
        The masks cannot be used at all.
    """
    return open_inputs(masks, None, parameters.part(FileParameters))


@takes(RunOptions)
def shape_study(
    inputs: MapInputs,
    out: str | os.PathLike[str],
    parameters: ShapeParameters | None = None,
    *,
    progress: Progress | None = None,
    **settings: Any,
) -> pd.DataFrame:
    """Measure the shape of every cell, score its complexity, and write a study.

    Parameters
    ----------
    inputs : MapInputs
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
    provenance = _describe(inputs, parameters)
    with alone_in(out):
        if options.resume and StudyFolder.is_complete(out, provenance):
            return open_shapes(out)
        folder = StudyFolder.start(out, provenance, SHAPE_TABLES, **options.again)
        write_parameters(parameters, folder.path / PARAMETERS)
        keys = _measure_all(inputs, folder, options.workers, progress)
        table = shape_table(
            folder.read_rows(keys),
            inputs.pixel_size_um,
            parameters.part(ScoreParameters),
        )
        write_shapes(table, folder.path)
        finish_run(folder, keys, [*inputs.remarks, *_warnings(table)])
        if not any((folder.path / MAPS).iterdir()):
            (folder.path / MAPS).rmdir()  # no cell has a map
    return table


def _describe(inputs: MapInputs, parameters: ShapeParameters) -> dict[str, Any]:
    provenance = describe_run(inputs.paths, parameters, inputs.understood, inputs.pixel_size_um)
    packages = installed(_LAYOUT)
    provenance["fingerprint"] |= {"run": "shapes"}
    provenance["fingerprint"]["packages"] |= packages
    provenance["versions"] |= packages
    return provenance | {"run": "shapes"}


def _measure_all(
    inputs: MapInputs, folder: StudyFolder, workers: int, progress: Progress | None
) -> list[str]:
    """Measure what is not measured yet; the keys of all parts."""
    sizes = {_key(part): len(part) for part in _parts(read_source_cells(inputs.sources))}
    pending = {key for key in sizes if not folder.has(key)}
    done, total = sum(size for key, size in sizes.items() if key not in pending), sum(sizes.values())
    report = progress or silent
    report(done, total)
    parts = (part for part in _parts(read_source_cells(inputs.sources)) if _key(part) in pending)
    measure = partial(measure_shapes, pixel_size_um=inputs.pixel_size_um)
    with Executor(min(workers, max(1, len(pending)))) as executor:
        for rows in executor.each(measure, parts):
            folder.add_cells(part_key(rows[0]["cell"]), [(row, {}) for row in rows])
            done += len(rows)
            report(done, total)
    return list(sizes)


def _parts(cells: Iterable[SourceCell]) -> Iterator[list[SourceCell]]:
    """A few cells at a time: always the same ones, so that a stopped run can go on."""
    rest = iter(cells)
    while part := list(islice(rest, CELLS_PER_PART)):
        yield part


def _key(part: Sequence[SourceCell]) -> str:
    return part_key(part[0].cell)


def measure_shapes(cells: Sequence[SourceCell], pixel_size_um: float | None) -> list[dict[str, Any]]:
    """Measure the shape of a few cells.

    Parameters
    ----------
    cells : sequence of SourceCell
    pixel_size_um : float or None

    Returns
    -------
    list of dict
        For each cell where it comes from, its status and its features.
    """
    rows = []
    for found in cells:
        place = {"cell": found.cell, "source": found.source, "frame": found.frame, "label": found.label}
        if found.fault is None:
            measured = shape_row(found.mask, pixel_size_um)
        else:
            status = "unreadable" if isinstance(found.fault, ReadError) else "refused"
            measured = {"status": status, "reason": str(found.fault), "notes": "", "qc_flags": ""}
            measured["touches_border"] = False
        rows.append(place | measured)
    return rows


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


def cleaned_masks(inputs: MapInputs, cells: Collection[int]) -> dict[int, BoolArray]:
    """The cleaned masks of some cells, each in its crop, such as for pictures.

    Parameters
    ----------
    inputs : MapInputs
    cells : collection of int
        Cells that could be measured.

    Returns
    -------
    dict of int to ndarray of shape (h, w) and dtype bool
    """
    wanted = set(cells)
    return {
        found.cell: clean_mask(found.mask)[0]
        for found in read_source_cells(inputs.sources)
        if found.cell in wanted
    }
