"""Turn what decoders raise into one kind of error."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from cytodisk.errors import MissingPartError, ReadError


@contextmanager
def reading(path: Path, part: str) -> Iterator[None]:
    """Turn whatever a decoder raises on a damaged file into a `ReadError` that names the place."""
    try:
        yield
    except (ReadError, MissingPartError):
        raise
    except MemoryError as error:
        raise ReadError(
            f"{path}: {part} asks for more memory than there is: the file is too large, or damaged"
        ) from error
    except Exception as error:
        words = " ".join(str(error).split()) or type(error).__name__  # on one line, for tables of reasons
        raise ReadError(f"{path}: {part} cannot be read as an image ({words}); copy it again") from error
