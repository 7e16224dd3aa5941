"""The run that compares windows on the cells of files, with or without their nuclei."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial

from cytodisk.parameters import Parameters
from cytodisk.runs.cells.cell_inputs import CellInputs
from cytodisk.runs.cells.cell_parts import CellRun, Rows
from cytodisk.runs.compare_windows.comparison import Comparison, open_comparison, write_summaries
from cytodisk.runs.compare_windows.measured_methods import windows_files
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import Progress, RunOptions, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.scale import UNKNOWN
from cytodisk.store.study_folder import StudyFolder
from cytodisk.store.study_kind import StudyKind

_CELLS_AT_ONCE = 1


def compare_every_cell(
    inputs: CellInputs,
    out: str | os.PathLike[str],
    kind: StudyKind,
    compare: Callable[..., Rows],
    parameters: Parameters,
    options: RunOptions,
    progress: Progress | None,
) -> Comparison:
    """Measure every cell by each method and write the comparison.

    Parameters
    ----------
    inputs : CellInputs
    out : path-like
        Folder for the results.
    kind : StudyKind
    compare : callable
        Takes (task, parameters, folder) and returns the rows of a cell; can be pickled.
    parameters : Parameters
        Given to `compare`.
    options : RunOptions
    progress : callable or None
        Called with (cells done, cells in all).

    Returns
    -------
    Comparison
        Complete; its warnings name each cell and method that has a reason or a QC flag.
    """

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        one = partial(compare, parameters=parameters, folder=folder.path)
        run = CellRun(inputs, one, _CELLS_AT_ONCE, files=partial(windows_files, folder=folder.path))
        keys = run.fill(folder, options.workers, progress or silent)
        warnings = [
            f"cell {row['cell']}, {row['method']}: {words}"
            for row in folder.read_rows(keys)
            if (words := row["reason"] or row.get("qc_flags"))
        ]
        return keys, warnings

    provenance = describe_run(inputs.paths, parameters, inputs.understood, UNKNOWN, inputs.notes)
    run = StudyRun(kind, provenance, parameters, options)
    return run.into(out, work, open_comparison, write_summaries)
