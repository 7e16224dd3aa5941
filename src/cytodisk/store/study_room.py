"""Make room for a run in a folder, without touching what is not a study's."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from cytodisk.errors import OtherRunError, StudyError, WriteError
from cytodisk.files import lock
from cytodisk.store.provenance_file import (
    PROVENANCE,
    differences,
    other_version,
    own_files,
    read_provenance,
    way_out,
    write_json,
)

LOCK = ".lock"


@contextmanager
def alone_in(path: str | os.PathLike[str]) -> Iterator[None]:
    """Keep other runs out of a folder while the block runs.

    Parameters
    ----------
    path : path-like
        Is made if need be.

    Raises
    ------
    StudyError
        Another run is writing there, or the folder cannot be written.
    """
    folder = Path(path)
    try:
        if folder.exists() and not folder.is_dir():
            raise StudyError(f"output {folder} is a file: pass a folder")
        folder.mkdir(parents=True, exist_ok=True)
        held = lock(folder / LOCK)
    except StudyError:
        raise
    except BlockingIOError as error:
        raise StudyError(f"output folder {folder}: another run is writing there, wait for its end") from error
    except OSError as error:
        raise WriteError(f"output folder {folder} cannot be written: {error.strerror}") from error
    try:
        yield
    finally:
        (folder / LOCK).unlink(missing_ok=True)
        held.close()


def make_room(folder: Path, provenance: dict[str, Any], resume: bool, overwrite: bool) -> None:
    """Check that a run may write to a folder that is not empty, and remove what it replaces.

    Parameters
    ----------
    folder : Path
    provenance : dict
        Of the run; its inputs are never removed.
    resume, overwrite : bool
        See `StudyFolder.start`.

    Raises
    ------
    StudyError
        The folder holds something else, or another run (`OtherRunError`).
    """
    there = read_provenance(folder)
    check_room(there, provenance, f"output folder {folder}", resume, overwrite)
    if overwrite and there is not None:
        # The old provenance stays, marked, until the new one replaces it: a kill leaves a known study.
        write_json(folder / PROVENANCE, there | {"status": "being replaced", "fingerprint": {}})
        inputs = _input_files(provenance)
        names = own_files(there)
        for file in [file for name in names for file in folder.glob(name)]:
            if not any(one.is_relative_to(file.resolve()) for one in inputs):
                _remove(file)
        for name in {Path(name).parent for name in names} - {Path()}:
            with suppress(OSError):  # something that is not ours stands there
                (folder / name).rmdir()


def _input_files(provenance: dict[str, Any]) -> set[Path]:
    """The files that a run reads; of a folder of masks those that count, not what else stands in it."""
    inputs = provenance.get("inputs", {}).values()
    return {
        file.resolve()
        for found in inputs
        for file in (Path(found["path"]) / name for name in found.get("files", [""]))
    }


def check_room(
    there: dict[str, Any] | None, here: dict[str, Any], place: str, resume: bool, overwrite: bool
) -> None:
    """Check that a run may write where another one was.

    Parameters
    ----------
    there, here : dict
        Provenance of the two; None if what stands there is no study.
    place : str
        In words.
    resume, overwrite : bool

    Raises
    ------
    StudyError
        It must not; `OtherRunError` if results of another run stand there.
    """
    if there is None:
        raise StudyError(f"{place} is not empty and holds no study: pass another folder")
    if words := other_version(there):
        raise StudyError(f"{place} holds a study that {words}: pass another folder")
    if overwrite:
        return
    if not resume:
        raise StudyError(f"{place} holds a study: pass --resume to go on, --overwrite to replace it")
    if there.get("fingerprint") != here["fingerprint"]:
        raise OtherRunError(f"{place} holds another run ({differences(there, here)}): {way_out(there, here)}")


def remove_left_overs(places: Iterable[Path]) -> None:
    """Remove the temporary files of a run that was killed while writing; other files are not ours."""
    for place in places:
        for file in place.iterdir():
            if file.name != LOCK and is_left_over(file):
                _remove(file)


def is_left_over(file: Path) -> bool:
    """Whether a file is the lock, or a temporary file of a run."""
    return file.name == LOCK or re.fullmatch(r"\..+\.\d+\.tmp\.\w+", file.name) is not None


def _remove(target: Path) -> None:
    if target.is_dir():
        shutil.rmtree(target)
    else:
        target.unlink(missing_ok=True)
