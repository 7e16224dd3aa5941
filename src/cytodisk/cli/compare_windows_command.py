"""`cytodisk compare-windows`."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cytodisk.cli.comparison_lines import say_comparison, say_tables
from cytodisk.cli.console import console_for, count, fail, progress_bar
from cytodisk.cli.first_start import compiling, say_compiling
from cytodisk.cli.map_command import say_inputs
from cytodisk.cli.movie_command import say_movie
from cytodisk.cli.options import (
    Given,
    MaskFiles,
    NucleiFiles,
    OutFolder,
    Quiet,
    with_parameters,
)
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import shown_name
from cytodisk.runs.compare_windows.compare_parameters import (
    CompareMovieParameters,
    CompareNucleiParameters,
    CompareWindowsParameters,
)
from cytodisk.runs.run_options import FigureOptions, RunOptions

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.compare_windows.comparison import Comparison


@with_parameters(
    CompareWindowsParameters,
    RunOptions,
    FigureOptions,
    modes={"--movie": CompareMovieParameters, "--nuclei": CompareNucleiParameters},
)
def compare_windows_command(
    masks: MaskFiles,
    out: OutFolder,
    given: Given,
    movie: Annotated[bool, typer.Option("--movie", help="MASKS are frames of a movie.")] = False,
    signal: Annotated[
        Path | None,
        typer.Option(
            metavar="PATH",
            help="Image to measure, of the same height and width, in any format (only with --movie).",
        ),
    ] = None,
    nuclei: NucleiFiles = None,
    cells: Annotated[
        str | None,
        typer.Option(
            metavar="A,B,…", help="Cells to draw, at most five, as 3,17,20 (default: from simple to complex)."
        ),
    ] = None,
    quiet: Quiet = False,
) -> None:
    drawn = _parse_cells(cells, movie)
    console = console_for(quiet)
    options, formats = dict(given.options(RunOptions)), given.formats(1)
    _check_mode(given, movie, signal, nuclei)
    if movie:
        found = _run_movie(console, masks, signal, out, given.of(CompareMovieParameters), options)
    elif nuclei is not None:
        found = _run_nuclei(console, masks, nuclei, out, given.of(CompareNucleiParameters), options)
    else:
        found = _run_cells(console, masks, out, given.of(CompareWindowsParameters), options)
    if not found.cells["mapped"].sum():
        fail(f"no cell could be used: {'; '.join(found.cells['reason'].head(1)) or 'there is none'}")
    say_comparison(console, found)
    for path, words in draw_figures(found, drawn, formats):
        console.print(f"{path.relative_to(found.path)}: {words}")
    say_tables(console, found)
    unreadable = found.cells[found.cells["status"] == "unreadable"]["cell"].nunique()
    if unreadable:
        fail(f"damaged files or frames of the input: {unreadable}; all others are in {found.path}")


def _check_mode(given: Given, movie: bool, signal: Path | None, nuclei: Path | None) -> None:
    """Raise ParameterError where flags do not go together."""
    if movie and nuclei is not None:
        raise ParameterError("--nuclei compares cells that are not followed: leave --movie or --nuclei out")
    of_signal = ["--signal"] if signal is not None and not movie else []
    if nuclei is not None:
        if beyond := given.beyond(CompareNucleiParameters, RunOptions, FigureOptions) + of_signal:
            raise ParameterError(f"{', '.join(beyond)}: not with --nuclei; leave it out")
        return
    model = CompareMovieParameters if movie else CompareWindowsParameters
    beyond = given.beyond(model, RunOptions, FigureOptions)
    of_nuclei = [
        flag
        for flag in beyond
        if flag not in given.beyond(CompareNucleiParameters, RunOptions, FigureOptions)
    ]
    if of_nuclei and movie:
        raise ParameterError(f"{', '.join(of_nuclei)}: not with --movie; leave it out")
    if of_nuclei:
        raise ParameterError(f"{', '.join(of_nuclei)}: only with --nuclei; pass that too, or leave it out")
    if beyond or of_signal:
        flags = ", ".join(beyond + of_signal)
        raise ParameterError(f"{flags}: only with --movie; pass that too, or leave it out")


def _run_nuclei(
    console: "Console",
    masks: Path,
    nuclei: Path,
    out: Path,
    settings: CompareNucleiParameters,
    options: dict[str, Any],
) -> "Comparison":
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.cells.cell_parameters import CheckParameters
    from cytodisk.runs.compare_windows.compare_nuclei import compare_opened_nuclei

    inputs = open_inputs(masks, None, settings.part(CheckParameters), nuclei=nuclei)
    say_inputs(console, inputs)
    with (
        compiling(console.quiet, "map with nuclei", options["workers"]),
        progress_bar(console.quiet, "cells") as progress,
    ):
        return compare_opened_nuclei(inputs, out, settings, progress=progress, **options)


def _run_cells(
    console: "Console",
    masks: Path,
    out: Path,
    settings: CompareWindowsParameters,
    options: dict[str, Any],
) -> "Comparison":
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.cells.cell_parameters import FileParameters
    from cytodisk.runs.compare_windows.compare_cells import compare_opened_cells

    inputs = open_inputs(masks, None, settings.part(FileParameters))
    say_inputs(console, inputs)
    with (
        compiling(console.quiet, "map", options["workers"]),
        progress_bar(console.quiet, "cells") as progress,
    ):
        return compare_opened_cells(inputs, out, settings, progress=progress, **options)


def _run_movie(
    console: "Console",
    masks: Path,
    signal: Path | None,
    out: Path,
    settings: CompareMovieParameters,
    options: dict[str, Any],
) -> "Comparison":
    from cytodisk.runs.compare_windows.compare_movie import compare_opened_movie
    from cytodisk.runs.movie.movie_inputs import open_movie

    inputs = open_movie(masks, signal, settings)
    say_movie(console, inputs)
    say_compiling(console.quiet, "movie")
    with progress_bar(console.quiet, f"frames of {count(len(settings.methods), 'method')}") as progress:
        return compare_opened_movie(inputs, out, settings, progress=progress, **options)


def _parse_cells(text: str | None, movie: bool) -> list[int] | None:
    from cytodisk.pages.compared_cells import check_cells

    if text is None:
        return None
    if movie:
        raise ParameterError("cells chooses what cells.png shows, and of a movie all are drawn: leave it out")
    try:
        cells = [int(part) for part in text.split(",")]
    except ValueError:
        raise ParameterError(f"cells must be numbers of cells as 3,17,20, got {text!r}") from None
    check_cells(cells)
    return cells


def draw_figures(
    found: "Comparison", cells: list[int] | None = None, formats: Sequence[str] = ("png",)
) -> list[tuple[Path, str]]:
    """Draw what can be drawn of a comparison; each file with a line on what it shows."""
    from cytodisk.pages.compared_cells import write_compared_cells
    from cytodisk.pages.compared_layers import write_comparison
    from cytodisk.pages.compared_movie import write_compared_movie

    mapped = found.cells[found.cells["mapped"] > 0]
    if not len(mapped):
        return []
    by_layer = "filled windows, spread of their area and eccentricity, mean eccentricity, by layer"
    if found.has_nuclei:
        by_layer = (
            "filled windows, their area, its spread, mean eccentricity, by layer of cytoplasm and nucleus"
        )
    drawn = [(write_comparison(found, formats=formats), by_layer)]
    if not found.is_movie:
        path = write_compared_cells(found, cells, formats=formats)
        return drawn if path is None else [*drawn, (path, "windows of each method in up to five cells")]
    channels = [str(name) for name in found.consistency["channel"].dropna().unique()]
    for cell in sorted(mapped["cell"].unique()):
        for channel in channels or (None,):
            words = "how far windows move, by layer and through time, and how many are filled"
            if channel is not None:
                words = (
                    f"activity maps of {shown_name(channel)}, how alike consecutive frames are, how far "
                    "windows move, how many are filled"
                )
            drawn.append((write_compared_movie(found, int(cell), channel, formats=formats), words))
    return drawn
