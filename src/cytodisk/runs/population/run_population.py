"""`cytodisk population` as a function."""

from __future__ import annotations

import os
import warnings
from typing import Any

from cytodisk.errors import PopulationWarning
from cytodisk.population.population import Population
from cytodisk.runs.population.opening.found_studies import Paths
from cytodisk.runs.population.opening.shape_population import NOTES
from cytodisk.runs.population.population_at_hand import opened_population
from cytodisk.runs.population.population_h5ad import keep_h5ad, refuse_without_anndata
from cytodisk.runs.population.population_inputs import population_inputs
from cytodisk.runs.population.population_kind import POPULATION, with_tables_of
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.runs.population.population_work import PopulationResult, population_result
from cytodisk.runs.provenance import describe_run
from cytodisk.runs.run_options import PopulationOptions, Progress, silent
from cytodisk.runs.study_run import StudyRun
from cytodisk.scale import Scale
from cytodisk.store.populations.population_study import PopulationStudy, open_population_study
from cytodisk.store.populations.population_writing import (
    MORE,
    write_population_columns,
    write_population_table,
)
from cytodisk.store.study_folder import StudyFolder
from cytodisk.taking import takes

_OPENED = 40  # percents of the work, when the studies are read


@takes(PopulationParameters, PopulationOptions)
def run_population(
    path: Paths,
    out: str | os.PathLike[str],
    *,
    groups: str | os.PathLike[str] | None = None,
    progress: Progress | None = None,
    parameters: PopulationParameters | None = None,
    **settings: Any,
) -> PopulationStudy:
    """Compare conditions over the cells of studies, and write a study: `cytodisk population`.

    Parameters
    ----------
    path : path-like, or sequence of path-like
        What `cytodisk batch`, `map`, `movie` or `shapes` wrote, or a folder of such studies; see
        `open_population`.
    out : path-like
        Folder for the results.
    groups : path-like, optional
        Table with the condition and the experiment of each file or cell.
    progress : callable, optional
        Called with (percents done, 100).
    parameters : PopulationParameters, optional
        All parameters together; those that are given by name overrule them.
    **settings
        See `PopulationParameters` and `PopulationOptions`.

    Returns
    -------
    PopulationStudy

    Raises
    ------
    PopulationError
        The studies do not go together, or a condition, channel or column is not there.
    ReadError, ParameterError
        A table is damaged, or a parameter is unknown or out of its range.
    StudyError
        The folder cannot be used.
    MissingPartError
        A file for scanpy is wanted and anndata is not installed.

    See Also
    --------
    compare_conditions : Compares conditions of a population in memory.
    open_population_study : Read the results later.
    population_power : Plan how many experiments to do.

    Examples
    --------
    >>> import cytodisk as cd
    >>> made = cd.simulate.population_images("images", experiments=2, cells=2)
    >>> _ = cd.run_map(made.masks, "maps", signal=made.images, layers=3, sectors=6)
    >>> found = cd.run_population("maps", "atlas", groups=made.groups)
    >>> found.conditions, len(found.cells)
    (('control', 'drug'), 8)
    """
    options, values = PopulationOptions.split(settings, PopulationParameters)
    chosen = PopulationParameters.chosen(parameters, values)
    refuse_without_anndata(options.h5ad)
    report = progress or silent
    inputs = population_inputs(path, groups, chosen.summary)
    read_as = {"studies": "tables of studies", "groups": "table of groups"}
    provenance = describe_run(inputs, chosen, {role: read_as[role] for role in inputs}, Scale())

    found: list[tuple[PopulationResult, list[str]]] = []

    def prepare() -> None:
        report(0, 100)
        population, notes = _opened(path, groups, chosen)
        report(_OPENED, 100)
        result = population_result(
            population, chosen, lambda share: report(_OPENED + int(share * (100 - _OPENED)), 100)
        )
        found.append((result, notes))

    def work(folder: StudyFolder) -> tuple[list[str], list[str]]:
        result, notes = found.pop()
        write_result(folder, result)
        return [], notes

    run = StudyRun(POPULATION, provenance, chosen, options)
    study = run.into(out, work, open_population_study, write_population_columns, prepare)
    if options.h5ad:
        keep_h5ad(study.path, path, groups, chosen)
        study = open_population_study(study.path)
    return study


def write_result(folder: StudyFolder, result: PopulationResult) -> None:
    """Write all tables of a population, and note what they are about.

    Parameters
    ----------
    folder : StudyFolder
    result : PopulationResult
    """
    folder.kind = with_tables_of(folder.kind, curves=bool(result.notes["curves"]))
    folder.provenance |= result.notes
    folder.note(MORE, [(column.name, column.unit, column.meaning) for column in result.more.values()])
    for name, table in result.tables.items():
        write_population_table(folder, name, table, result.more if name == "cells" else None)


def _opened(
    path: Paths, groups: str | os.PathLike[str] | None, chosen: PopulationParameters
) -> tuple[Population, list[str]]:
    """The population, and what its studies differ in."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", PopulationWarning)
        population = opened_population(path, groups, chosen)
    for one in caught:
        if not issubclass(one.category, PopulationWarning):
            warnings.warn_explicit(one.message, one.category, one.filename, one.lineno)
    return population, [str(note) for note in population.cells.attrs.get(NOTES, [])]
