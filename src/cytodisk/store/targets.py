"""Where many results are written to: a folder that every worker sees."""

from __future__ import annotations

import errno
import os
import shutil
import uuid
from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from pathlib import Path
from typing import BinaryIO, Protocol

from cytodisk.errors import CytodiskError, StudyError, WriteError
from cytodisk.files import replacing
from cytodisk.store.study_room import alone_in

_WORK = ".work"


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

    def remove(self, key: str) -> None:
        """Remove a file, or a folder with all in it, if it is there."""

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
        arriving, leaving = (target.with_name(f".{target.name}.{uuid.uuid4().hex}.tmp") for _ in range(2))
        try:
            shutil.move(folder, arriving)
            while arriving.exists():
                with suppress(FileNotFoundError):
                    target.rename(leaving)
                shutil.rmtree(leaving, ignore_errors=True)
                with _folder_may_stand():
                    arriving.rename(target)
        except OSError as error:
            raise WriteError(f"cannot write {target}: {error.strerror or error}") from error
        finally:
            shutil.rmtree(arriving, ignore_errors=True)

    def remove(self, key: str) -> None:
        target = self.path / key
        try:
            if target.is_dir():
                shutil.rmtree(target)
            else:
                target.unlink(missing_ok=True)
        except OSError as error:
            raise StudyError(f"{target} cannot be removed: {error.strerror or error}") from error

    def alone(self) -> AbstractContextManager[None]:
        return alone_in(self.path)

    @contextmanager
    def work_folder(self) -> Iterator[Path]:
        work = self._with_folder(_WORK)
        try:
            shutil.rmtree(work, ignore_errors=True)  # of a run that was killed
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
            target.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise WriteError(f"cannot write {target}: {error.strerror or error}") from error
        return target
