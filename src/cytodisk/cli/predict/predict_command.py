"""`cytodisk predict`."""

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
from cytodisk.runs.population.predictions.batch_predict_parameters import BatchPredictParameters
from cytodisk.runs.predict.predict_parameters import PredictParameters
from cytodisk.runs.run_options import FigureOptions, TableOptions
from cytodisk.runs.told.flag_words import flag_lines
from cytodisk.runs.told.prediction_words import (
    prediction_finding_lines,
    prediction_lines,
    replaced_prediction_words,
)
from cytodisk.runs.told.speed_words import PERCENT

if TYPE_CHECKING:
    from cytodisk.store.predictions.prediction_store import Prediction
    from cytodisk.store.study import Study

NOTHING_CHANGED = "Stopped; nothing was changed."


@with_parameters(BatchPredictParameters, PoolOptions, FigureOptions, groups=GroupsOfBatch)
def predict_command(
    study: MovieStudyOrBatch,
    given: Given,
    source: Annotated[
        str | None,
        typer.Option(metavar="CHANNEL", help="Signal whose past is used: a channel, or velocity."),
    ] = None,
    target: Annotated[
        str | None,
        typer.Option(
            metavar="CHANNEL",
            help="Signal that is predicted: velocity, velocity_cell_frame or a channel; by default velocity. "
            "Without --source and --target all channels and velocity are tested against each other.",
        ),
    ] = None,
    cell: Annotated[
        list[int] | None, typer.Option(metavar="NUMBER", help="Only this cell; can be given again.")
    ] = None,
    figures: Figures = 4,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.predict.predict_study import VELOCITY, predict_study

    formats = given.formats(figures)
    if source is not None and target is None:
        target = VELOCITY
    if is_batch(study):
        _predict_batch(study, given, (source, target), cell, formats or ("png",), quiet)
        return
    refuse_of_batch(study, given, PredictParameters, TableOptions, FigureOptions)
    settings, options = given.of(PredictParameters), given.options(TableOptions)
    console = console_for(quiet)
    there = opened(console, study)
    names = (source or "", target or "", settings.name)
    if words := replaced_prediction_words(there, names, settings.model_dump()):
        console.print(f"{words}. To keep both, stop with Ctrl-C and add --name NAME.")
    with progress_bar(quiet, PERCENT, stopped=NOTHING_CHANGED) as progress:
        found = predict_study(
            there, source, target, cells=cell, progress=progress, parameters=settings, **dict(options)
        )
    whole = opened(None, study)
    say_lines(console, prediction_finding_lines(found, whole))
    say_lines(console, prediction_lines(found, whole))
    say_lines(console, _flag_lines(whole, found))
    draw_prediction(quiet, whole, found, figures, formats)


def _predict_batch(
    batch: Path,
    given: Given,
    names: tuple[str | None, str | None],
    cells: list[int] | None,
    formats: Sequence[str],
    quiet: bool,
) -> None:
    from cytodisk.cli.batches.batch_prediction import predict_batch

    refuse_cells(batch, cells)
    settings, options = given.of(BatchPredictParameters), dict(given.options(PoolOptions))
    predict_batch(batch, names, settings, groups=given.groups, formats=formats, options=options, quiet=quiet)


def draw_prediction(
    quiet: bool, study: "Study", found: "Prediction", figures: int, formats: Sequence[str]
) -> None:
    """Draw the first cells that were tested."""
    from cytodisk.pages.prediction.prediction_files import write_prediction_figures

    done = [int(cell) for cell in found.links["cell"].unique()]
    cells = done if figures < 0 else done[:figures]
    if cells:
        stopped = f"Stopped while drawing; the tables are in {found.path}."
        with progress_bar(quiet, "cells drawn", total=len(cells), stopped=stopped) as progress:
            for place, cell in enumerate(cells):
                write_prediction_figures(study, found, cell=cell, formats=formats)
                progress(place + 1, len(cells))


def _flag_lines(study: "Study", found: "Prediction") -> Sequence[str]:
    """QC flags of the run, and of this prediction."""
    from cytodisk.runs.qc_flags.one_prediction import with_one_prediction
    from cytodisk.runs.qc_flags.study_flags import qc_flags
    from cytodisk.runs.told.flag_words import file_names

    shown = qc_flags(with_one_prediction(study, found))
    return list(flag_lines(shown, f"see cytodisk report {study.path}", file_names(study)))
