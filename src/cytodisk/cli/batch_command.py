"""`cytodisk batch`."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cytodisk.cli.console import console_for, count, fail, progress_bar
from cytodisk.cli.first_start import say_compiling
from cytodisk.cli.options import Given, GroupsFile, NoReport, Quiet, with_parameters
from cytodisk.runs.run_options import BatchOptions
from cytodisk.runs.told.compiling_words import with_nuclei_or_not
from cytodisk.runs.told.flag_words import MOST_FLAGS

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.batch.batch_file import Batch
    from cytodisk.runs.batch.batch_study import BatchSummary


@with_parameters(BatchOptions, file=False, groups=GroupsFile)
def batch_command(
    study: Annotated[Path, typer.Argument(metavar="STUDY", help="Batch file: TOML.", show_default=False)],
    out: Annotated[
        str,
        typer.Option(
            "--out",
            "-o",
            metavar="FOLDER",
            help="Folder for the results, or a URL as s3://bucket/batch.",
            show_default=False,
        ),
    ],
    given: Given,
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="List the inputs as they are understood and run nothing.")
    ] = False,
    no_report: NoReport = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.batch.batch_file import read_batch

    console = console_for(quiet)
    options = given.options(BatchOptions)
    batch = read_batch(study, given.groups)
    console.print(f"inputs: {len(batch.inputs)} ({_kinds(batch)})")
    if batch.groups is not None:
        console.print(f"groups: {batch.groups.path}, {count(len(batch.groups.keys), 'row')}")
    if dry_run:
        _list_inputs(batch)
        return
    from cytodisk.runs.batch.batch_study import batch_study

    kind = "movie" if any(one.kind == "movie" for one in batch.inputs) else "map"
    say_compiling(quiet, with_nuclei_or_not(kind, any(one.nuclei for one in batch.inputs)))
    with progress_bar(quiet, "inputs") as progress:
        summary = batch_study(
            batch,
            out,
            progress=progress,
            tell=console.print,
            **dict(options),
        )
    _finish(console, summary, not no_report)


def _kinds(batch: "Batch") -> str:
    movies = sum(item.kind == "movie" for item in batch.inputs)
    images = len(batch.inputs) - movies
    words = {"movies": movies, "images or folders of images": images}
    return ", ".join(f"{what} {number}" for what, number in words.items() if number)


def _list_inputs(batch: "Batch") -> None:
    """A line an input, as CSV, for a person or a program; exit code 2 for faults."""
    import csv
    from dataclasses import astuple, fields

    from cytodisk.runs.batch.dry_run import Understood, refuse_groups, understand
    from cytodisk.store.csv_tables import text_made_harmless

    writer = csv.writer(sys.stdout, lineterminator="\n")  # which writes None as an empty field

    def write(*values: Any) -> None:
        writer.writerow(
            [text_made_harmless(str(one)) if isinstance(one, str | Path) else one for one in values]
        )

    understood = [field.name for field in fields(Understood)]
    nuclei = any(item.nuclei for item in batch.inputs)
    write("name", "kind", "masks", "signal", *["nuclei"] * nuclei, *batch.columns, *understood)
    faults = 0
    for item in batch.inputs:
        found = understand(item)
        of_nuclei = [item.nuclei] * nuclei
        write(item.name, item.kind, item.masks, item.signal, *of_nuclei, *item.columns, *astuple(found))
        faults += bool(found.fault)
    for words in refuse_groups(batch):
        print(f"note: {words}", file=sys.stderr)
    if faults:
        fail(f"{faults} of {count(len(batch.inputs), 'input')} cannot be used: the column fault says why")


def _finish(console: "Console", summary: "BatchSummary", report: bool) -> None:
    total = sum(summary.statuses.values())
    done = summary.statuses.pop("ok", 0)
    lost = ", ".join(f"{number} {status}" for status, number in sorted(summary.statuses.items()))
    console.print(f"{done} of {count(total, 'input')} done" + (f"; {lost}" if lost else ""))
    for row in summary.failed:
        print(f"{row.input} {row.status}: {row.reason}", file=sys.stderr)
    if total - done > len(summary.failed):
        rest = total - done - len(summary.failed)
        print(f"… and {rest} more: columns 'status' and 'reason' of inputs.csv", file=sys.stderr)
    if summary.flags:
        most = ", ".join(f"{name} ({number})" for name, number in summary.flags.most_common(MOST_FLAGS))
        more = f", … {len(summary.flags) - MOST_FLAGS} more" if len(summary.flags) > MOST_FLAGS else ""
        console.print(f"QC flags, by number of inputs: {most}{more}; column 'flags' of inputs.csv")
    for remark in summary.remarks:
        console.print(f"note: {remark}")
    if lost:
        console.print("mend what failed and run the same command with --resume: only that is done again")
    console.print(f"tables: {summary.out}; studies of the inputs: {summary.out.rstrip('/')}/inputs")
    if report:
        _write_page(console, summary.out)
    if not done:
        fail("no input went well")


def _write_page(console: "Console", out: str) -> None:
    from cytodisk.cli.report.report_words import say_page
    from cytodisk.pages.report.page import write_batch_report
    from cytodisk.store.url_store import is_url

    if is_url(out):
        console.print("no report: the results are not on this computer; copy them and run cytodisk report")
        return
    say_page(console, lambda: write_batch_report(Path(out)))
