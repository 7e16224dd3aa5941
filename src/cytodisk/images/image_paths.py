"""Paths of images: a file, or a Zarr folder, which is one image as well; other folders hold files."""

from __future__ import annotations

import glob
import hashlib
import os
from pathlib import Path

_ZARR_MEMBERS = ("zarr.json", ".zgroup", ".zattrs", ".zarray")


def is_zarr(path: Path) -> bool:
    """Whether a path is a Zarr folder.

    Parameters
    ----------
    path : Path

    Returns
    -------
    bool

    Examples
    --------
    >>> from pathlib import Path
    >>> is_zarr(Path("no_such_folder.zarr"))
    False
    """
    return path.is_dir() and any((path / name).is_file() for name in _ZARR_MEMBERS)


def is_folder_of_files(path: Path) -> bool:
    """Whether a path is a folder, and no image itself."""
    return path.is_dir() and not is_zarr(path)


def is_pattern(path: Path) -> bool:
    """Whether a path stands for several files, as "frames/t*.tif"; a file of that very name comes first."""
    if os.path.lexists(path):
        return False
    return glob.has_magic(path.name if path.parent.is_dir() else str(path))


def parts_of(image: Path) -> list[Path]:
    """The files that an image consists of: itself, or all of a Zarr folder in the order of their names."""
    return sorted(part for part in image.rglob("*") if part.is_file()) if image.is_dir() else [image]


def path_advice(gone: Path) -> str:
    """What to do about a path that is not there: files whose names begin as it does, or else check it."""
    try:
        names = sorted(file.name for file in gone.parent.iterdir() if file.name.startswith(gone.name))
    except OSError:
        names = []
    if not names or not gone.name:
        return "check the path"
    if len(names) == 1:
        return f"check the path, or pass {gone.with_name(names[0])}, which is there"
    endings = {Path(name).suffix for name in names}
    pattern = f"{glob.escape(str(gone))}*{endings.pop() if len(endings) == 1 else ''}"
    return (
        f"check the path, or pass the {len(names)} that begin with it as a pattern, in quotes, as '{pattern}'"
    )


def sha256_of(image: Path) -> str:
    """A hash of what an image holds, also of one that is a folder.

    Raises
    ------
    OSError
        A file of it cannot be read.
    """
    if not image.is_dir():
        return _sha256(image)
    lines = [f"{_sha256(part)}  {part.relative_to(image).as_posix()}\n" for part in parts_of(image)]
    return hashlib.sha256("".join(lines).encode("utf-8", "surrogateescape")).hexdigest()


def _sha256(file: Path) -> str:
    with file.open("rb") as opened:
        return hashlib.file_digest(opened, "sha256").hexdigest()
