"""Formats of figures: PNG, and PDF or SVG for print."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd

from cytodisk.errors import ParameterError
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import paper_style
from cytodisk.store.figures_folder import drawing
from cytodisk.store.study_folder import part_key

Drawn = TypeVar("Drawn")

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


def save_pages(
    one: Drawn,
    pages: Mapping[str, Callable[[Drawn], Sheet | None]],
    *,
    cell: int,
    study: Path,
    of: Path,
    formats: Sequence[str],
    progress: Callable[[int, int], None] | None = None,
) -> list[Path]:
    """Draw the pages of a cell's result, and write each in each format.

    Parameters
    ----------
    one : object
        What the pages are of.
    pages : mapping of str to callable
        By the end of the file's name; a page that is None is not written.
    cell : int
    study : Path
        Folder of the study.
    of : Path
        Folder of the result, in which `figures` lies.
    formats : sequence of str
        As of `chosen_formats`.
    progress : callable, optional
        Called with (pages done, in all).

    Returns
    -------
    list of Path

    Raises
    ------
    StudyError
        The folder cannot be written.
    """
    report = progress or (lambda done, whole: None)
    paths = []
    stems = {what: f"cell_{part_key(cell)}_{what}" for what in pages}
    names = [f"{stem}.{kind}" for stem in stems.values() for kind in formats]
    with drawing(study, *names, of=of) as folder:
        for done, (what, draw) in enumerate(pages.items()):
            report(done, len(pages))
            with paper_style():
                sheet = draw(one)
                if sheet is not None:
                    paths += save_in_formats(sheet, folder, stems[what], formats)
    report(len(pages), len(pages))
    return paths


def check_cell(cells: pd.DataFrame, cell: int, of: Path, what: str) -> None:
    """Refuse a cell of which there is nothing to draw.

    Parameters
    ----------
    cells : DataFrame
        cell, status and reason.
    cell : int
    of : Path
        Folder of the result.
    what : str
        That there is nothing of, as "prediction".

    Raises
    ------
    ParameterError
        The cell is not in the table, or was left out: the message says why.
    """
    rows = cells[cells["cell"] == cell]
    if rows.empty:
        there = sorted(int(number) for number in cells["cell"])
        raise ParameterError(f"cell {cell} is not in {of}: it has {there}")
    if rows["status"].iloc[0] != "ok":
        raise ParameterError(f"cell {cell} has no {what} to draw: {rows['reason'].iloc[0]}")


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
