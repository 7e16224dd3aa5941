"""`cytodisk report`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cytodisk.cli.console import console_for, earlier_version_lines, progress_bar, say_lines
from cytodisk.cli.options import Quiet
from cytodisk.cli.report.given_folder import is_batch, is_run
from cytodisk.cli.report.report_words import say_page, say_written
from cytodisk.runs.told.flag_words import file_names, flag_lines

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.store.study import Study

_NOTHING_CHANGED = "Stopped; nothing was changed."


def report_command(
    study: Annotated[
        Path,
        typer.Argument(
            metavar="STUDY", help="Folder of a study, a batch or a population.", show_default=False
        ),
    ],
    cell: Annotated[
        int | None,
        typer.Option(
            metavar="NUMBER",
            help="Of a movie the cell to show (default that with the most frames); of single masks the first "
            "cell with a picture.",
        ),
    ] = None,
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="PATH", help="The page (default STUDY/report.html).")
    ] = None,
    signal: Annotated[
        Path | None, typer.Option(metavar="PATH", help="The movie's image, if it is no longer where it was.")
    ] = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Of a batch: keep the pages that are younger than their studies.")
    ] = False,
    quiet: Quiet = False,
) -> None:
    console = console_for(quiet)
    if is_batch(study):
        from cytodisk.cli.report.batch_report import report_batch
        from cytodisk.pages.report.page import write_batch_report

        _refuse_of_study(study, {"--cell": cell, "--out": out, "--signal": signal})
        report_batch(study, resume=resume, quiet=quiet)
        say_page(console, lambda: write_batch_report(study))
        return
    if is_run(study, "population"):
        from cytodisk.pages.report.page import write_report
        from cytodisk.store.populations.population_study import open_population_study

        _refuse_of_study(study, {"--cell": cell, "--signal": signal})
        say_page(console, lambda: write_report(open_population_study(study), out))
        return
    write_page(console, quiet, opened(console, study), out, cell, signal)


def _refuse_of_study(batch: Path, flags: dict[str, Any]) -> None:
    from cytodisk.errors import ParameterError

    if given := [flag for flag, value in flags.items() if value is not None]:
        raise ParameterError(
            f"{', '.join(given)}: not for a batch or a population, whose studies each have a page in their "
            "folder: leave it out, or name the folder of one of them"
        )


def opened(console: "Console | None", path: Path) -> "Study":
    """Open a study and say if its maps are of an earlier version; nothing without a console."""
    from cytodisk.store.provenance_file import other_maps
    from cytodisk.store.study import open_study

    with earlier_version_lines(lambda _: None):
        study = open_study(path)
    if console is not None and (words := other_maps(study.provenance)):
        console.print(words)
    return study


def write_page(
    console: "Console",
    quiet: bool,
    study: "Study",
    out: Path | None = None,
    cell: int | None = None,
    signal: Path | None = None,
    flags: bool = True,
) -> None:
    """Write the report and say where it is and, with `flags`, what is wrong with the study."""
    from cytodisk.pages.report.movie_page import EARLIER_MAPS, page_flags
    from cytodisk.pages.report.page import write_report
    from cytodisk.runs.qc_flags.study_flags import qc_flags
    from cytodisk.store.inputs.study_signal import open_signal

    image = open_signal(study, signal) if signal is not None else None
    unit = "frames" if study.is_movie else "cells"
    with progress_bar(quiet, unit, stopped=_NOTHING_CHANGED) as progress:
        page = write_report(study, out, cell=cell, signal=image, progress=progress)
    if flags:
        found = page_flags(study, image) if study.is_movie else qc_flags(study)
        shown = [flag for flag in found if flag.name != EARLIER_MAPS]  # said at the start
        say_lines(console, flag_lines(shown, "they are first on the page", file_names(study)))
    say_written(console, page)
