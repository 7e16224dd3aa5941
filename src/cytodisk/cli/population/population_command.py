"""`cytodisk population`."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cytodisk.cli.console import COMPLETE, console_for, progress_bar
from cytodisk.cli.options import Given, GroupsFile, NoReport, Quiet, with_parameters
from cytodisk.cli.population.kept_plan import keep_plan, refuse_kept_plan
from cytodisk.cli.population.planned import planned
from cytodisk.cli.population.population_said import say_population
from cytodisk.cli.report.report_words import say_page
from cytodisk.errors import ParameterError
from cytodisk.runs.population.population_parameters import PopulationParameters
from cytodisk.runs.population.power.power_parameters import PowerParameters
from cytodisk.runs.run_options import FigureOptions, PopulationOptions
from cytodisk.runs.told.speed_words import PERCENT
from cytodisk.store.study_kind import FIGURES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from rich.console import Console

    from cytodisk.store.populations.population_study import PopulationStudy


@with_parameters(
    PopulationParameters,
    PopulationOptions,
    FigureOptions,
    modes={"--power": PowerParameters},
    groups=GroupsFile,
)
def population_command(
    given: Given,
    paths: Annotated[
        list[Path] | None,
        typer.Argument(
            metavar="PATH",
            help="Folder that cytodisk batch, map, movie or shapes wrote, or a folder of such studies; "
            "several are put together.",
            show_default=False,
        ),
    ] = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", "-o", metavar="FOLDER", help="Folder for the results.", show_default=False),
    ] = None,
    figures: Annotated[bool, typer.Option(help="Draw the atlas, profiles and scalars.")] = True,
    power: Annotated[
        bool, typer.Option("--power", help="Plan: how many experiments find a difference of which size.")
    ] = False,
    no_report: NoReport = False,
    quiet: Quiet = False,
) -> None:
    console = console_for(quiet)
    wanted = given.formats(figures)
    if power:
        if out is not None and not given.values.get("overwrite"):
            refuse_kept_plan(out)
        table, notes = planned(console, given, paths or [], out is not None)
        if out is not None:
            keep_plan(out, table, notes, wanted)
            console.print(f"results: {out}")
        return
    if beyond := given.beyond(PopulationParameters, PopulationOptions, FigureOptions):
        raise ParameterError(f"{', '.join(beyond)}: only with --power; pass that too, or leave it out")
    if not paths:
        raise ParameterError(
            "PATH is missing: pass the folder that cytodisk batch, map, movie or shapes wrote"
        )
    if out is None:
        raise ParameterError("--out is missing: name a folder for the results, as -o atlas/")
    if named := [path.name for path in paths if path.suffix == ".h5ad"]:
        raise ParameterError(
            f"PATH {named[0]} is no folder of results: --h5ad takes no name, its file is in the folder of "
            f"--out; leave {named[0]} out"
        )
    study = _compare(console, given, paths, out)
    say_population(console, study)
    console.print(f"results: {study.path}")
    for path in sorted(study.path.glob("*.h5ad")):
        console.print(f"for scanpy: {path}")
    for line in _draw(console, study, wanted) if wanted else ():
        console.print(line)
    if not no_report:
        say_page(console, lambda: _page_of(study))


def _page_of(study: "PopulationStudy") -> Path:
    from cytodisk.pages.report.page import write_report

    return write_report(study)


def _compare(console: "Console", given: Given, paths: list[Path], out: Path) -> "PopulationStudy":
    from cytodisk.runs.population.run_population import run_population

    settings, options = given.of(PopulationParameters), given.options(PopulationOptions)
    steps: list[int] = []
    with progress_bar(console.quiet, PERCENT, stopped=_STOPPED) as progress:

        def report(done: int, total: int) -> None:
            steps.append(done)
            progress(done, total)

        study = run_population(
            paths, out, groups=given.groups, progress=report, parameters=settings, **dict(options)
        )
    if not steps and not console.quiet:
        print(COMPLETE, file=sys.stderr)
    return study


def _draw(console: "Console", study: "PopulationStudy", formats: "Sequence[str]") -> list[str]:
    """Draw all figures; what is said of them."""
    from cytodisk.pages.population.write_population_figures import missing_figures, write_population_figures
    from cytodisk.store.figures_folder import drawn_figures, note_drawn

    paths = drawn_figures(study.path, formats)
    stopped = f"Stopped while drawing; the tables are in {study.path}."
    if not paths:
        with progress_bar(console.quiet, "pages drawn", stopped=stopped) as progress:
            paths = write_population_figures(study, formats=formats, progress=progress)
        note_drawn(study.path, formats)
    names = ", ".join(dict.fromkeys(path.stem for path in paths))
    return [f"figures: {study.path / FIGURES} ({names})", *missing_figures(study)] if paths else []


_STOPPED = "Stopped; the results are not complete: run it again with --resume."
