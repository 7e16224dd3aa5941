"""Write a file whole or not at all."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cytodisk.errors import StudyError


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
    StudyError
        The folder does not exist or cannot be written.
    """
    target = Path(path)
    temporary = target.with_name(f".{target.stem}.{os.getpid()}.tmp{target.suffix}")
    try:
        yield temporary
        temporary.replace(target)
    except OSError as error:
        raise StudyError(f"cannot write {target}: {error.strerror or error}") from error
    finally:
        temporary.unlink(missing_ok=True)
