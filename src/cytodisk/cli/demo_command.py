"""`cytodisk demo`."""

from importlib import import_module
from pathlib import Path
from typing import Annotated

import typer

from cytodisk.cli.console import console_for, progress_bar, say_lines
from cytodisk.cli.correlate_command import NOTHING_CHANGED, draw_correlation
from cytodisk.cli.first_start import say_compiling
from cytodisk.cli.movie_command import draw_movie, finish_movie, say_movie
from cytodisk.cli.options import Given, Quiet, with_parameters
from cytodisk.cli.report.report_command import write_page
from cytodisk.errors import MissingPartError
from cytodisk.runs.run_options import FigureOptions
from cytodisk.runs.told.correlation_words import correlation_lines, finding_lines, verdict_lines
from cytodisk.runs.told.flag_words import study_flag_lines

_AGAIN = "run the same command again"


@with_parameters(FigureOptions, file=False)
def demo_command(
    given: Given,
    out: Annotated[Path, typer.Option("--out", "-o", metavar="FOLDER", help="Folder for the demo.")] = Path(
        "cytodisk_demo"
    ),
    seed: Annotated[int, typer.Option(metavar="NUMBER", help="Seed of the simulated movie.")] = 0,
    workers: Annotated[int, typer.Option(metavar="NUMBER", help="Processes that map; one more draws.")] = 1,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in OUT/study.")] = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.correlate.correlate_study import correlate_study
    from cytodisk.runs.demo_input import LAYERS, compare_with_truth, write_demo_input
    from cytodisk.runs.executor import Executor
    from cytodisk.runs.movie.movie_inputs import open_movie
    from cytodisk.runs.movie.movie_parameters import MovieParameters
    from cytodisk.runs.movie.movie_study import movie_study
    from cytodisk.runs.warm_up import warm_up

    console, formats = console_for(quiet), given.options(FigureOptions).format
    with Executor(1, apart=True) as beside:
        if say_compiling(quiet, "movie"):
            beside.submit(warm_up, True)
        beside.submit(_load_drawing)
        truth, masks, signal = write_demo_input(out / "input", seed, overwrite=overwrite)
        console.print(
            f"A simulated cell in {len(truth.masks)} frames, with two signals, is in {masks.parent}."
        )
        console.print(
            f"The same by hand: cytodisk movie {masks} --signal {signal} -o {out / 'mine'} "
            f"--layers {LAYERS}\n"
        )
        inputs = open_movie(masks, signal, MovieParameters(layers=LAYERS))
        say_movie(console, inputs)
        with progress_bar(quiet, "frames", again=_AGAIN) as progress:
            study = movie_study(
                inputs,
                out / "study",
                workers=workers,
                resume=not overwrite,
                overwrite=overwrite,
                progress=progress,
            )
        drawings = [beside.submit(_draw_movie, masks, signal, study.path, formats)]
        finish_movie(console, study, flags=False)  # the report's lines have them
        with progress_bar(quiet, "percent", stopped=NOTHING_CHANGED) as progress:
            found = correlate_study(study, "edge", "velocity", progress=progress)
        drawings.append(beside.submit(_draw_correlation, study.path, formats))
        say_lines(console, correlation_lines(found, study))
        try:
            write_page(console, quiet, study)
        except MissingPartError as missing:
            say_lines(console, study_flag_lines(study))
            console.print(f"no report: {missing}")
        say_lines(console, verdict_lines(found))
        say_lines(console, finding_lines(found, study))
        with progress_bar(quiet, "drawings", total=len(drawings), again=_AGAIN) as progress:
            for number, drawing in enumerate(drawings):
                drawing.result()
                progress(number + 1, len(drawings))
    console.print("")
    for what, answer in compare_with_truth(study, truth).items():
        console.print(f"{what}: {answer}")


def _load_drawing() -> None:
    """Let a process be ready to draw."""
    import_module("cytodisk.pages.movie_pages")


def _draw_movie(masks: Path, signal: Path, study: Path, formats: tuple[str, ...]) -> None:
    from cytodisk.runs.demo_input import LAYERS
    from cytodisk.runs.movie.movie_inputs import open_movie
    from cytodisk.runs.movie.movie_parameters import MovieParameters
    from cytodisk.store.study import open_study

    inputs = open_movie(masks, signal, MovieParameters(layers=LAYERS))
    draw_movie(True, open_study(study), inputs, 1, formats)


def _draw_correlation(study: Path, formats: tuple[str, ...]) -> None:
    from cytodisk.store.study import open_study

    there = open_study(study)
    draw_correlation(True, there, there.correlation("edge", "velocity"), 1, formats)
