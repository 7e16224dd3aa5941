"""`cytodisk waves` on the folder of a batch."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cytodisk.cli.batches.said_pool import say_findings, say_inputs
from cytodisk.cli.console import console_for, progress_bar
from cytodisk.cli.report.report_words import say_page
from cytodisk.runs.told.speed_words import PERCENT

if TYPE_CHECKING:
    from cytodisk.runs.population.wave_numbers.batch_waves_parameters import BatchWavesParameters

_STOPPED = "Stopped; the movies that are done keep their waves: run it again with --resume."


def waves_batch(
    batch: Path,
    signal: str,
    parameters: "BatchWavesParameters",
    *,
    groups: Path | None,
    formats: Sequence[str],
    options: dict[str, Any],
    quiet: bool,
) -> None:
    """Look for waves in all movies of a batch, pool them, draw them and say what was found.

    Parameters
    ----------
    batch : Path
    signal : str
    parameters : BatchWavesParameters
    groups : Path or None
    formats : sequence of str
        Of the figure.
    options : dict
        Fields of `PoolOptions`.
    quiet : bool
    """
    from cytodisk.pages.population.pooled_wave_page import write_pooled_waves
    from cytodisk.pages.report.page import write_batch_report
    from cytodisk.runs.population.wave_numbers.run_batch_waves import run_batch_waves

    console = console_for(quiet)
    with progress_bar(quiet, PERCENT, stopped=_STOPPED) as progress:
        found = run_batch_waves(
            batch, signal, groups=groups, progress=progress, parameters=parameters, **options
        )
    say_findings(console, found)
    say_inputs(console, found, "looked at")
    figures = write_pooled_waves(found, formats=formats)
    console.print(f"pooled: {found.path}; figure: {', '.join(str(figure) for figure in figures)}")
    say_page(console, lambda: write_batch_report(batch))
