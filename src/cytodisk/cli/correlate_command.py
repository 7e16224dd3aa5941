"""`cytodisk correlate`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cytodisk.cli.batches.of_batch import GroupsOfBatch, refuse_cells, refuse_of_batch
from cytodisk.cli.console import console_for, progress_bar, say_lines
from cytodisk.cli.options import Figures, Given, MovieStudyOrBatch, Quiet, with_parameters
from cytodisk.cli.report.given_folder import is_batch
from cytodisk.cli.report.report_command import opened
from cytodisk.runs.correlate.correlate_parameters import CorrelateParameters
from cytodisk.runs.population.correlations.batch_correlate_parameters import BatchCorrelateParameters
from cytodisk.runs.population.pooling.pool_parameters import PoolOptions
from cytodisk.runs.run_options import FigureOptions, TableOptions
from cytodisk.runs.told.correlation_words import (
    correlation_lines,
    earlier_settings,
    finding_lines,
    replaced_words,
    verdict_lines,
)
from cytodisk.runs.told.flag_words import study_flag_lines

if TYPE_CHECKING:
    from cytodisk.store.correlation_store import Correlation
    from cytodisk.store.study import Study

NOTHING_CHANGED = "Stopped; nothing was changed."


@with_parameters(BatchCorrelateParameters, PoolOptions, FigureOptions, groups=GroupsOfBatch)
def correlate_command(
    study: MovieStudyOrBatch,
    given: Given,
    signal: Annotated[
        str | None,
        typer.Option(metavar="CHANNEL", help="Channel of the study; not needed if there is only one."),
    ] = None,
    with_: Annotated[
        str, typer.Option("--with", metavar="CHANNEL", help="velocity, velocity_cell_frame or a channel.")
    ] = "velocity",
    cell: Annotated[
        list[int] | None, typer.Option(metavar="NUMBER", help="Only this cell; can be given again.")
    ] = None,
    figures: Figures = 4,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.correlate.correlate_study import correlate_study
    from cytodisk.runs.used_series.chosen_of_study import channels_of

    formats = given.formats(figures)
    if is_batch(study):
        _correlate_batch(study, given, (signal, with_), cell, formats or ("png",), quiet)
        return
    refuse_of_batch(study, given, CorrelateParameters, TableOptions, FigureOptions)
    settings, options = given.of(CorrelateParameters), given.options(TableOptions)
    console = console_for(quiet)
    there = opened(console, study)
    chosen = signal if signal is not None else _only(channels_of(there))
    before = earlier_settings(there, chosen, with_, settings.name)
    if words := replaced_words(before, settings.model_dump()):
        console.print(f"{words}. To keep both, stop with Ctrl-C and add --name NAME.")
    with progress_bar(quiet, "percent", stopped=NOTHING_CHANGED) as progress:
        found = correlate_study(
            there, chosen, with_, cells=cell, progress=progress, parameters=settings, **dict(options)
        )
    draw_correlation(quiet, there, found, figures, formats)
    say_lines(console, correlation_lines(found, there))
    whole = opened(None, study)
    say_lines(console, study_flag_lines(whole, found))
    say_lines(console, verdict_lines(found))
    say_lines(console, finding_lines(found, whole))


def _correlate_batch(
    batch: Path,
    given: Given,
    names: tuple[str | None, str],
    cells: list[int] | None,
    formats: Sequence[str],
    quiet: bool,
) -> None:
    from cytodisk.cli.batches.batch_correlation import correlate_batch

    refuse_cells(batch, cells)
    settings, options = given.of(BatchCorrelateParameters), dict(given.options(PoolOptions))
    correlate_batch(
        batch, names, settings, groups=given.groups, formats=formats, options=options, quiet=quiet
    )


def draw_correlation(
    quiet: bool, study: "Study", found: "Correlation", figures: int, formats: Sequence[str]
) -> None:
    """Draw the first cells that were correlated."""
    from cytodisk.pages.correlation_files import write_correlation_figures

    done = [int(cell) for cell in found.windows["cell"].unique()]
    cells = done if figures < 0 else done[:figures]
    if cells:
        stopped = f"Stopped while drawing; the tables are in {found.path}."
        with progress_bar(quiet, "cells drawn", total=len(cells), stopped=stopped) as progress:
            for place, cell in enumerate(cells):
                write_correlation_figures(study, found, cell=cell, formats=formats)
                progress(place + 1, len(cells))


def _only(names: list[str]) -> str:
    from cytodisk.errors import ParameterError

    if len(names) == 1:
        return names[0]
    raise ParameterError(f"signal is not given: pass --signal with one of {', '.join(map(repr, names))}")
