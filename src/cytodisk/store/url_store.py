"""Results in an object store, or wherever else fsspec reaches."""

from __future__ import annotations

import shutil
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir
from typing import Any, BinaryIO

from cytodisk.errors import CytodiskError, MissingPartError, StudyError, WriteError
from cytodisk.store.provenance_file import PROVENANCE, parse_provenance
from cytodisk.store.written_files import recorded


def is_url(target: str) -> bool:
    """Whether results go to a URL, as "s3://bucket/batch", not to a folder."""
    return "://" in target


class UrlStore:
    """A place named by a URL; see `cytodisk.store.targets.Store`.

    An object store has no folders and no renaming, but a file appears in it whole. So a folder is there when
    whatever is written after it is, such as the row of an input.

    Parameters
    ----------
    url : str

    Raises
    ------
    MissingPartError
        fsspec, or what it needs for such a URL, is not installed.
    StudyError
        fsspec does not know such a URL, or it is that of a process's memory.
    """

    def __init__(self, url: str):
        self.url = url.rstrip("/")
        self._files, root = _file_system(self.url)
        self._root = root.rstrip("/")

    def read_text(self, key: str) -> str | None:
        with self._faults(key, "read"):
            try:
                return str(self._files.cat_file(self._at(key)), encoding="utf-8")
            except FileNotFoundError:
                return None

    def write_text(self, key: str, text: str) -> None:
        with self._faults(key, "written"):
            self._make_folders([self._at(key)])
            self._files.pipe_file(self._at(key), text.encode())

    def open(self, key: str) -> AbstractContextManager[BinaryIO]:
        with self._faults(key, "read"):
            return BytesIO(self._files.cat_file(self._at(key)))

    def names(self, key: str) -> Iterator[str]:
        with self._faults(key, "read"):
            try:
                found = self._files.ls(self._at(key), detail=False)
            except FileNotFoundError:
                return
        yield from (path.rstrip("/").rsplit("/", 1)[-1] for path in found)

    def put_file(self, file: Path, key: str) -> None:
        with self._faults(key, "written"):
            self._make_folders([self._at(key)])
            self._files.put_file(str(file), self._at(key))
        file.unlink()

    def put_folder(self, folder: Path, key: str) -> None:
        files = sorted(path for path in folder.rglob("*") if path.is_file())
        targets = [self._at(f"{key}/{file.relative_to(folder).as_posix()}") for file in files]
        with self._faults(key, "written"):
            self._make_folders(targets)
            before = {self._at(name) for name in self.files_of_study(key)}
            self._files.put([str(file) for file in files], targets)
            # What an earlier study had more goes last: another worker may be writing the same one.
            if others := sorted(before & {*self._files.find(self._at(key))} - {*targets}):
                self._files.rm(others)
        shutil.rmtree(folder)

    def files_of_study(self, key: str) -> list[str]:
        there = parse_provenance(self.read_text(f"{key}/{PROVENANCE}") or "null")
        return [] if there is None else [f"{key}/{name}" for name in (PROVENANCE, *recorded(there))]

    def lost_files(self, key: str, marks: Mapping[str, str]) -> list[str]:
        """By their sizes: to read them all takes as long as to make them anew, where the line is slow."""
        with self._faults(key, "read"):
            found = self._files.find(self._at(key), detail=True)
        sizes = {name: f"{facts['size']} bytes" for name, facts in found.items()}
        there = {name: sizes.get(self._at(f"{key}/{name}"), "gone") for name in marks}
        return [name for name, mark in marks.items() if mark and mark.split(",")[0] != there[name]]

    def refuse_removal(self, keys: Collection[str], inputs: Iterable[Path]) -> None:
        """Nothing: inputs are files of a folder, and there are no links."""

    def remove(self, keys: Iterable[str]) -> None:
        for key in keys:
            with self._faults(key, "removed"), suppress(FileNotFoundError):
                self._files.rm(self._at(key))

    def remove_left_over(self, key: str) -> None:
        self.remove([key])

    def alone(self) -> AbstractContextManager[None]:
        """Nothing: an object store has no locks. The run that began last is the one whose results count."""
        return nullcontext()

    @contextmanager
    def work_folder(self) -> Iterator[Path]:
        try:
            with TemporaryDirectory(prefix="cytodisk-") as work:
                yield Path(work)
        except CytodiskError:
            raise
        except OSError as error:
            raise WriteError(f"cannot write in {gettempdir()}: {error.strerror or error}") from error

    def _make_folders(self, files: Iterable[str]) -> None:
        """Make the folders that files are to stand in, where the place has folders."""
        for folder in sorted({file.rpartition("/")[0] for file in files}):
            self._files.makedirs(folder, exist_ok=True)

    def _at(self, key: str) -> str:
        return f"{self._root}/{key}"

    @contextmanager
    def _faults(self, key: str, done: str) -> Iterator[None]:
        try:
            yield
        except Exception as error:  # each kind of store has errors of its own, beside those of the system
            raise StudyError(f"{self.url}/{key} cannot be {done}: {error}") from error


def _file_system(url: str) -> tuple[Any, str]:
    try:
        import fsspec
    except ImportError as error:
        raise MissingPartError.of(f"results at {url} need fsspec", "cluster") from error
    try:
        # Without its memory of listings, which does not know what other processes write.
        files, root = fsspec.core.url_to_fs(url, use_listings_cache=False)
    except ImportError as error:
        raise MissingPartError(f"results cannot go to {url}: {error}") from error
    except ValueError as error:
        raise StudyError(f"results cannot go to {url}: {error}") from error
    if "memory" in files.protocol:
        raise StudyError(f"results at {url} would be gone with the process: pass a folder or another URL")
    return files, str(root)
