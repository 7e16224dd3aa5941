"""Pooled results of a batch, written as figure files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from cytodisk.pages.figure_formats import chosen_formats, save_in_formats
from cytodisk.pages.sheet import Sheet
from cytodisk.plot.style import paper_style
from cytodisk.store.figures_folder import drawing


def save_pooled(folder: Path, figure: str, draw: Callable[[], Sheet], formats: Sequence[str]) -> list[Path]:
    """Draw a page into the folder `figures` of pooled results, two folders below their batch.

    Parameters
    ----------
    folder : Path
        Of the results.
    figure : str
        Name of its files.
    draw : callable
    formats : sequence of {"png", "pdf", "svg"}

    Raises
    ------
    ParameterError
        A format is unknown.
    StudyError
        The folder cannot be written.
    """
    chosen = chosen_formats(formats)
    names = [f"{figure}.{kind}" for kind in chosen]
    with drawing(folder.parents[1], *names, of=folder) as figures, paper_style():
        return save_in_formats(draw(), figures, figure, chosen)
