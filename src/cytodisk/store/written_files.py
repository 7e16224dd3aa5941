"""The list of files that the runs of a study wrote, each with its size and checksum."""

from __future__ import annotations

import os
import time
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path, PurePosixPath
from typing import Any, TypeVar

from cytodisk.errors import ReadError, StudyError
from cytodisk.files import has_mark, lock, mark_of, unlock, writing_to
from cytodisk.store.provenance_file import PROVENANCE, read_provenance, write_json

Content = TypeVar("Content")
FILES = "files"  # of the provenance
CHANGES = ".cytodisk.changes"
_READ_AT_ONCE = 8  # files; checksums are computed side by side
_SHOWN = 3
_WAIT_S = 0.01


def recorded(provenance: Mapping[str, Any]) -> dict[str, str]:
    """Names of the files that a study's runs wrote, relative to its folder, beside the provenance.

    Names that lead out of the folder are left out: the file may come from elsewhere, and `--overwrite`
    removes what is named here.

    Parameters
    ----------
    provenance : dict

    Returns
    -------
    dict of str to str
        With their marks, see `mark_of`; "" for a file that is being written, or was when its run stopped,
        and for those that an earlier version wrote.
    """
    found = provenance.get(FILES)
    marks = found if isinstance(found, dict) else dict.fromkeys(found if isinstance(found, list) else (), "")
    return {
        name: mark if isinstance(mark, str) else ""
        for name, mark in marks.items()
        if isinstance(name, str) and name != PROVENANCE and _is_inside(name)
    }


def _is_inside(name: str) -> bool:
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts and not Path(name).drive


def lost_files(folder: Path, marks: Mapping[str, str]) -> list[str]:
    """Files that are gone, cut or changed since they were written.

    Parameters
    ----------
    folder : Path
    marks : dict of str to str
        By name, relative to the folder; a file without a mark is not looked at.

    Returns
    -------
    list of str
    """
    known = {name: mark for name, mark in marks.items() if mark}
    with ThreadPoolExecutor(_READ_AT_ONCE) as threads:
        whole = threads.map(lambda name: has_mark(folder / name, known[name]), known)
        return [name for name, is_whole in zip(known, whole, strict=True) if not is_whole]


def unchanged(found: Content, path: Path, marks: Mapping[Path, str]) -> Content:
    """What was read of a file, if it is the one that the run wrote, and not another one under its name.

    Parameters
    ----------
    found : object
    path : Path
    marks : dict of Path to str
        See `recorded`; a file without a mark, as of an earlier version, is not looked at.

    Raises
    ------
    ReadError
        It is another one.
    """
    mark = marks.get(path, "")
    if mark and not _is_as_written(path, mark, *_state(path)):
        raise ReadError(
            f"{path} is not the file that the run wrote: it was changed, cut or swapped; run the same "
            "command again with --resume, which makes it anew"
        )
    return found


@lru_cache(maxsize=10_000)
def _is_as_written(path: Path, mark: str, _changed_ns: int, _size: int) -> bool:
    return has_mark(path, mark)


def _state(path: Path) -> tuple[int, int]:
    with suppress(OSError):
        there = path.stat()
        return there.st_mtime_ns, there.st_size
    return 0, 0


def some_of(names: Iterable[str]) -> str:
    """The first few of some names, and how many more there are."""
    given = list(names)
    shown = ", ".join(given[:_SHOWN])
    return shown if len(given) <= _SHOWN else f"{shown} and {len(given) - _SHOWN} more"


@contextmanager
def writing_files(folder: Path, *names: str) -> Iterator[None]:
    """Note what the block writes into a study's folder, before and after; nothing without a study.

    Parameters
    ----------
    folder : Path
    *names : str
        Relative to the folder. A file that the block does not write after all is not noted.

    Raises
    ------
    StudyError
        A file of that name is there which is not the study's.
    """
    _change(folder, dict.fromkeys(names, ""), check=True)
    try:
        yield
    finally:
        _change(folder, {name: mark_of(folder / name) for name in names})


def note_of_study(folder: Path, name: str, value: Any) -> None:
    """Set an entry of the provenance of a complete study, beside what others write there."""
    with _held(folder):
        there = read_provenance(folder)
        if there is not None and there.get(name) != value:
            write_json(folder / PROVENANCE, there | {name: value})


def _change(folder: Path, marks: Mapping[str, str], *, check: bool = False) -> None:
    if not marks:
        return
    with _held(folder):
        there = read_provenance(folder)
        if there is None:
            return
        known = recorded(there)
        strange = [name for name in marks if name not in known and os.path.lexists(folder / name)]
        if check and strange and isinstance(there.get(FILES), dict):
            raise StudyError(
                f"{folder / strange[0]} is in the way, and was not written by this study's runs: move it"
            )
        if isinstance(there.get(FILES), list):  # of an earlier version, whose list has no marks
            changed: Any = [*there[FILES], *(name for name in marks if name not in known)]
        else:
            changed = known | dict(marks)
            gone = [name for name in marks if not check and not os.path.lexists(folder / name)]
            changed = {name: changed[name] for name in sorted(changed) if name not in gone}
        if changed != there.get(FILES):
            write_json(folder / PROVENANCE, there | {FILES: changed})


@contextmanager
def _held(folder: Path) -> Iterator[None]:
    """Let one process at a time change the provenance; another one waits."""
    held = None
    with writing_to(folder):
        while held is None:
            try:
                held = lock(folder / CHANGES)  # a file: folders know no locks on NFS
            except BlockingIOError:
                time.sleep(_WAIT_S)
    try:
        yield
    finally:
        unlock(held, folder / CHANGES)
