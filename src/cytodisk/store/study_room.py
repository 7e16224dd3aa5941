"""Make room for a run in a folder, without touching what is not a study's."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cytodisk.errors import OtherRunError, StudyError, WriteError
from cytodisk.files import lock, make_folder, unlock
from cytodisk.store.provenance_file import (
    PROVENANCE,
    differences,
    other_version,
    read_provenance,
    way_out,
    write_json,
)
from cytodisk.store.removal import (
    LOCK,
    input_files,
    is_left_over,
    known_files,
    refuse_removal,
    remove_files,
    remove_parts,
)
from cytodisk.store.study_kind import StudyKind
from cytodisk.store.written_files import some_of

WRITES = "writes"  # of the provenance


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
        make_folder(folder)
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
        unlock(held, folder / LOCK)


def make_room(
    folder: Path, provenance: dict[str, Any], kind: StudyKind, resume: bool, overwrite: bool
) -> None:
    """Check that a run may write to a folder that is not empty, and remove what it replaces.

    All is checked before anything is removed.

    Parameters
    ----------
    folder : Path
    provenance : dict
        Of the run; its inputs are never removed.
    kind : StudyKind
        What the run may write: where that is someone else's, it is refused.
    resume, overwrite : bool
        See `StudyFolder.start`.

    Raises
    ------
    StudyError
        The folder holds something else, or another run (`OtherRunError`); or files are in the way, or would
        be removed, that are not the study's.
    """
    there, names = check_folder(folder, provenance, kind, resume, overwrite)
    if overwrite:
        # The old provenance stays, marked, until the new one replaces it: a kill leaves a known study.
        write_json(folder / PROVENANCE, there | {"status": "being replaced", "fingerprint": {}})
        remove_files(folder, names)
        remove_parts(folder)


def check_folder(
    folder: Path, provenance: dict[str, Any], kind: StudyKind, resume: bool, overwrite: bool
) -> tuple[dict[str, Any], list[str]]:
    """Check that a run may write to a folder that is not empty, and what it replaces.

    Parameters
    ----------
    folder : Path
    provenance : dict
    kind : StudyKind
    resume, overwrite : bool
        As `make_room` takes them.

    Returns
    -------
    there : dict
        Provenance of the study that stands there.
    names : list of str
        Its files, where they are to be replaced.

    Raises
    ------
    StudyError
        As for `make_room`.
    """
    there = read_provenance(folder)
    if there is None and os.path.lexists(folder / PROVENANCE):
        raise StudyError(
            f"output folder {folder} holds no study that can be read, as its {PROVENANCE} is damaged or that "
            "of another program: pass another folder"
        )
    check_room(there, provenance, f"output folder {folder}", resume, overwrite)
    assert there is not None  # it was checked
    known = known_files(folder, there)
    _refuse_strangers(folder, kind, known)
    names = [name for name in known if os.path.lexists(folder / name)] if overwrite else []
    refuse_removal(folder, names, input_files(provenance))
    return there, names


def is_empty(folder: Path) -> bool:
    """Whether a folder holds nothing but what runs left that were stopped."""
    return all(is_left_over(file) for file in folder.iterdir())


def _refuse_strangers(folder: Path, kind: StudyKind, known: set[str]) -> None:
    """Raise StudyError if a file that is not the study's has the name of one that a run may write."""
    matches = (path for pattern in kind.patterns for path in folder.glob(pattern))
    names = [*kind.names, *(path.relative_to(folder).as_posix() for path in matches)]
    strange = [name for name in names if name not in known and os.path.lexists(folder / name)]
    if strange:
        raise StudyError(
            f"output folder {folder} holds {some_of(strange)}, which its study did not write but this run "
            "may: move what is yours, or pass another folder"
        )


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


def refuse_to_add(folder: Path, provenance: dict[str, Any], writes: Mapping[str, str]) -> None:
    """Check that a run which goes on with another writes nothing for each cell that the other did not.

    Parameters
    ----------
    folder : Path
    provenance : dict
        Of the run.
    writes : dict of str to str
        What it writes for each cell, and how to do without.

    Raises
    ------
    StudyError
        Cells that are done would lack it.
    """
    there = read_provenance(folder) or {}
    known = there.get(WRITES)
    if known is None or there.get("fingerprint") != provenance["fingerprint"]:
        return
    for what, instead in writes.items():
        if what not in known:
            raise StudyError(
                f"output folder {folder} holds this run without {what}: pass --overwrite to do all anew with "
                f"them, or {instead}"
            )
