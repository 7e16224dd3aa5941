"""`write_report`: one self-contained HTML page of a study, a batch or a population."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

from cytodisk.errors import ParameterError, StudyError
from cytodisk.files import real_path, replacing
from cytodisk.images.signal_files import FrameSource
from cytodisk.pages.report.batches.batch_html import batch_page
from cytodisk.pages.report.cells.cells_html import cells_page
from cytodisk.pages.report.movie_page import movie_page, open_cell
from cytodisk.pages.report.populations.population_html import population_page
from cytodisk.pages.report.template import jinja
from cytodisk.runs.findings.movie_finding import usual_cell
from cytodisk.store.inputs.study_signal import shown_signal
from cytodisk.store.populations.population_study import PopulationStudy
from cytodisk.store.study import Study
from cytodisk.store.written_files import writing_files

REPORT = "report.html"

Progress = Callable[[int, int], None]


def write_report(
    study: Study | PopulationStudy,
    path: str | os.PathLike[str] | None = None,
    *,
    cell: int | None = None,
    signal: FrameSource | None = None,
    progress: Progress | None = None,
) -> Path:
    """Write the page of a study: what was found first, then QC flags or warnings, then views of it.

    Of a movie these are linked views of one cell; of single masks all cells to sort and to open; of a
    population the conditions and their difference, window by window. The page is one file that needs no
    network: scripts, pictures and numbers are inside.

    Parameters
    ----------
    study : Study or PopulationStudy
    path : path-like, optional
        By default report.html in the study, or report_cell_00003.html for a cell that is not the usual one.
    cell : int, optional
        Of a movie the cell to show, by default the one with the most mapped frames; of single masks the first
        cell with a picture, for studies with more cells than a page has room for.
    signal : FrameSource, optional
        The movie behind the windows, with the study's channels; by default the file that the study names,
        if it is still there and unchanged. Otherwise the page shows windows over plain masks, and says so.
    progress : callable, optional
        Called with the number of frames, or cells, done and that of all.

    Returns
    -------
    Path
        Path of the page.

    Raises
    ------
    StudyError
        No frame of a movie is mapped, or the page cannot be written.
    ParameterError
        The study has no such cell, none of its frames is mapped, a page cannot hold so many windows, or
        `cell` or `signal` are given where they mean nothing.
    SignalError
        The signal has images of another size, other channels or fewer frames than the study.
    MissingPartError
        The parts for reports are not installed.

    See Also
    --------
    qc_flags : What the page says first.

    Examples
    --------
    >>> import tifffile
    >>> import cytodisk as cd
    >>> tifffile.imwrite("labels.tif", cd.simulate.label_image(cells=3))
    >>> study = cd.run_map("labels.tif", "out", layers=2, sectors=6)
    >>> cd.write_report(study).name
    'report.html'
    """
    if isinstance(study, PopulationStudy):
        return _write_population(study, path, cell, signal)
    if study.is_movie:
        return _write_movie(study, path, cell, signal, progress)
    if signal is not None:
        raise ParameterError(
            "signal is for movies: put the images of single masks where they were, and run again"
        )
    jinja()  # before any work is done
    first = int(study.cells["cell"].iloc[0]) if cell is None else cell
    target = study.path / _name(first, int(study.cells["cell"].iloc[0])) if path is None else Path(path)
    return write_page(study.path, target, lambda: cells_page(study, first, progress=progress))


def _write_population(
    study: PopulationStudy,
    path: str | os.PathLike[str] | None,
    cell: int | None,
    signal: FrameSource | None,
) -> Path:
    if cell is not None or signal is not None:
        name = "signal" if cell is None else "cell"
        raise ParameterError(f"{name} is for the study of one input, not for a population: leave it out")
    target = study.path / REPORT if path is None else Path(path)
    return write_page(study.path, target, lambda: population_page(study))


def write_batch_report(folder: Path, path: str | os.PathLike[str] | None = None) -> Path:
    """Write the page of a batch: its inputs and cells to sort and filter, linked to the pages of its studies.

    Parameters
    ----------
    folder : Path
        Of the batch.
    path : path-like, optional
        By default report.html in the folder.

    Returns
    -------
    Path
        Path of the page.

    Raises
    ------
    ReadError
        The folder holds no complete batch.
    MissingPartError
        The parts for reports are not installed.
    """
    jinja()
    target = folder / REPORT if path is None else Path(path)
    return write_page(folder, target, lambda: batch_page(folder))


def _write_movie(
    study: Study,
    path: str | os.PathLike[str] | None,
    cell: int | None,
    signal: FrameSource | None,
    progress: Progress | None,
) -> Path:
    jinja()  # before any work is done
    usual = usual_cell(study)
    if usual is None:
        raise StudyError(f"study {study.path} has no mapped frame: column 'reason' of cells.parquet says why")
    shown = open_cell(study, usual if cell is None else cell)
    target = study.path / _name(shown.cell, usual) if path is None else Path(path)
    return write_page(study.path, target, lambda: movie_page(shown, shown_signal(study, signal), progress))


def _name(cell: int, usual: int) -> str:
    return REPORT if cell == usual else f"report_cell_{cell:05d}.html"


def write_page(study: Path, target: Path, page: Callable[[], str]) -> Path:
    """Write a page whole or not at all; in the folder of a study it counts as the study's.

    Parameters
    ----------
    study : Path
        Folder of the study.
    target : Path
    page : callable
        Gives the text.

    Returns
    -------
    Path
        The target.
    """
    if not target.parent.is_dir():
        raise StudyError(f"cannot write {target}: there is no folder {target.parent}")
    html = page()
    own = [target.name] if real_path(target.parent) == real_path(study) else []
    with writing_files(study, *own), replacing(target) as temporary:
        temporary.write_text(html, encoding="utf-8")
    return target
