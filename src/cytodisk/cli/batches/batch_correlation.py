"""`cytodisk correlate` on the folder of a batch."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cytodisk.cli.batches.said_pool import say_findings, say_inputs
from cytodisk.cli.console import console_for, progress_bar
from cytodisk.cli.report.report_words import say_page
from cytodisk.runs.told.speed_words import PERCENT

if TYPE_CHECKING:
    from cytodisk.runs.population.correlations.batch_correlate_parameters import BatchCorrelateParameters

_STOPPED = "Stopped; the movies that are done keep their correlations: run it again with --resume."


def correlate_batch(
    batch: Path,
    names: tuple[str | None, str],
    parameters: "BatchCorrelateParameters",
    *,
    groups: Path | None,
    formats: Sequence[str],
    options: dict[str, Any],
    quiet: bool,
) -> None:
    """Correlate all movies of a batch, pool them, draw the pooled curves and say what was found.

    Parameters
    ----------
    batch : Path
    names : (str or None, str)
        Signal, and what it is correlated with.
    parameters : BatchCorrelateParameters
    groups : Path or None
    formats : sequence of str
        Of the figure.
    options : dict
        Fields of `PoolOptions`.
    quiet : bool
    """
    from cytodisk.pages.population.pooled_page import write_pooled_figure
    from cytodisk.pages.report.page import write_batch_report
    from cytodisk.runs.population.correlations.run_batch_correlate import only_channel, run_batch_correlate

    console = console_for(quiet)
    signal = names[0] if names[0] is not None else only_channel(batch)
    with progress_bar(quiet, PERCENT, stopped=_STOPPED) as progress:
        found = run_batch_correlate(
            batch, signal, names[1], groups=groups, progress=progress, parameters=parameters, **options
        )
    figures = write_pooled_figure(found, formats=formats)
    say_inputs(console, found, "correlated")
    console.print("Positive lag: the signal comes first.")
    say_findings(console, found)
    console.print(f"pooled: {found.path}; figure: {', '.join(str(figure) for figure in figures)}")
    say_page(console, lambda: write_batch_report(batch))
