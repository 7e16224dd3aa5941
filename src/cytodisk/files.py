"""Write a file whole or not at all, know it again, and hold a folder alone."""

import errno
import os
import re
import stat
import sys
import uuid
import zlib
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from pathlib import Path, PureWindowsPath
from typing import IO

from cytodisk.errors import CytodiskError, WriteError

_LONG_SUFFIX = 32  # characters; a longer one is part of a name
_FLUSHED_AT_ONCE = 16
_READ_AT_ONCE = 2**20  # bytes
_HELD = (errno.EWOULDBLOCK, errno.EACCES, errno.EDEADLK)
_FLUSHED_LATER = ContextVar("flushed later", default=False)


def temporary_name(suffix: str = "") -> str:
    """A name for a file or folder that is not whole yet; no other process takes the same, nor does a user.

    It does not grow with the name that it stands for, which may be as long as the system allows.
    """
    return f".{uuid.uuid4().hex}.cytodisk{suffix}"


def is_temporary(name: str) -> bool:
    """Whether `temporary_name` made a name."""
    return re.fullmatch(r"\.[0-9a-f]{32}\.cytodisk(\..*)?", name, re.DOTALL) is not None


@contextmanager
def flushed_later() -> Iterator[None]:
    """Let files that the block writes not be flushed one by one, which takes a few milliseconds each.

    A run writes thousands, and flushes them together at its end; see `flush`.
    """
    before = _FLUSHED_LATER.set(True)
    try:
        yield
    finally:
        _FLUSHED_LATER.reset(before)


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary name in the same folder and rename it to `path` when the block ends well.

    The file outlasts a loss of power then, unless it is `flushed_later`.

    Parameters
    ----------
    path : path-like
        Where the file is to stand.

    Yields
    ------
    Path
        The temporary name, with the same suffix.

    Raises
    ------
    WriteError
        The folder does not exist or cannot be written.
    """
    target = Path(path)
    temporary = target.with_name(temporary_name(target.suffix if len(target.suffix) < _LONG_SUFFIX else ""))
    renamed = False
    try:
        yield temporary
        durable = not _FLUSHED_LATER.get()
        if durable:
            _flush_file(temporary)
        temporary.replace(target)
        renamed = True
        if durable:
            _flush_folder(target.parent)
    except CytodiskError:
        raise
    except OSError as error:
        raise WriteError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        if not renamed:
            with suppress(OSError):  # the error that matters is on its way already
                temporary.unlink(missing_ok=True)


def flush(paths: Iterable[Path]) -> None:
    """See to it that files and the folders they stand in outlast a loss of power.

    Many at a time, as the system then writes them together: a hundredth of the time of one by one.

    Parameters
    ----------
    paths : iterable of Path
    """
    files = list(paths)
    with ThreadPoolExecutor(_FLUSHED_AT_ONCE) as threads:
        list(threads.map(_flush_file, files))
    for folder in {file.parent for file in files}:
        _flush_folder(folder)


def _flush_file(path: Path) -> None:
    with path.open("rb+") as file:  # for reading alone, Windows flushes nothing
        os.fsync(file.fileno())


def _flush_folder(folder: Path) -> None:
    if sys.platform == "win32":
        return  # has no such thing
    number = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):  # not every network folder can; what is in its files was written
            os.fsync(number)
    finally:
        os.close(number)


@contextmanager
def writing_to(path: Path) -> Iterator[None]:
    """Turn a fault of the system within the block into a `WriteError` that names the file or folder."""
    try:
        yield
    except CytodiskError:
        raise
    except OSError as error:
        raise WriteError(f"cannot write {path}: {error.strerror or error}") from error


def make_folder(path: Path) -> None:
    """Make a folder with all those above it, however many: `Path.mkdir` calls itself for each of them."""
    missing = []
    for folder in (path, *path.parents):
        if folder.exists():
            break
        missing.append(folder)
    for folder in reversed(missing):
        folder.mkdir(exist_ok=True)


def mark_of(path: Path) -> str:
    """Size and checksum of a file, by which it is known to be whole; "" if it cannot be read."""
    check, size = 0, 0
    try:
        with path.open("rb") as file:
            while some := file.read(_READ_AT_ONCE):
                check, size = zlib.crc32(some, check), size + len(some)
    except OSError:
        return ""
    return f"{size} bytes, crc32 {check:08x}"


def has_mark(path: Path, mark: str) -> bool:
    """Whether a file is the one that `mark_of` looked at; of another size it is not read."""
    try:
        found = path.stat()
    except OSError:
        return False
    same_size = stat.S_ISREG(found.st_mode) and mark.startswith(f"{found.st_size} bytes")
    return same_size and mark_of(path) == mark


def lock(path: Path) -> IO[bytes]:
    """Hold a file for this process alone until `unlock`; the system lets go when the process dies.

    Parameters
    ----------
    path : Path
        Is made if need be.

    Returns
    -------
    file
        Keep it open as long as the lock is needed.

    Raises
    ------
    BlockingIOError
        Another process holds it.
    OSError
        The file cannot be made, or the folder knows no locks.
    """
    while True:
        file = path.open("ab")
        try:
            _lock(file)
            here = os.fstat(file.fileno())
            with suppress(FileNotFoundError):  # whoever held it has removed it: what is held is no lock
                there = path.stat()
                if (there.st_dev, there.st_ino) == (here.st_dev, here.st_ino):
                    return file
        except OSError as error:
            file.close()
            if error.errno in _HELD:
                raise BlockingIOError(f"{path} is held by another process") from error
            raise
        file.close()


def unlock(file: IO[bytes], path: Path) -> None:
    """Let go of a lock and remove its file."""
    if sys.platform == "win32":
        file.close()  # a file that is open cannot be removed there
        with suppress(OSError):  # another process has opened it in between
            path.unlink()
    else:
        with suppress(OSError):  # it stays, and is taken by the next one
            path.unlink()
        file.close()


def _lock(file: IO[bytes]) -> None:
    if sys.platform == "win32":
        import msvcrt

        msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
    else:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def real_path(path: Path) -> Path:
    """Where a file stands once links are followed; a link in a circle stays as it is."""
    return Path(os.path.realpath(path))  # Path.resolve raises RuntimeError on a circle


def file_name(path: str) -> str:
    """Last part of a path of any system: folders are nobody's business but the owner's."""
    return PureWindowsPath(path).name or path
