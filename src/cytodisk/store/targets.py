"""Where many results are written to: a folder that every worker sees."""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, Protocol

from cytodisk.errors import CytodiskError, StudyError, WriteError
from cytodisk.files import flush, make_folder, replacing, temporary_name
from cytodisk.store.provenance_file import PROVENANCE, read_provenance, write_json
from cytodisk.store.removal import files_of_study, is_left_over, refuse_removal, remove_files
from cytodisk.store.study_room import alone_in
from cytodisk.store.written_files import FILES, lost_files, recorded


class Store(Protocol):
    """Files by key, as "rows/a.json"; each is there whole or not at all."""

    def read_text(self, key: str) -> str | None:
        """The content of a file; None if there is none."""

    def write_text(self, key: str, text: str) -> None:
        """Write a file, in the place of one that is there."""

    def open(self, key: str) -> AbstractContextManager[BinaryIO]:
        """Open a file for reading."""

    def names(self, key: str) -> Iterator[str]:
        """Names in a folder, in no order; none if there is no such folder."""

    def put_file(self, file: Path, key: str) -> None:
        """Move a local file here."""

    def put_folder(self, folder: Path, key: str) -> None:
        """Move a local folder here, in the place of one that is there."""

    def files_of_study(self, key: str) -> list[str]:
        """Keys of the files that the runs of a study wrote; none if there is no study."""

    def lost_files(self, key: str, marks: Mapping[str, str]) -> list[str]:
        """Names of files below a key that are gone, or are not as marked; see `mark_of`."""

    def refuse_removal(self, keys: Collection[str], inputs: Iterable[Path]) -> None:
        """Raise StudyError if files cannot be removed without harm to an input or to what is elsewhere."""

    def remove(self, keys: Iterable[str]) -> None:
        """Remove files, if they are there, and folders that are empty then."""

    def remove_left_over(self, key: str) -> None:
        """Remove a file or folder that a run which was killed was about to write."""

    def alone(self) -> AbstractContextManager[None]:
        """Keep other runs out while the block runs."""

    def work_folder(self) -> AbstractContextManager[Path]:
        """A local folder to prepare files in, from where `put_file` takes them; it is removed at the end."""


@contextmanager
def _folder_may_stand() -> Iterator[None]:
    """Let it be no error that another worker has put the same folder there in between."""
    try:
        yield
    except OSError as error:
        if error.errno not in (errno.EEXIST, errno.ENOTEMPTY):
            raise


def _strangers(folder: Path) -> list[str]:
    """Files in a folder that are not its study's."""
    own = set(files_of_study(folder))
    files = (file for file in folder.rglob("*") if file.is_symlink() or not file.is_dir())
    names = (file.relative_to(folder).as_posix() for file in files if not is_left_over(file))
    return [name for name in names if name not in own]


def _exchange_folder(old: Path, new: Path) -> None:
    """Put a study's folder in the place of another, which is there until the new one is."""
    leaving = old.with_name(temporary_name())
    while new.exists():
        with suppress(FileNotFoundError):
            old.rename(leaving)
        shutil.rmtree(leaving, ignore_errors=True)
        with _folder_may_stand():
            new.rename(old)


def _exchange_files(old: Path, new: Path, strangers: Collection[str]) -> None:
    """Put the files of a new study in the place of an old one's, beside files that are not the study's.

    These stay where they are, so that they outlast a run that is killed here. What is there until the last
    file stands is known as a study that is not complete.
    """
    files = [path.relative_to(new).as_posix() for path in new.rglob("*") if not path.is_dir()]
    if taken := [name for name in strangers if name in files]:
        raise StudyError(f"{old / taken[0]} is in the way, and was not written by a study's run: move it")
    before = files_of_study(old)
    there = read_provenance(new) or {}
    both = dict.fromkeys([*before, *recorded(there)], "")
    write_json(old / PROVENANCE, there | {"status": "being replaced", "fingerprint": {}, FILES: both})
    remove_files(old, [name for name in before if name not in files])
    for name in sorted(files, key=lambda name: name == PROVENANCE):
        make_folder((old / name).parent)
        (new / name).replace(old / name)


class FolderStore:
    """A folder of this machine, or one that all workers share.

    Parameters
    ----------
    path : path-like
        Is made when something is written.
    """

    def __init__(self, path: str | os.PathLike[str]):
        self.path = Path(path)

    def read_text(self, key: str) -> str | None:
        try:
            return (self.path / key).read_text(encoding="utf-8")
        except FileNotFoundError:
            return None
        except (OSError, UnicodeDecodeError) as error:
            raise StudyError(f"{self.path / key} cannot be read: {error}") from error

    def write_text(self, key: str, text: str) -> None:
        with replacing(self._with_folder(key)) as temporary:
            temporary.write_text(text, encoding="utf-8")

    def open(self, key: str) -> AbstractContextManager[BinaryIO]:
        try:
            return (self.path / key).open("rb")
        except OSError as error:
            raise StudyError(f"{self.path / key} cannot be read: {error.strerror}") from error

    def names(self, key: str) -> Iterator[str]:
        try:
            with os.scandir(self.path / key) as entries:
                yield from (entry.name for entry in entries)
        except FileNotFoundError:
            return

    def put_file(self, file: Path, key: str) -> None:
        with replacing(self._with_folder(key)) as temporary:
            shutil.move(file, temporary)

    def put_folder(self, folder: Path, key: str) -> None:
        target = self._with_folder(key)
        arriving = target.with_name(temporary_name())
        try:
            shutil.move(folder, arriving)
            flush(file for file in arriving.rglob("*") if file.is_file())
            if strangers := _strangers(target):
                _exchange_files(target, arriving, strangers)
            else:
                _exchange_folder(target, arriving)
        except OSError as error:
            raise WriteError(f"cannot write {target}: {error.strerror or error}") from error
        finally:
            shutil.rmtree(arriving, ignore_errors=True)

    def files_of_study(self, key: str) -> list[str]:
        return [f"{key}/{name}" for name in files_of_study(self.path / key)]

    def lost_files(self, key: str, marks: Mapping[str, str]) -> list[str]:
        return lost_files(self.path / key, marks)

    def refuse_removal(self, keys: Collection[str], inputs: Iterable[Path]) -> None:
        refuse_removal(self.path, keys, inputs)

    def remove(self, keys: Iterable[str]) -> None:
        try:
            remove_files(self.path, keys)
        except OSError as error:
            raise StudyError(f"files in {self.path} cannot be removed: {error.strerror or error}") from error

    def remove_left_over(self, key: str) -> None:
        target = self.path / key
        with suppress(OSError):  # it stays; nothing reads it
            if target.is_dir() and not target.is_symlink():
                shutil.rmtree(target)
            else:
                target.unlink(missing_ok=True)

    def alone(self) -> AbstractContextManager[None]:
        return alone_in(self.path)

    @contextmanager
    def work_folder(self) -> Iterator[Path]:
        work = self._with_folder(temporary_name())
        try:
            work.mkdir()
            yield work
        except CytodiskError:
            raise
        except OSError as error:
            raise WriteError(f"cannot write {work}: {error.strerror or error}") from error
        finally:
            shutil.rmtree(work, ignore_errors=True)

    def _with_folder(self, key: str) -> Path:
        target = self.path / key
        try:
            make_folder(target.parent)
        except OSError as error:
            raise WriteError(f"cannot write {target}: {error.strerror or error}") from error
        return target
