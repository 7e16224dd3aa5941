"""`cytodisk map` and `cytodisk check`."""

from typing import TYPE_CHECKING

import typer

from cytodisk.cli.console import console_for, progress_bar
from cytodisk.cli.map_totals import finish_map
from cytodisk.cli.options import (
    Figures,
    Given,
    MaskFiles,
    OutFolder,
    Quiet,
    SignalFiles,
    with_parameters,
)
from cytodisk.runs.cells.cell_parameters import FileParameters
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.run_options import MapOptions

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.cells.cell_inputs import CellInputs

MAP_HELP = """Map masks onto the disk and sample a signal in windows, into a study folder.

MASKS is one mask, a stack of masks, or a label image (each label a cell), as TIFF or PNG; or a folder of such
files, as Cellpose writes them (_masks.tif, _cp_masks.png, _seg.npy). Cells are counted through all files.

Examples:

  cytodisk map mask.tif -o out/

  cytodisk map masks.tif --signal image.ome.tif -o out/ --layers 10 --sectors 60 --workers 2

  cytodisk map cellpose_folder/ --signal _img -o out/ --workers 4 --no-maps

  cytodisk map labels.tif -o out/ --parameters other_study/parameters.toml --resume

Exit code: 0 when done (refused cells have a row with the reason), 2 if nothing could be mapped or an input is
damaged (the rest is done all the same).
"""


@with_parameters(MapParameters, MapOptions)
def map_command(
    masks: MaskFiles,
    out: OutFolder,
    given: Given,
    signal: SignalFiles = None,
    figures: Figures = 8,
    quiet: Quiet = False,
) -> None:
    from cytodisk.pages.cell_pages import write_cell_figures
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.map.map_study import map_study

    console = console_for(quiet)
    inputs = open_inputs(masks, signal, given.of(MapParameters))
    say_inputs(console, inputs)
    with progress_bar(quiet, "cells") as progress:
        study = map_study(
            inputs,
            out,
            draw=write_cell_figures if figures else None,  # workers that draw nothing stay small
            draw_at_most=None if figures < 0 else figures,
            progress=progress,
            **dict(given.options(MapOptions)),
        )
    finish_map(console, study, figures, inputs.is_folder)


@with_parameters(FileParameters, file=False)
def check_command(masks: MaskFiles, given: Given, signal: SignalFiles = None) -> None:
    """Say what is wrong with masks before a run: a line a cell, or a frame of a stack.

    Exit code: 0 when all can be used (an image of a folder may be empty), 1 if any cannot, 2 if the file
    cannot be read at all.

    Example: cytodisk check labels.tif
    """
    from cytodisk.cli.map_totals import say_checked
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.map.map_study import check_cells

    inputs = open_inputs(masks, signal, given.of(FileParameters))
    console = console_for(False)
    say_inputs(console, inputs)
    unusable = say_checked(console, inputs, check_cells(inputs))
    raise typer.Exit(1 if unusable else 0)


def say_inputs(console: "Console", inputs: "CellInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    size = inputs.scale.pixel_size_um
    console.print(f"pixel size: {size:g} µm" if size else "pixel size: unknown, results are in px")
    for remark in inputs.remarks:
        console.print(f"note: {remark}")
