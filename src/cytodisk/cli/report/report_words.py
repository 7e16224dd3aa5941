"""The page that a run ends with, and what the console says of it."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from cytodisk.cli.console import progress_bar

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.cells.cell_inputs import CellInputs
    from cytodisk.store.study import Study

_STOPPED = "Stopped while the page was written: all results are there; cytodisk report writes the page."
_MOST_CELLS = 60  # with a picture on the page that a run ends with: a second or two


def page_of(study: "Study", inputs: "CellInputs", quiet: bool) -> Callable[[], Path]:
    """What writes the page of a study of single cells, with the files that the run has open.

    Parameters
    ----------
    study : Study
    inputs : CellInputs
    quiet : bool

    Returns
    -------
    callable
    """

    def write() -> Path:
        from cytodisk.pages.report.cells.cells_html import cells_page
        from cytodisk.pages.report.page import REPORT, write_page
        from cytodisk.runs.map.input_files import FoundInputs

        with progress_bar(
            quiet, "pictures of cells", stopped="Stopped while the page was written."
        ) as progress:
            return write_page(
                study.path,
                study.path / REPORT,
                lambda: cells_page(study, found=FoundInputs(inputs), most=_MOST_CELLS, progress=progress),
            )

    return write


def say_page(console: "Console", write: Callable[[], Path]) -> None:
    """Write a page and say where it is, or what to install for one."""
    from cytodisk.errors import MissingPartError

    try:
        page = write()
    except MissingPartError as missing:
        console.print(f"no report: {missing}")
        return
    say_written(console, page)


def say_written(console: "Console", page: Path) -> None:
    """Say where a page is."""
    console.print(f"report: {page} ({page.stat().st_size / 1e6:.1f} MB), open it in a browser")
