"""`cytodisk compare`."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cytodisk.cli.console import (
    Channels,
    Quiet,
    Signal,
    console_for,
    count,
    fail,
    parse_channels,
    progress_bar,
)
from cytodisk.errors import ParameterError

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.study.comparison import Comparison

COMPARE_HELP = """Compare windows of several methods on your own masks: how many are empty, how regular.

MASKS is one mask, a stack of masks, or a label image, or a folder of those. With --movie it is a stack of
masks of one cell through time (or label images in which a label is a cell), and --signal what to sample.

Methods: newton (cytodisk's default map), harmonic (before relaxation), advection (the paper's relaxation),
edge (by distance from the edge, the field's), rings (around the deepest point, as CellProfiler's).

Examples:

  cytodisk compare masks.tif -o out/ --layers 12 --sectors 60 --workers 2

  cytodisk compare masks.tif --movie --signal movie.ome.tif -o out/ --depth-px 10

Exit code: 0 when done (cells without a map have a row with the reason), 2 if no cell could be used.
"""

_LINE = "{:<21}{:>9}{:>7}{:>7}{:>10}{:>9}{:>8}{:>9}{:>8}{:>9}"
_HEADS = ("mapped", "valid", "flips", "area err", "windows", "area", "CV area", "CV ecc", "seconds")
_KEY = (
    "valid: maps that are one to one; area err: mean |log λ|, median; windows: share that holds signal; "
    "area: share of cells in windows; CV: spread of area and of eccentricity within a layer, median"
)


def compare_command(
    masks: Annotated[
        Path, typer.Argument(help="Masks or label image, or a folder of them.", show_default=False)
    ],
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the results.", show_default=False)],
    methods: Annotated[
        str | None,
        typer.Option(help="As newton,edge (default newton,harmonic,advection,edge; movie: no advection)."),
    ] = None,
    movie: Annotated[bool, typer.Option("--movie", help="MASKS are frames of a movie.")] = False,
    signal: Signal = None,
    channels: Channels = None,
    kind: Annotated[str | None, typer.Option(help="What MASKS is: auto, mask, stack or labels.")] = None,
    layers: Annotated[int | None, typer.Option(help="Windows from edge to centre (default 10).")] = None,
    sectors: Annotated[int | None, typer.Option(help="Windows around the edge (default 60).")] = None,
    spacing: Annotated[
        str | None, typer.Option(help="Layers on the disk of equal area or radius (default area).")
    ] = None,
    depth_px: Annotated[
        float | None,
        typer.Option(help="Thickness of an edge-based layer, px (default: the cell's depth / layers)."),
    ] = None,
    pixel_size: Annotated[float | None, typer.Option(help="µm per pixel; overrules the file's own.")] = None,
    frame_interval: Annotated[float | None, typer.Option(help="Seconds between frames of a movie.")] = None,
    parameters: Annotated[
        Path | None, typer.Option(help="TOML file as in a comparison; flags overrule it.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes; a movie runs in one.")] = 1,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the same run in this folder.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in this folder.")] = False,
    quiet: Quiet = False,
) -> None:
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
    if frame_interval is not None and not movie:
        raise ParameterError("frame_interval is that of a movie: pass --movie too, or leave it out")
    if movie:
        given["frame_interval_s"] = frame_interval
        found = _run_movie(masks, signal, out, given, parameters, again, quiet)
    else:
        found = _run_cells(masks, signal, out, given, parameters, again | {"workers": workers}, quiet)
    if not found.cells["mapped"].sum():
        fail(f"no cell could be used: {'; '.join(found.cells['reason'].head(1)) or 'there is none'}")
    console = console_for(quiet)
    say_comparison(console, found)
    for path, words in draw_figures(found):
        console.print(f"{path.relative_to(found.path)}: {words}")
    console.print(f"results: {found.path} (comparison.csv by layer, comparison_methods.csv by method)")


def _run_cells(
    masks: Path,
    signal: Path | None,
    out: Path,
    given: dict[str, Any],
    parameters: Path | None,
    options: dict[str, Any],
    quiet: bool,
) -> "Comparison":
    from cytodisk.study.compare_cells import compare_cells
    from cytodisk.study.compare_parameters import CompareParameters
    from cytodisk.study.parameters import parameters_from

    if signal is not None:
        raise ParameterError("signal is sampled in movies only: pass --movie too, or leave --signal out")
    settings = parameters_from(given, parameters, CompareParameters)
    with progress_bar(quiet, "cells") as progress:
        return compare_cells(masks, out, settings, progress=progress, **options)


def _run_movie(
    masks: Path,
    signal: Path | None,
    out: Path,
    given: dict[str, Any],
    parameters: Path | None,
    options: dict[str, Any],
    quiet: bool,
) -> "Comparison":
    from cytodisk.study.compare_movie import compare_movie
    from cytodisk.study.compare_parameters import CompareMovieParameters
    from cytodisk.study.parameters import parameters_from

    settings = parameters_from(given, parameters, CompareMovieParameters)
    with progress_bar(quiet, "frames") as progress:
        return compare_movie(masks, out, settings, signal=signal, progress=progress, **options)


def draw_figures(found: "Comparison") -> list[tuple[Path, str]]:
    """Draw what can be drawn of a comparison; each file with a line on what it shows."""
    from cytodisk.plot.compared_cells import draw_compared_cells
    from cytodisk.plot.compared_movie import draw_compared_movie
    from cytodisk.plot.comparison import draw_comparison

    mapped = found.cells[found.cells["mapped"] > 0]
    if not len(mapped):
        return []
    drawn = [
        (draw_comparison(found), "share of windows that hold signal, spread of their area and form, by layer")
    ]
    if not found.is_movie:
        cells = draw_compared_cells(found)
        return drawn if cells is None else [*drawn, (cells, "windows of each method in up to five cells")]
    channels = [str(name) for name in found.consistency["channel"].dropna().unique()]
    for cell in sorted(mapped["cell"].unique()):
        for channel in channels or (None,):
            path = draw_compared_movie(found, int(cell), channel)
            drawn.append((path, "activity maps, how alike consecutive frames are, how far windows move"))
    return drawn


def say_comparison(console: "Console", found: "Comparison") -> None:
    """Print a line a method, what was lost, and where the default is worse."""
    from cytodisk.study.compare_parameters import TITLES
    from cytodisk.study.comparison_words import where_worse

    console.print(_LINE.format("method", *_HEADS))
    for row in found.by_method.to_dict("records"):
        on_map = row["invalid_maps"] == row["invalid_maps"]  # NaN where windows are not on a map
        console.print(
            _LINE.format(
                TITLES[row["method"]],
                f"{row['mapped']}/{row['tried']}",
                f"{row['mapped'] - row['invalid_maps']:.0f}" if on_map else "",
                f"{row['flipped']:.0f}" if on_map else "",
                f"{row['area_error']:.3f}" if on_map else "",
                f"{row['completeness']:.1%}",
                f"{row['coverage']:.1%}",
                f"{row['area_cv']:.2f}",
                f"{row['eccentricity_cv']:.2f}",
                f"{row['seconds']:.2g}",
            )
        )
    console.print(_KEY)
    for words in where_worse(found):
        console.print(words)
    lost = found.cells[found.cells["reason"] != ""].to_dict("records")
    for row in lost[:10]:
        print(f"cell {row['cell']}, {row['method']} ({row['status']}): {row['reason']}", file=sys.stderr)
    if len(lost) > 10:
        print(f"… and {count(len(lost) - 10, 'more row')}: column 'reason' of cells.parquet", file=sys.stderr)
