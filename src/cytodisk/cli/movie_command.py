"""`cytodisk movie`."""

import sys
from functools import partial
from typing import TYPE_CHECKING, Any

from cytodisk.cli.console import RESUME, console_for, count, fail, progress_bar, say_notes
from cytodisk.cli.first_start import compiling, with_nuclei_or_not
from cytodisk.cli.flag_words import say_study_flags
from cytodisk.cli.nucleus_words import nucleus_ratio_words, nucleus_share_words
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
from cytodisk.runs.run_options import RunOptions

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.movie.movie_inputs import MovieInputs
    from cytodisk.store.study import Study


@with_parameters(MovieParameters, RunOptions, groups=GroupsFile)
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
    options = given.options(RunOptions)
    inputs = open_movie(masks, signal, given.of(MovieParameters), nuclei=nuclei)
    inputs = with_movie_groups(inputs, masks, given.groups)
    say_movie(console, inputs)
    work = with_nuclei_or_not("movie", nuclei)
    with compiling(quiet, work, options.workers), progress_bar(quiet, "frames") as progress:
        study = movie_study(inputs, out, progress=progress, **dict(options))
    draw_movie(quiet, study, inputs, figures)
    finish_movie(console, study)


def say_movie(console: "Console", inputs: "MovieInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    for words in inputs.scale.words():
        console.print(words)
    say_notes(console, inputs.notes)


def draw_movie(quiet: bool, study: "Study", inputs: "MovieInputs", figures: int, again: str = RESUME) -> None:
    """Draw cells whose figures are not there or not whole, so that a run stopped while drawing goes on."""
    from cytodisk.images.signal_files import load_image
    from cytodisk.pages.movie_pages import write_movie_figures
    from cytodisk.store.figures_folder import is_drawn

    image = partial(load_image, inputs.signal)
    cells = sorted(study.cells["cell"].unique())
    wanted = cells if figures < 0 else cells[:figures]
    missing = [cell for cell in wanted if not is_drawn(study.path, f"cell_{cell:05d}", ".gif")]
    if not missing:
        return
    with progress_bar(quiet, "drawings", total=len(missing), again=again) as progress:
        for number, cell in enumerate(missing):
            write_movie_figures(study, int(cell), image)
            progress(number + 1, len(missing))


def finish_movie(console: "Console", study: "Study", flags: bool = True) -> None:
    """Say what came out, with `flags` what is wrong; exit code 2 if nothing came, or a frame is damaged."""
    frames = study.cells
    mapped = frames[frames["status"] == "ok"]
    cells = frames["cell"].nunique()
    console.print(f"{len(mapped)} of {len(frames)} frames of {count(cells)} mapped, each one to one")
    if len(mapped):
        _say_measures(console, study, mapped)
    for words in (nucleus_ratio_words(mapped, "frame"), nucleus_share_words(mapped)):
        if words:
            console.print(words)
    for status in ("refused", "missing", "unreadable"):
        lost = frames[frames["status"] == status]
        for _, row in lost.head(10).iterrows():
            print(f"cell {row['cell']}, frame {row['frame']} {status}: {row['reason']}", file=sys.stderr)
        if len(lost) > 10:
            print(f"… and {len(lost) - 10} more {status}: column 'reason' of cells.parquet", file=sys.stderr)
    if flags:
        say_study_flags(console, study)
    console.print(f"results: {study.path}")
    if not len(mapped):
        fail(f"no frame could be mapped: {frames['reason'].iloc[0]}")
    unreadable = int((frames["status"] == "unreadable").sum())
    if unreadable:
        fail(f"damaged frames of the input: {unreadable}; all others are in {study.path}")


def _say_measures(console: "Console", study: "Study", mapped: Any) -> None:
    _say_velocity(console, study)
    length = study.consistency.attrs["units"]["centroid_displacement"]
    correlation = study.consistency["correlation"].mean()
    alike = f"consecutive frames correlate by {correlation:.2f}; " if correlation == correlation else ""
    moved = study.consistency["centroid_displacement"].mean()
    still = f"window centroids move {moved:.3g} {length} a frame; " if moved == moved else ""
    console.print(f"{still}{alike}empty windows {int(mapped['empty_windows'].sum())}")


def _say_velocity(console: "Console", study: "Study") -> None:
    speed, unit = study.edge["velocity"], study.edge.attrs["units"]["velocity"]
    if not speed.notna().any():
        console.print("edge velocity: none, as no two frames that follow each other were mapped")
        return
    error = " ".join(["error of one sector", *_bounds(study.edge)])
    span = f"{speed.min():.3g} to {speed.max():.3g}".replace("-", "−")
    console.print(f"edge velocity: {span} {unit}, {error} {study.edge['velocity_error'].median():.2g} {unit}")


def _bounds(edge: Any) -> list[str]:
    """The word "at least" or "at most" if the error of velocity is such a bound in most cells."""
    from cytodisk.motion.velocity_error import error_is

    words = []
    for _, of_cell in edge.groupby("cell"):
        by_frame = of_cell.pivot(index="frame", columns="sector", values="velocity")
        every = range(by_frame.index.min(), by_frame.index.max() + 1)
        words.append(error_is(by_frame.reindex(every).to_numpy(dtype=float)))
    most = max(set(words), key=words.count, default="")
    return [most] if most else []
