"""`cytodisk demo` and `cytodisk info`."""

import platform
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

import typer

from cytodisk.cli.console import console_for, progress_bar
from cytodisk.cli.correlate_command import NOTHING_CHANGED, draw_correlation, write_page
from cytodisk.cli.correlation_words import say_correlation
from cytodisk.cli.movie_command import draw_movie, finish_movie, say_movie
from cytodisk.cli.options import Quiet
from cytodisk.errors import MissingPartError
from cytodisk.runs.versions import NOT_INSTALLED, PACKAGES, PARTS, installed

_AGAIN = "run the same command again"


def info_command() -> None:
    """Print versions, and which optional parts are there."""
    print(f"python\t{platform.python_version()} on {platform.platform()}")
    optional = {name for packages in PARTS.values() for name in packages}
    for name, number in installed(PACKAGES).items():
        if name not in optional:
            print(f"{name}\t{number}")
    for part, packages in PARTS.items():
        print(f"{part}\t{_part_words(part, installed(packages))}")
    print("image formats\tTIFF, OME-TIFF, ImageJ TIFF, PNG")
    print(f"compressed TIFF\t{'yes' if find_spec('imagecodecs') else 'no: pip install imagecodecs'}")


def _part_words(part: str, found: dict[str, str]) -> str:
    words = ", ".join(f"{name} {number}" for name, number in found.items())
    if NOT_INSTALLED not in found.values():
        return words
    return f"{words}: in the clone of cytodisk type .venv/bin/pip install -c constraints.txt -e '.[{part}]'"


def demo_command(
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the demo.")] = Path("cytodisk_demo"),
    seed: Annotated[int, typer.Option(help="Seed of the simulated movie.")] = 0,
    workers: Annotated[int, typer.Option(help="Processes that map; one more draws.")] = 1,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in OUT/study.")] = False,
    quiet: Quiet = False,
) -> None:
    """Simulate a moving cell with two signals, follow it, correlate, report, compare with the known answer.

    Nothing is downloaded. OUT/input holds the simulated files, OUT/study the results, with report.html.
    """
    from cytodisk.runs.correlate.correlate_study import correlate_study
    from cytodisk.runs.demo_input import compare_with_truth, write_demo_input
    from cytodisk.runs.executor import Executor
    from cytodisk.runs.movie.movie_inputs import open_movie
    from cytodisk.runs.movie.movie_parameters import MovieParameters
    from cytodisk.runs.movie.movie_study import movie_study

    console = console_for(quiet)
    with Executor(1, apart=True) as beside:
        beside.submit(_load_drawing)
        truth, masks, signal = write_demo_input(out / "input", seed, overwrite=overwrite)
        console.print(
            f"A simulated cell in {len(truth.masks)} frames, with two signals, is in {masks.parent}."
        )
        console.print(f"The same by hand: cytodisk movie {masks} --signal {signal} -o {out / 'mine'}\n")
        inputs = open_movie(masks, signal, MovieParameters())
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
        drawings = [beside.submit(_draw_movie, masks, signal, study.path)]
        finish_movie(console, study)
        with progress_bar(quiet, "percent", stopped=NOTHING_CHANGED) as progress:
            found = correlate_study(study, "edge", "velocity", progress=progress)
        drawings.append(beside.submit(_draw_correlation, study.path))
        say_correlation(console, found)
        try:
            write_page(console, quiet, study)
        except MissingPartError as missing:
            console.print(f"no report: {missing}")
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


def _draw_movie(masks: Path, signal: Path, study: Path) -> None:
    from cytodisk.runs.movie.movie_inputs import open_movie
    from cytodisk.runs.movie.movie_parameters import MovieParameters
    from cytodisk.store.study import open_study

    draw_movie(True, open_study(study), open_movie(masks, signal, MovieParameters()), 1)


def _draw_correlation(study: Path) -> None:
    from cytodisk.store.study import open_study

    there = open_study(study)
    draw_correlation(True, there, there.correlation("edge", "velocity"), 1, ("png",))
