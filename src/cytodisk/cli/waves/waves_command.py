"""`cytodisk waves`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cytodisk.cli.batches.of_batch import GroupsOfBatch, refuse_cells, refuse_of_batch
from cytodisk.cli.console import console_for, progress_bar, say_lines
from cytodisk.cli.options import Figures, Given, MovieStudyOrBatch, Quiet, with_parameters
from cytodisk.cli.report.given_folder import is_batch
from cytodisk.cli.report.report_command import opened
from cytodisk.runs.population.pooling.pool_parameters import PoolOptions
from cytodisk.runs.population.wave_numbers.batch_waves_parameters import BatchWavesParameters
from cytodisk.runs.run_options import FigureOptions, TableOptions
from cytodisk.runs.told.flag_words import wave_flag_lines
from cytodisk.runs.told.speed_words import PERCENT
from cytodisk.runs.told.wave_lines import earlier_waves, wave_finding_lines, wave_lines
from cytodisk.runs.waves.wave_run_parameters import WavesParameters

if TYPE_CHECKING:
    from cytodisk.store.study import Study
    from cytodisk.store.waves.waves_store import Waves

NOTHING_CHANGED = "Stopped; nothing was changed."


@with_parameters(BatchWavesParameters, PoolOptions, FigureOptions, groups=GroupsOfBatch)
def waves_command(
    study: MovieStudyOrBatch,
    given: Given,
    signal: Annotated[
        str,
        typer.Option(metavar="CHANNEL", help="velocity, velocity_cell_frame or a channel of the study."),
    ] = "velocity",
    cell: Annotated[
        list[int] | None, typer.Option(metavar="NUMBER", help="Only this cell; can be given again.")
    ] = None,
    figures: Figures = 4,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.waves.waves_study import waves_study

    formats = given.formats(figures)
    if is_batch(study):
        _waves_batch(study, given, signal, cell, formats or ("png",), quiet)
        return
    refuse_of_batch(study, given, WavesParameters, TableOptions, FigureOptions)
    settings, options = given.of(WavesParameters), given.options(TableOptions)
    console = console_for(quiet)
    there = opened(console, study)
    before = earlier_waves(there, signal, settings)
    with progress_bar(quiet, PERCENT, stopped=NOTHING_CHANGED) as progress:
        found = waves_study(
            there, signal, cells=cell, progress=progress, parameters=settings, **dict(options)
        )
    whole = opened(None, study)
    say_lines(console, wave_finding_lines(found, whole))
    draw_waves(quiet, whole, found, figures, formats)
    say_lines(console, wave_lines(found, whole))
    say_lines(console, wave_flag_lines(whole, found))
    if before:
        console.print(f"{before}; to keep both, add --name NAME.")
    console.print(f"results: {found.path}")


def _waves_batch(
    batch: Path,
    given: Given,
    signal: str,
    cells: list[int] | None,
    formats: Sequence[str],
    quiet: bool,
) -> None:
    from cytodisk.cli.batches.batch_waves import waves_batch

    refuse_cells(batch, cells)
    settings, options = given.of(BatchWavesParameters), dict(given.options(PoolOptions))
    waves_batch(batch, signal, settings, groups=given.groups, formats=formats, options=options, quiet=quiet)


def draw_waves(quiet: bool, study: "Study", found: "Waves", figures: int, formats: Sequence[str]) -> None:
    """Draw the first cells in which waves were looked for."""
    from cytodisk.pages.waves.wave_files import write_wave_figures

    done = [int(cell) for cell in found.cells.loc[found.cells["status"] == "ok", "cell"]]
    cells = done if figures < 0 else done[:figures]
    if cells:
        stopped = f"Stopped while drawing; the tables are in {found.path}."
        with progress_bar(quiet, "cells drawn", total=len(cells), stopped=stopped) as progress:
            for place, cell in enumerate(cells):
                write_wave_figures(study, found, cell=cell, formats=formats)
                progress(place + 1, len(cells))
