"""Where the figures of a study stand."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from cytodisk.files import writing_to
from cytodisk.store.provenance_file import read_provenance
from cytodisk.store.study_kind import FIGURES
from cytodisk.store.written_files import lost_files, note_of_study, recorded, writing_files

DRAWN = "figures drawn"  # of the provenance


@contextmanager
def drawing(study: Path, *names: str, of: Path | None = None) -> Iterator[Path]:
    """The folder for the figures of a study; those that the block writes are noted as the study's.

    Parameters
    ----------
    study : Path
    *names : str
        Of the figures that may be written.
    of : Path, optional
        Folder within the study whose figures they are, as that of a correlation.

    Yields
    ------
    Path
        It is there.

    Raises
    ------
    WriteError
        It cannot be made.
    StudyError
        A file of such a name is there which is not the study's.
    """
    folder = (of or study) / FIGURES
    files = [folder / name for name in names] if folder.is_relative_to(study) else []
    with writing_files(study, *(file.relative_to(study).as_posix() for file in files)):
        with writing_to(folder):
            folder.mkdir(exist_ok=True)
        yield folder


def note_drawn(study: Path, formats: Sequence[str]) -> None:
    """Note that all figures of a study are drawn in these formats; see `drawn_figures`."""
    before = (read_provenance(study) or {}).get(DRAWN, [])
    note_of_study(study, DRAWN, sorted({*before, *formats}))


def drawn_figures(study: Path, formats: Sequence[str]) -> list[Path]:
    """The figures of a study in these formats; none unless all were drawn, and are whole.

    Parameters
    ----------
    study : Path
    formats : sequence of str
        Such as "png".

    Returns
    -------
    list of Path
    """
    there = read_provenance(study) or {}
    if not set(formats) <= set(there.get(DRAWN, [])):
        return []
    marks = recorded(there)
    by_format = [
        {name: mark for name, mark in marks.items() if name.startswith(f"{FIGURES}/") and name.endswith(one)}
        for one in formats
    ]
    own = {name: mark for some in by_format for name, mark in some.items()}
    whole = all(own.values()) and not lost_files(study, own)
    return [study / name for name in own] if whole else []


def is_drawn(study: Path, name: str, last: str) -> bool:
    """Whether all figures of a cell are there, and whole.

    Parameters
    ----------
    study : Path
    name : str
        What the names of the cell's figures begin with.
    last : str
        Ending of the one that is drawn last.

    Returns
    -------
    bool
    """
    files = recorded(read_provenance(study) or {})
    starts = tuple(f"{FIGURES}/{name}{mark}" for mark in "_.")
    own = {file: mark for file, mark in files.items() if file.startswith(starts)}
    return any(file.endswith(last) for file in own) and all(own.values()) and not lost_files(study, own)
