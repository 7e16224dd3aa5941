"""The files that a population is made of, by which a run knows whether they are the same."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from cytodisk.runs.batch.input_row import STUDIES
from cytodisk.runs.population.movies.summary_names import OF_CORRELATIONS, OF_PREDICTIONS, OF_WAVES
from cytodisk.runs.population.opening.found_studies import FoundStudy, Paths, find_studies
from cytodisk.store.correlation_store import CORRELATION
from cytodisk.store.predictions.prediction_store import PREDICTION
from cytodisk.store.study_kind import ACTIVITY
from cytodisk.store.waves.waves_store import WAVES
from cytodisk.store.written_files import recorded

_FOLDERS = {OF_CORRELATIONS: CORRELATION, OF_PREDICTIONS: PREDICTION, OF_WAVES: WAVES}
_INPUTS = "inputs.parquet"


def population_inputs(
    path: Paths, groups: str | os.PathLike[str] | None, summary: str
) -> dict[str, Path | list[Path]]:
    """The files that a run reads, by role.

    Parameters
    ----------
    path : path-like, or sequence of path-like
        See `open_population`.
    groups : path-like or None
        Table of groups.
    summary : str
        What a movie contributes.

    Returns
    -------
    dict of str to Path or list of Path
        "studies", and "groups" where there is such a table.

    Raises
    ------
    PopulationError
        There is no study.
    """
    studies, _ = find_studies(path)
    files = [file for study in studies for file in _tables_of(study, summary)]
    batches = {study.folder.parent.parent for study in studies if study.folder.parent.name == STUDIES}
    files += [folder / _INPUTS for folder in sorted(batches) if (folder / _INPUTS).exists()]
    found: dict[str, Path | list[Path]] = {"studies": [file.absolute() for file in files]}
    return found if groups is None else found | {"groups": Path(groups)}


def _tables_of(study: FoundStudy, summary: str) -> Sequence[Path]:
    """Tables and arrays of a study, not its figures and maps."""
    names = sorted(recorded(study.provenance))
    own = [name for name in names if "/" not in name and (name.endswith(".parquet") or name == ACTIVITY)]
    for folder in (folder for summaries, folder in _FOLDERS.items() if summary in summaries):
        own += [name for name in names if name.startswith(f"{folder}/") and name.endswith(".parquet")]
    return [study.folder / name for name in own]
