"""`cytodisk compare`."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from cytodisk.cli.comparison_lines import say_comparison, say_tables
from cytodisk.cli.console import (
    Channels,
    Kind,
    Layers,
    OutFolder,
    Overwrite,
    PixelSize,
    Quiet,
    Resume,
    Sectors,
    Signal,
    console_for,
    count,
    fail,
    parse_channels,
    progress_bar,
)
from cytodisk.cli.map_command import say_inputs
from cytodisk.cli.movie_command import say_movie
from cytodisk.errors import ParameterError
from cytodisk.runs.channel_names import shown_name

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.compare_windows.compare_parameters import (
        CompareMovieParameters,
        CompareWindowsParameters,
    )
    from cytodisk.runs.compare_windows.comparison import Comparison

AnyCompared = TypeVar("AnyCompared", "CompareWindowsParameters", "CompareMovieParameters")

COMPARE_HELP = """Compare windows of several methods on your own masks: how many are empty, how regular.

MASKS is one mask, a stack of masks, or a label image, or a folder of those. With --movie it is a stack of
masks of one cell through time (or label images in which a label is a cell), and --signal what to sample.

Methods: newton (cytodisk's default map), harmonic (before relaxation), advection (the paper's relaxation),
edge (by distance from the edge, the field's), rings (around the deepest point, as CellProfiler's).

Examples:

  cytodisk compare masks.tif -o out/ --layers 12 --sectors 60 --workers 2

  cytodisk compare masks.tif --movie --signal movie.ome.tif -o out/ --depth-px 10

Exit code: 0 when done (cells without a map have a row with the reason), 2 if no cell could be used, or a file
is damaged.

The paper's relaxation (advection) takes seconds a cell, and minutes for one of 50 000 pixels and more.
"""


def compare_command(
    masks: Annotated[
        Path, typer.Argument(help="Masks or label image, or a folder of them.", show_default=False)
    ],
    out: OutFolder,
    methods: Annotated[
        str | None,
        typer.Option(help="As newton,edge (default newton,harmonic,advection,edge; movie: no advection)."),
    ] = None,
    movie: Annotated[bool, typer.Option("--movie", help="MASKS are frames of a movie.")] = False,
    signal: Signal = None,
    channels: Channels = None,
    kind: Kind = None,
    layers: Layers = None,
    sectors: Sectors = None,
    spacing: Annotated[
        str | None, typer.Option(help="Layers on the disk of equal area or radius (default area).")
    ] = None,
    depth_px: Annotated[
        float | None,
        typer.Option(help="Thickness of an edge-based layer, px (default: the cell's depth / layers)."),
    ] = None,
    depth_um: Annotated[
        float | None, typer.Option(help="The same in µm, instead of --depth-px; needs the pixel size.")
    ] = None,
    pixel_size: PixelSize = None,
    frame_interval: Annotated[float | None, typer.Option(help="Seconds between frames of a movie.")] = None,
    parameters: Annotated[
        Path | None, typer.Option(help="TOML file as in a comparison; flags overrule it.")
    ] = None,
    cells: Annotated[
        str | None,
        typer.Option(help="Cells to draw, at most five, as 3,17,20 (default: from simple to complex)."),
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes; a movie runs in one.")] = 1,
    resume: Resume = False,
    overwrite: Overwrite = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.runs.compare_windows.compare_parameters import (
        CompareMovieParameters,
        CompareWindowsParameters,
    )
    from cytodisk.runs.parameters_file import parameters_from

    given: dict[str, Any] = {
        "methods": None if methods is None else tuple(part.strip() for part in methods.split(",")),
        "kind": kind,
        "channels": parse_channels(channels),
        "layers": layers,
        "sectors": sectors,
        "spacing": spacing,
        "depth_px": depth_px,
        "pixel_size_um": pixel_size,
    }
    again: dict[str, bool] = {"resume": resume, "overwrite": overwrite}
    if depth_px is not None and depth_um is not None:
        raise ParameterError("depth_px and depth_um exclude each other: pass --depth-px or --depth-um")
    drawn = _parse_cells(cells, movie)
    console = console_for(quiet)
    if frame_interval is not None and not movie:
        raise ParameterError("frame_interval is that of a movie: pass --movie too, or leave it out")
    if movie:
        given["frame_interval_s"] = frame_interval
        of_movie = parameters_from(given, parameters, CompareMovieParameters)
        found = _run_movie(console, masks, signal, out, of_movie, depth_um, again)
    else:
        if signal is not None:
            raise ParameterError("signal is sampled in movies only: pass --movie too, or leave --signal out")
        settings = parameters_from(given, parameters, CompareWindowsParameters)
        found = _run_cells(console, masks, out, settings, depth_um, again | {"workers": workers})
    if not found.cells["mapped"].sum():
        fail(f"no cell could be used: {'; '.join(found.cells['reason'].head(1)) or 'there is none'}")
    say_comparison(console, found)
    for path, words in draw_figures(found, drawn):
        console.print(f"{path.relative_to(found.path)}: {words}")
    say_tables(console, found)
    unreadable = found.cells[found.cells["status"] == "unreadable"]["cell"].nunique()
    if unreadable:
        fail(f"damaged files or frames of the input: {unreadable}; all others are in {found.path}")


def _run_cells(
    console: "Console",
    masks: Path,
    out: Path,
    settings: "CompareWindowsParameters",
    depth_um: float | None,
    options: dict[str, Any],
) -> "Comparison":
    from cytodisk.runs.compare_windows.compare_cells import compare_opened_cells
    from cytodisk.runs.map.map_inputs import open_inputs

    inputs = open_inputs(masks, None, settings)
    say_inputs(console, inputs)
    settings = _with_depth(settings, depth_um, inputs.pixel_size_um)
    with progress_bar(console.quiet, "cells") as progress:
        return compare_opened_cells(inputs, out, settings, progress=progress, **options)


def _run_movie(
    console: "Console",
    masks: Path,
    signal: Path | None,
    out: Path,
    settings: "CompareMovieParameters",
    depth_um: float | None,
    options: dict[str, Any],
) -> "Comparison":
    from cytodisk.runs.compare_windows.compare_movie import compare_opened_movie
    from cytodisk.runs.movie.movie_inputs import open_movie

    inputs = open_movie(masks, signal, settings)
    say_movie(console, inputs)
    settings = _with_depth(settings, depth_um, inputs.scale.pixel_size_um)
    with progress_bar(console.quiet, f"frames of {count(len(settings.methods), 'method')}") as progress:
        return compare_opened_movie(inputs, out, settings, progress=progress, **options)


def _with_depth(settings: AnyCompared, depth_um: float | None, pixel_size_um: float | None) -> AnyCompared:
    """Settings with a depth that was given in micrometres."""
    if depth_um is None:
        return settings
    if not 0 < depth_um < float("inf"):
        raise ParameterError(f"depth_um must be a positive number, got {depth_um}")
    if pixel_size_um is None:
        raise ParameterError("depth_um needs a pixel size: pass it as --pixel-size, or --depth-px instead")
    return settings.model_copy(update={"depth_px": depth_um / pixel_size_um})


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


def draw_figures(found: "Comparison", cells: list[int] | None = None) -> list[tuple[Path, str]]:
    """Draw what can be drawn of a comparison; each file with a line on what it shows."""
    from cytodisk.pages.compared_cells import write_compared_cells
    from cytodisk.pages.compared_layers import write_comparison
    from cytodisk.pages.compared_movie import write_compared_movie

    mapped = found.cells[found.cells["mapped"] > 0]
    if not len(mapped):
        return []
    by_layer = "filled windows, spread of their area and eccentricity, mean eccentricity, by layer"
    drawn = [(write_comparison(found), by_layer)]
    if not found.is_movie:
        path = write_compared_cells(found, cells)
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
            drawn.append((write_compared_movie(found, int(cell), channel), words))
    return drawn
