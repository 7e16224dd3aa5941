"""Formats of figures: PNG, and PDF or SVG for print."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cytodisk.errors import ParameterError
from cytodisk.pages.sheet import Sheet

FORMATS = ("png", "pdf", "svg")

# Without dates, the same picture is the same file.
_DATELESS: dict[str, dict[str, Any]] = {"png": {}, "pdf": {"CreationDate": None}, "svg": {"Date": None}}


def chosen_formats(formats: Any) -> list[str]:
    """The formats that were asked for, each once.

    Raises
    ------
    ParameterError
        One is unknown, or there is none.
    """
    given = [formats] if isinstance(formats, str) else list(formats)
    unknown = [name for name in given if name not in FORMATS]
    if unknown or not given:
        came = repr(unknown[0]) if unknown else "none"
        raise ParameterError(f"formats must be of {', '.join(FORMATS)}, got {came}")
    return list(dict.fromkeys(given))


def save_in_formats(sheet: Sheet, folder: Path, name: str, formats: Sequence[str]) -> list[Path]:
    """Write a page in each format.

    Raises
    ------
    WriteError
        The folder cannot be written.
    """
    return [sheet.save(folder / f"{name}.{kind}", format=kind, metadata=_DATELESS[kind]) for kind in formats]


def save_by_ending(sheet: Sheet, path: Path) -> Path:
    """Write a page in the format that the ending of a file names.

    Raises
    ------
    ParameterError
        It names none.
    WriteError
        The folder cannot be written.
    """
    (kind,) = chosen_formats(path.suffix.removeprefix(".").lower())
    return sheet.save(path, format=kind, metadata=_DATELESS[kind])
