"""`cytodisk predict` on the folder of a batch."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cytodisk.cli.batches.said_pool import say_findings, say_inputs
from cytodisk.cli.console import console_for, progress_bar
from cytodisk.cli.report.report_words import say_page
from cytodisk.runs.told.speed_words import PERCENT

if TYPE_CHECKING:
    from cytodisk.runs.population.predictions.batch_predict_parameters import BatchPredictParameters

_STOPPED = "Stopped; the movies that are done keep their predictions: run it again with --resume."


def predict_batch(
    batch: Path,
    names: tuple[str | None, str | None],
    parameters: "BatchPredictParameters",
    *,
    groups: Path | None,
    formats: Sequence[str],
    options: dict[str, Any],
    quiet: bool,
) -> None:
    """Test in all movies of a batch which signals predict which, pool them, draw them and say what was found.

    Parameters
    ----------
    batch : Path
    names : (str or None, str or None)
        Source and target; both None for a network of all signals.
    parameters : BatchPredictParameters
    groups : Path or None
    formats : sequence of str
        Of the figure.
    options : dict
        Fields of `PoolOptions`.
    quiet : bool
    """
    from cytodisk.pages.population.pooled_gain_page import write_pooled_gains
    from cytodisk.pages.report.page import write_batch_report
    from cytodisk.runs.population.predictions.run_batch_predict import run_batch_predict

    console = console_for(quiet)
    with progress_bar(quiet, PERCENT, stopped=_STOPPED) as progress:
        found = run_batch_predict(
            batch, names[0], names[1], groups=groups, progress=progress, parameters=parameters, **options
        )
    say_findings(console, found)
    say_inputs(console, found, "tested")
    figures = write_pooled_gains(found, formats=formats)
    console.print(f"pooled: {found.path}; figure: {', '.join(str(figure) for figure in figures)}")
    say_page(console, lambda: write_batch_report(batch))
