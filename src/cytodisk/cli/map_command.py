"""`cytodisk map`."""

from typing import TYPE_CHECKING

from cytodisk.cli.console import console_for, progress_bar, say_notes
from cytodisk.cli.first_start import compiling
from cytodisk.cli.map_end import draw_totals, finish_map
from cytodisk.cli.options import (
    CellFigures,
    Given,
    GroupsFile,
    MaskFiles,
    NoReport,
    NucleiFiles,
    OutFolder,
    Quiet,
    SignalFiles,
    with_parameters,
)
from cytodisk.cli.report.report_words import page_of
from cytodisk.runs.map.map_parameters import MapParameters
from cytodisk.runs.run_options import FigureOptions, MapOptions
from cytodisk.runs.told.compiling_words import with_nuclei_or_not

if TYPE_CHECKING:
    from rich.console import Console

    from cytodisk.runs.cells.cell_inputs import CellInputs


@with_parameters(MapParameters, MapOptions, FigureOptions, groups=GroupsFile)
def map_command(
    masks: MaskFiles,
    out: OutFolder,
    given: Given,
    signal: SignalFiles = None,
    nuclei: NucleiFiles = None,
    figures: CellFigures = 8,
    no_report: NoReport = False,
    quiet: Quiet = False,
) -> None:
    from cytodisk.pages.cell_pages import CellPages
    from cytodisk.runs.cells.cell_groups import with_groups
    from cytodisk.runs.cells.cell_inputs import open_inputs
    from cytodisk.runs.map.map_study import map_study

    console = console_for(quiet)
    options, formats = given.options(MapOptions), given.options(FigureOptions).format
    inputs = open_inputs(masks, signal, given.of(MapParameters), nuclei=nuclei)
    inputs = with_groups(inputs, given.groups)
    say_inputs(console, inputs)
    work = with_nuclei_or_not("map", nuclei)
    with compiling(quiet, work, options.workers), progress_bar(quiet, "cells") as progress:
        study = map_study(
            inputs,
            out,
            draw=CellPages(formats) if figures else None,  # workers that draw nothing stay small
            draw_at_most=None if figures < 0 else figures,
            progress=progress,
            **dict(options),
        )
    draw_totals(study, formats)
    finish_map(
        console, study, figures, inputs.is_folder, None if no_report else page_of(study, inputs, quiet)
    )


def say_inputs(console: "Console", inputs: "CellInputs") -> None:
    for role, words in inputs.understood.items():
        console.print(f"{role}: {words}")
    console.print(inputs.scale.words()[0])
    say_notes(console, inputs.notes)
    for remark in inputs.remarks:
        console.print(f"note: {remark}")
