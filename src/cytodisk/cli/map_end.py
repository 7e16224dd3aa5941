"""How `cytodisk map` ends: overview, page, and what came out."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from cytodisk.cli.console import fail, say_lines, say_losses
from cytodisk.cli.report.report_words import say_page
from cytodisk.number_words import counted
from cytodisk.runs.told.flag_words import study_flag_lines
from cytodisk.runs.told.map_words import lost_cell_lines, map_fault, map_lines, signal_finding_lines
from cytodisk.store.nuclei.summary_columns import channels_among

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.store.study import Study


def draw_totals(study: "Study", formats: Sequence[str]) -> None:
    """Draw the overview of many cells, and that of their nuclei."""
    from cytodisk.pages.overview import write_overview
    from cytodisk.store.figures_folder import drawing

    if len(study.cells) > 1:
        names = [f"overview.{kind}" for kind in formats]
        with drawing(study.path, *names) as folder:
            for name in names:
                write_overview(folder / name, study.cells)
        _draw_nuclei(study, formats)


def finish_map(
    console: "Console",
    study: "Study",
    figures: int,
    of_folder: bool,
    write_page: Callable[[], Path] | None = None,
) -> None:
    """Write the page and say what came out; exit code 2 if that is nothing, or an input is damaged."""
    rows = study.cells
    say_lines(console, map_lines(study, of_folder))
    say_losses(lost_cell_lines(study, of_folder))
    if 0 < figures < int((rows["status"] == "ok").sum()):
        console.print(f"figures drawn for the first {counted(figures, 'cell')}: --figures -1 draws all")
    say_lines(console, study_flag_lines(study))
    say_lines(console, signal_finding_lines(study))
    console.print(f"results: {study.path}")
    if write_page is not None:
        say_page(console, write_page)
    if fault := map_fault(study, of_folder):
        fail(fault)


def _draw_nuclei(study: "Study", formats: Sequence[str]) -> None:
    """The picture of nucleus and cytoplasm; lines by layer only of as many cells as can be told apart."""
    from cytodisk.pages.nuclei_page import MOST_CELLS, write_nuclei_figure
    from cytodisk.store.figures_folder import drawing

    if not channels_among(map(str, study.cells)):
        return
    few = (study.cells["status"] == "ok").sum() <= MOST_CELLS
    profile = study.nuclear_profile if few else None
    names = [f"nuclei.{kind}" for kind in formats]
    with drawing(study.path, *names) as folder:
        for name in names:
            write_nuclei_figure(folder / name, study.cells, profile)
