"""Where the figures of a study stand."""

from __future__ import annotations

from pathlib import Path

from cytodisk.errors import WriteError
from cytodisk.store.provenance_file import record_files
from cytodisk.store.study_kind import FIGURES


def figures_folder(study: Path, *names: str) -> Path:
    """The folder for the figures of a study, which is made; their names are noted as the study's.

    Parameters
    ----------
    study : Path
        Folder of a study, or of a correlation in one.
    *names : str
        Of the figures that are to be written.

    Returns
    -------
    Path

    Raises
    ------
    WriteError
        It cannot be made.
    """
    folder = study / FIGURES
    try:
        folder.mkdir(exist_ok=True)
        record_files(study, [f"{FIGURES}/{name}" for name in names])
    except OSError as error:
        raise WriteError(f"cannot write {folder}: {error.strerror or error}") from error
    return folder


def figure_path(study: Path, name: str) -> Path:
    """Where a figure of a study is to stand; see `figures_folder`."""
    return figures_folder(study, name) / name
