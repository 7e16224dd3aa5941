"""`cytodisk correlate` on the folder of a batch."""

import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cytodisk.cli.console import console_for, count, progress_bar
from cytodisk.cli.report.report_words import say_page
from cytodisk.runs.told.speed_words import PERCENT

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.population.correlations.batch_correlate_parameters import BatchCorrelateParameters
    from cytodisk.store.populations.pooled_correlation import PooledCorrelation

_STOPPED = "Stopped; the movies that are done keep their correlations: run it again with --resume."
_MOST_FAILED = 20


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
    _say(console, found)
    console.print(f"pooled: {found.path}; figure: {', '.join(str(figure) for figure in figures)}")
    say_page(console, lambda: write_batch_report(batch))


def _say(console: "Console", found: "PooledCorrelation") -> None:
    """How many movies are in, what was found, and what speaks against it."""
    studies = found.studies
    console.print(_count_words(Counter(studies["status"]), len(studies)))
    lost = [*studies[~studies["status"].isin(["ok", "kept"])].itertuples()]
    for row in lost[:_MOST_FAILED]:
        print(f"{row.input} {row.status}: {row.reason}", file=sys.stderr)
    if len(lost) > _MOST_FAILED:
        print(f"… and {len(lost) - _MOST_FAILED} more: studies.parquet in {found.path}", file=sys.stderr)
    cells = found.cells[found.cells["status"] != "ok"]
    if len(cells):
        console.print(f"{count(len(cells))} left out: column reason of cells.parquet says why")
    flagged = int((found.cells["qc_flags"].fillna("") != "").sum())
    if flagged:
        console.print(f"{count(flagged)} with QC flags are in: column qc_flags of cells.parquet names them")
    console.print("Positive lag: the signal comes first.")
    for words in found.sentences:
        console.print(words)
    for one in found.warnings:
        console.print(f"Warning: {one['name']}: {one['finding']} {one['consequence']} {one['remedy']}")


def _count_words(statuses: Counter[str], whole: int) -> str:
    done = statuses.pop("ok", 0) + (kept := statuses.pop("kept", 0))
    words = f"{done} of {count(whole, 'input')} correlated" + (f", {kept} of them before" if kept else "")
    return "; ".join([words, *(f"{number} {status}" for status, number in sorted(statuses.items()))])
