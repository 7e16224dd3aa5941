"""What tests of the command line share."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import tifffile

Run = Callable[..., tuple[int, str, str]]


def write(path: Path, values: np.ndarray, **options: object) -> Path:
    tifffile.imwrite(path, values, photometric="minisblack", **options)
    return path


def content(folder: Path) -> dict[str, bytes]:
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def assert_refused(result: tuple[int, str, str], *words: str) -> None:
    """Exit code 2, and an error that a user can act on instead of a traceback."""
    code, _, error = result
    assert code == 2
    assert "Traceback" not in error
    for word in words:
        assert word in error
