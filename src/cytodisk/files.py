"""Write a file whole or not at all."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import IO

from cytodisk.errors import CytodiskError, WriteError


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Give a temporary name in the same folder and rename it to `path` when the block ends well.

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
    temporary = target.with_name(f".{target.stem}.{os.getpid()}.tmp{target.suffix}")
    try:
        yield temporary
        temporary.replace(target)
    except CytodiskError:
        raise
    except OSError as error:
        raise WriteError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        with suppress(OSError):  # the error that matters is on its way already
            temporary.unlink(missing_ok=True)


def lock(path: Path) -> IO[bytes]:
    """Hold a file for this process alone until it is closed; the system lets go when the process dies.

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
    """
    file = path.open("ab")
    try:
        if sys.platform == "win32":
            import msvcrt

            msvcrt.locking(file.fileno(), msvcrt.LK_NBLCK, 1)
        else:
            import fcntl

            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        file.close()
        raise BlockingIOError(f"{path} is held by another process") from error
    return file
