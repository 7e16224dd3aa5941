"""Hashes of input files, by which a run knows whether they are the same."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cytodisk.errors import ReadError
from cytodisk.images.image_paths import sha256_of


def described(paths: Path | Sequence[Path]) -> dict[str, Any]:
    """Where an input lies, and a hash of what it holds.

    Parameters
    ----------
    paths : Path, or sequence of Path
        A file, or an image that is stored as a folder; or files that are one input together, in their order.

    Returns
    -------
    dict
        "path" and "sha256"; of several files "path" is their folder, and "files" has the hash of each by its
        name, "unreadable" for one that is damaged or not there.

    Raises
    ------
    ReadError
        A single file cannot be read.
    """
    if isinstance(paths, Path):
        return {"path": str(paths), "sha256": _sha256(paths)}
    folder = Path(os.path.commonpath([path.parent for path in paths]))
    files = {path.relative_to(folder).as_posix(): _sha256_if_readable(path) for path in paths}
    lines = "".join(f"{value}  {name}\n" for name, value in files.items())
    whole = hashlib.sha256(lines.encode(errors="surrogateescape")).hexdigest()
    return {"path": str(folder), "sha256": whole, "files": files}


def _sha256_if_readable(path: Path) -> str:
    """A file of many that cannot be read has its row in the results, so it does not stop the run here."""
    try:
        return _sha256(path)
    except ReadError:
        return "unreadable"


def _sha256(path: Path) -> str:
    try:
        return sha256_of(path)
    except OSError as error:
        raise ReadError(f"{path} cannot be read: {error.strerror}") from error
