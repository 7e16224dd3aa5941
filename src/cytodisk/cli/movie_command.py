"""`cytodisk movie`."""

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from cytodisk.cli.console import RESUME, console_for, fail, progress_bar, say_lines, say_losses, say_notes
from cytodisk.cli.first_start import compiling
from cytodisk.cli.options import (
    Figures,
    Given,
    GroupsFile,
    MovieFile,
    MovieNuclei,
    OutFolder,
    Quiet,
    Signal,
    with_parameters,
)
from cytodisk.runs.movie.movie_parameters import MovieParameters
from cytodisk.runs.run_options import FigureOptions, RunOptions
from cytodisk.runs.told.compiling_words import with_nuclei_or_not
from cytodisk.runs.told.flag_words import study_flag_lines
from cytodisk.runs.told.movie_words import finding_line, lost_frame_lines, movie_fault, movie_lines

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.movie.movie_inputs import MovieInputs
    from cytodisk.store.study import Study


@with_parameters(MovieParameters, RunOptions, FigureOptions, groups=GroupsFile)
def movie_command(
    masks: MovieFile,
    out: OutFolder,
    given: Given,
    signal: Signal = None,
    nuclei: MovieNuclei = None,
    figures: Figures = 4,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.movie.movie_groups import with_movie_groups
    from cytodisk.runs.movie.movie_inputs import open_movie
    from cytodisk.runs.movie.movie_study import movie_study

    console = console_for(quiet)
    options, formats = given.options(RunOptions), given.formats(figures)
    inputs = open_movie(masks, signal, given.of(MovieParameters), nuclei=nuclei)
    inputs = with_movie_groups(inputs, masks, given.groups)
    say_movie(console, inputs)
    work = with_nuclei_or_not("movie", nuclei)
    with compiling(quiet, work, options.workers), progress_bar(quiet, "frames") as progress:
        study = movie_study(inputs, out, progress=progress, **dict(options))
    draw_movie(quiet, study, inputs, figures, formats)
    finish_movie(console, study)


def say_movie(console: "Console", inputs: "MovieInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    for words in inputs.scale.words():
        console.print(words)
    say_notes(console, inputs.notes)


def draw_movie(
    quiet: bool,
    study: "Study",
    inputs: "MovieInputs",
    figures: int,
    formats: Sequence[str] = ("png",),
    again: str = RESUME,
) -> None:
    """Draw cells whose figures are not there or not whole, so that a run stopped while drawing goes on."""
    from cytodisk.images.signal_files import load_image
    from cytodisk.pages.movie_pages import write_movie_figures
    from cytodisk.store.figures_folder import is_drawn

    image = partial(load_image, inputs.signal)
    cells = sorted(study.cells["cell"].unique())
    wanted = cells if figures < 0 else cells[:figures]
    endings = [".gif", *(f".{kind}" for kind in formats)]
    missing = [
        cell
        for cell in wanted
        if not all(is_drawn(study.path, f"cell_{cell:05d}", ending) for ending in endings)
    ]
    if not missing:
        return
    with progress_bar(quiet, "drawings", total=len(missing), again=again) as progress:
        for number, cell in enumerate(missing):
            write_movie_figures(study, int(cell), image, formats=formats)
            progress(number + 1, len(missing))


def finish_movie(console: "Console", study: "Study", flags: bool = True) -> None:
    """Say what came out, with `flags` what is wrong; exit code 2 if nothing came, or a frame is damaged."""
    say_lines(console, movie_lines(study))
    say_losses(lost_frame_lines(study))
    if flags:
        say_lines(console, study_flag_lines(study))
        say_lines(console, finding_line(study))
    console.print(f"results: {study.path}")
    if fault := movie_fault(study):
        fail(fault)
