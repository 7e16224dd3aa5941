"""Remove what the runs of a study wrote, and nothing else: what is theirs, and whether it may go."""

from __future__ import annotations

import json
import os
import re
import shutil
from collections.abc import Collection, Iterable, Iterator
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import Any

from cytodisk.errors import StudyError, WriteError
from cytodisk.files import is_temporary, real_path
from cytodisk.store.provenance_file import PROVENANCE, read_provenance
from cytodisk.store.study_kind import PARTS
from cytodisk.store.written_files import CHANGES, FILES, recorded

LOCK = ".cytodisk.lock"
BEGUN = ".begun"
"""Ending of the file of a part with the names of what it is about to write beside its rows."""
_PART = r"\d{5,6}(_t\d{5,6})?\.(json|begun|npy|[a-z_]+\.(arrow|npy))"


def known_files(folder: Path, there: dict[str, Any]) -> set[str]:
    """Names of the files in a folder that are proven to be its study's, beside the parts and the provenance.

    Parameters
    ----------
    folder : Path
    there : dict
        Its provenance.

    Returns
    -------
    set of str
        What the provenance names, and what the parts of a run that was stopped began to write.
    """
    begun = (name for file in parts_of(folder, BEGUN) for name in _read_names(file))
    return {*recorded(there), *begun}


def files_of_study(folder: Path) -> list[str]:
    """All files in a folder that are its study's, with the provenance and what a stopped run left.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    list of str
        Relative to the folder; those that are there.
    """
    there = read_provenance(folder)
    if there is None:
        return []
    parts = (f"{PARTS}/{file.name}" for file in parts_of(folder))
    names = [PROVENANCE, *sorted(known_files(folder, there)), *parts]
    return [name for name in names if os.path.lexists(folder / name)]


def _read_names(file: Path) -> list[str]:
    """Names that a part was about to write; none if not even the list of them was whole."""
    try:
        found = json.loads(file.read_bytes())
    except (OSError, ValueError):
        return []
    return list(recorded({FILES: found}))


def input_files(provenance: dict[str, Any]) -> list[Path]:
    """The files that a run reads; of a folder of masks those that count, not what else stands in it."""
    inputs = provenance.get("inputs", {}).values()
    return [Path(found["path"]) / name for found in inputs for name in found.get("files", [""])]


def refuse_removal(folder: Path, names: Collection[str], inputs: Iterable[Path]) -> None:
    """Check that files of a study can be removed without harm to anything else.

    Parameters
    ----------
    folder : Path
    names : collection of str
        Relative to the folder.
    inputs : iterable of Path
        Files and folders that are needed; so are those that they link to.

    Raises
    ------
    StudyError
        One of the files is an input, or is reached by a link.
    """
    for place in {folder / parent for name in (*names, f"{PARTS}/file") for parent in _folders_of(name)}:
        if place.is_symlink():
            raise StudyError(
                f"{place} is a link, which --overwrite does not follow: put the folder itself there, or pass "
                "another folder for the results"
            )
        if place.exists() and not os.access(place, os.W_OK | os.X_OK):
            raise WriteError(f"files in {place} cannot be removed: change the rights of that folder")
    if blocked := [name for name in names if (folder / name).is_dir() and not (folder / name).is_symlink()]:
        raise StudyError(f"{folder / blocked[0]} is a folder where the study wrote a file: move it")
    there = {found: name for name in names if (found := _identity(folder / name)) is not None}
    places = {real_path(folder / name) for name in names}
    for file in inputs:
        own = there.get(_identity(file) or (0, 0))
        resolved = real_path(file)
        if own is None and (file.is_dir() or resolved in places):
            own = next((str(place) for place in places if place.is_relative_to(resolved)), None)
        if own is not None:
            raise StudyError(
                f"input {file} is among the results in {folder}, which --overwrite removes: move it, or pass "
                "another folder"
            )


def refuse_removal_of(file: Path, folder: Path) -> None:
    """Raise StudyError if a file that a run is given is one of those that `--overwrite` removes."""
    refuse_removal(folder, files_of_study(folder), [file])


def _folders_of(name: str) -> list[PurePosixPath]:
    """The folders that a file stands in, below that of the study."""
    return [*PurePosixPath(name).parents][:-1]


def _identity(path: Path) -> tuple[int, int] | None:
    """What a file is to the system, whatever its name; None if there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_dev, found.st_ino


def remove_files(folder: Path, names: Iterable[str]) -> None:
    """Remove files of a study, and its folders that are empty then."""
    folders: set[PurePosixPath] = set()
    for name in names:
        (folder / name).unlink(missing_ok=True)
        folders.update(_folders_of(name))
    for parent in sorted(folders, key=lambda path: len(path.parts), reverse=True):
        with suppress(OSError):  # something that is not ours stands there
            (folder / parent).rmdir()


def parts_of(folder: Path, suffix: str = "") -> Iterator[Path]:
    """Files of the parts of a run, of all kinds or of one."""
    with suppress(FileNotFoundError):
        for file in (folder / PARTS).iterdir():
            if re.fullmatch(_PART, file.name) and file.name.endswith(suffix):
                yield file


def remove_parts(folder: Path) -> None:
    """Remove the parts of a run, and what a killed one left among them; other files stay."""
    for file in list(parts_of(folder)):
        file.unlink(missing_ok=True)
    with suppress(OSError):  # something that is not ours stands there, or there is no such folder
        remove_left_overs([folder / PARTS])
        (folder / PARTS).rmdir()


def remove_left_overs(places: Iterable[Path]) -> None:
    """Remove the temporary files of a run that was killed while writing; other files are not ours."""
    for place in places:
        for file in place.iterdir():
            if is_temporary(file.name):
                _remove(file)


def is_left_over(file: Path) -> bool:
    """Whether a file is a lock, or a temporary file of a run."""
    return file.name in (LOCK, CHANGES) or is_temporary(file.name)


def _remove(target: Path) -> None:
    if target.is_dir() and not target.is_symlink():
        shutil.rmtree(target)
    else:
        target.unlink(missing_ok=True)
