"""`cytodisk map` and `cytodisk check`."""

import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from cytodisk.cli.console import (
    Channels,
    Masks,
    Quiet,
    Signal,
    console_for,
    count,
    fail,
    parse_align,
    parse_channels,
    progress_bar,
)

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.io.study import Study
    from cytodisk.study.map_run import MapInputs

MAP_HELP = """Map masks onto the disk and sample a signal in windows, into a study folder.

MASKS is one mask, a stack of masks, or a label image (each label a cell), as TIFF or PNG.

Examples:

  cytodisk map mask.tif -o out/

  cytodisk map masks.tif --signal image.ome.tif -o out/ --layers 10 --sectors 60 --workers 2

  cytodisk map labels.tif -o out/ --parameters other_study/parameters.toml --resume

Exit code: 0 when done (refused cells have a row with the reason), 2 if nothing could be mapped.
"""


def map_command(
    masks: Masks,
    out: Annotated[Path, typer.Option("--out", "-o", help="Folder for the results.", show_default=False)],
    signal: Signal = None,
    channels: Channels = None,
    kind: Annotated[str | None, typer.Option(help="What MASKS is: auto, mask, stack or labels.")] = None,
    layers: Annotated[int | None, typer.Option(help="Windows from edge to centre (default 10).")] = None,
    sectors: Annotated[int | None, typer.Option(help="Windows around the edge (default 60).")] = None,
    spacing: Annotated[
        str | None, typer.Option(help="Layers of equal area or radius (default area).")
    ] = None,
    method: Annotated[
        str | None, typer.Option(help="newton (equal area) or harmonic (default newton).")
    ] = None,
    shape_weight: Annotated[
        float | None, typer.Option(help="Shape against area, above 0 (default 0.005).")
    ] = None,
    edge_length: Annotated[
        float | None, typer.Option(help="Mesh spacing at the edge, px (default 0.9).")
    ] = None,
    align: Annotated[
        str | None,
        typer.Option(help="upright, an angle in degrees, or a point ROW,COLUMN (default upright)."),
    ] = None,
    nan: Annotated[
        str | None, typer.Option(help="Windows with NaN pixels: propagate or omit (default propagate).")
    ] = None,
    pixel_size: Annotated[float | None, typer.Option(help="µm per pixel; overrules the file's own.")] = None,
    parameters: Annotated[
        Path | None, typer.Option(help="TOML file as in a study; flags overrule it.")
    ] = None,
    workers: Annotated[int, typer.Option(help="Processes.")] = 1,
    figures: Annotated[int, typer.Option(help="Draw this many cells, from the first; -1 for all.")] = 8,
    geojson: Annotated[
        bool, typer.Option("--geojson", help="Write window outlines beside the maps.")
    ] = False,
    resume: Annotated[bool, typer.Option("--resume", help="Go on with the same run in this folder.")] = False,
    overwrite: Annotated[bool, typer.Option("--overwrite", help="Replace the study in this folder.")] = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.plot.study import draw_cell_figures
    from cytodisk.study.map_run import open_inputs, run_map
    from cytodisk.study.parameters import parameters_from

    given = {
        "kind": kind,
        "channels": parse_channels(channels),
        "layers": layers,
        "sectors": sectors,
        "spacing": spacing,
        "method": method,
        "shape_weight": shape_weight,
        "edge_length": edge_length,
        "align": parse_align(align),
        "nan": nan,
        "pixel_size_um": pixel_size,
    }
    console = console_for(quiet)
    inputs = open_inputs(masks, signal, parameters_from(given, parameters))
    say_inputs(console, inputs)
    with progress_bar(quiet, "cells") as progress:
        study = run_map(
            inputs,
            out,
            workers=workers,
            resume=resume,
            overwrite=overwrite,
            draw=draw_cell_figures,
            draw_at_most=None if figures < 0 else figures,
            geojson=geojson,
            progress=progress,
        )
    finish_map(console, study, figures)


def check_command(
    masks: Masks,
    signal: Signal = None,
    channels: Channels = None,
    kind: Annotated[str, typer.Option(help="What MASKS is: auto, mask, stack or labels.")] = "auto",
) -> None:
    """Say what is wrong with masks before a run: a line a cell, or a frame of a stack.

    Exit code: 0 when all can be used, 1 if any cannot, 2 if the file cannot be read at all.

    Example: cytodisk check labels.tif
    """
    from cytodisk.study.map_run import check_cells, open_inputs
    from cytodisk.study.parameters import parameters_from

    given = {"kind": kind, "channels": parse_channels(channels)}
    inputs = open_inputs(masks, signal, parameters_from(given))
    console = console_for(False)
    say_inputs(console, inputs)
    unusable = doubtful = looked_at = 0
    print("cell\tframe\tlabel\tusable\tremarks")
    for found, reason, notes, doubts in check_cells(inputs):
        looked_at += 1
        unusable += bool(reason)
        doubtful += bool(doubts)
        remarks = reason or "; ".join([*doubts, *notes])
        usable = "no" if reason else "doubtful" if doubts else "yes"
        print(f"{found.cell}\t{found.frame}\t{found.label}\t{usable}\t{remarks}")
    what = count(looked_at, "frame" if inputs.kind == "stack" else "cell")
    console.print(
        f"{what}: {looked_at - unusable} usable ({doubtful} of them doubtful), {unusable} not usable"
    )
    raise typer.Exit(1 if unusable else 0)


def say_inputs(console: "Console", inputs: "MapInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    size = inputs.pixel_size_um
    console.print(f"pixel size: {size:g} µm" if size else "pixel size: unknown, results are in px")


def finish_map(console: "Console", study: "Study", figures: int) -> None:
    """Draw the overview and say what came out; exit code 2 if that is nothing, or a frame is damaged."""
    from cytodisk.plot.study import draw_overview

    cells = study.cells
    if len(cells) > 1:
        draw_overview(study.path / "figures" / "overview.png", cells)
    mapped = cells[cells["status"] == "ok"]
    console.print(f"{len(mapped)} of {count(len(cells))} mapped{', one to one' if len(mapped) else ''}")
    if len(mapped):
        console.print(
            f"median {mapped['seconds'].median():.2f} s a cell; median area distortion (mean |log λ|) "
            f"{mapped['area_distortion'].median():.3f}; empty windows {int(mapped['empty_windows'].sum())}"
        )
    remarks = mapped[mapped["notes"] != ""]
    if len(remarks):
        console.print(f"{count(len(remarks))} with remarks: column 'notes' of cells.parquet")
    doubtful = mapped[mapped["doubts"] != ""]
    for _, row in doubtful.head(20).iterrows():
        console.print(f"look at cell {row['cell']} (frame {row['time']}): {row['doubts']}")
    if len(doubtful) > 20:
        console.print(f"… and at {len(doubtful) - 20} more: column 'doubts' of cells.parquet")
    lost = cells[cells["status"] != "ok"]
    for _, row in lost.head(20).iterrows():
        print(f"cell {row['cell']} (frame {row['time']}) {row['status']}: {row['reason']}", file=sys.stderr)
    if len(lost) > 20:
        print(f"… and {len(lost) - 20} more: column 'reason' of cells.parquet", file=sys.stderr)
    if 0 <= figures < len(mapped):
        console.print(f"figures drawn for the first {count(figures)}: --figures -1 draws all")
    console.print(f"results: {study.path}")
    unreadable = int((cells["status"] == "unreadable").sum())
    if not len(mapped):
        fail(f"no cell could be mapped: {lost['reason'].iloc[0] if len(lost) else 'the file holds no cell'}")
    if unreadable:
        fail(f"damaged frames of the input: {unreadable}; all others are in {study.path}")
