"""The cells of a population's study as a file for scanpy."""

from __future__ import annotations

import os
import warnings
from pathlib import Path

from cytodisk.errors import PopulationWarning
from cytodisk.population.anndata_table import require_anndata, write_h5ad
from cytodisk.runs.population.opening.found_studies import Paths
from cytodisk.runs.population.population_at_hand import population_at_hand
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.store.provenance_file import read_provenance
from cytodisk.store.written_files import lost_files, recorded, writing_files

H5AD = "population.h5ad"


def refuse_without_anndata(wanted: bool) -> None:
    """Raise MissingPartError, before anything is computed, if the file is wanted and cannot be written."""
    if wanted:
        require_anndata()


def keep_h5ad(
    study: Path, path: Paths, groups: str | os.PathLike[str] | None, parameters: PopulationParameters
) -> Path:
    """Write the cells that were compared, normalised and turned, into the study, unless they are there.

    Parameters
    ----------
    study : Path
    path, groups, parameters
        As of `run_population`.

    Returns
    -------
    Path

    Raises
    ------
    MissingPartError
        anndata is not installed.
    StudyError
        A file of this name is there which is not the study's, or the folder cannot be written.
    """
    mark = recorded(read_provenance(study) or {}).get(H5AD, "")
    if not mark or lost_files(study, {H5AD: mark}):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", PopulationWarning)  # the run has said them
            population = population_at_hand(path, groups, parameters)
        with writing_files(study, H5AD):
            write_h5ad(population, study / H5AD)
    return study / H5AD
